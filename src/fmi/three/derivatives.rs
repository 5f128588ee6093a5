//! FMI functions that differentiate: sections 2.2 and 4.2 of the standard.
//!
//! Seeds and sensitivities are ordered by the elements of arrays, like values.

use super::table::Fmi3;
use super::types::{Float64, Handle, Int32, Reference};
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::fmi::gate::arguments::{array, write};
use crate::fmi::gate::gated;
use crate::fmi::unit::Unit;

/// Differentiates outputs along one direction: J·s for changes s of the knowns.
///
/// The result is exact with respect to inputs, at constant unknowns of the bodies: it is the response without delay. In
/// Initialization Mode parameters are known too; with respect to these it is accurate to about 1e-10.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const Float64,
    seed_count: usize,
    sensitivity: *mut Float64,
    sensitivity_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetDirectionalDerivative, |unit| {
        let lists = [(unknowns, unknown_count), (knowns, known_count)];
        let seed = (seed, seed_count);
        differentiate(unit, lists, seed, (sensitivity, sensitivity_count), Way::Forwards)
    })
}

/// Differentiates a weighted sum of outputs by each known: Jᵀ·s for weights s of the unknowns.
///
/// The rules are those of directional derivatives. The cost grows with the number of elements of the knowns that some
/// unknown follows without delay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    instance: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    seed: *const Float64,
    seed_count: usize,
    sensitivity: *mut Float64,
    sensitivity_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetAdjointDerivative, |unit| {
        let lists = [(unknowns, unknown_count), (knowns, known_count)];
        let seed = (seed, seed_count);
        differentiate(unit, lists, seed, (sensitivity, sensitivity_count), Way::Backwards)
    })
}

/// J·s or Jᵀ·s.
#[derive(Clone, Copy)]
enum Way {
    Forwards,
    Backwards,
}

/// Writes the sensitivity to a seed; `lists` are unknowns and knowns. Arrays are given with their lengths.
///
/// # Safety
/// Pointers are null or as the standard asks.
unsafe fn differentiate(
    unit: &mut Unit,
    lists: [(*const Reference, usize); 2],
    (seed, seed_count): (*const Float64, usize),
    (sensitivity, sensitivity_count): (*mut Float64, usize),
    way: Way,
) -> Answer {
    // SAFETY: by contract.
    unsafe {
        let [(unknowns, unknown_count), (knowns, known_count)] = lists;
        let unknowns = elements(unit, unknowns, unknown_count, "unknowns")?;
        let knowns = elements(unit, knowns, known_count, "knowns")?;
        let sizes = [("unknowns", unknowns.len()), ("knowns", knowns.len())];
        let [to, from] = match way {
            Way::Forwards => sizes,
            Way::Backwards => [sizes[1], sizes[0]],
        };
        check_count("nSeed", seed_count, from)?;
        check_count("nSensitivity", sensitivity_count, to)?;
        let seed = array(seed, seed_count, "seed")?;
        let found = match way {
            Way::Forwards => unit.directional_derivative(&unknowns, &knowns, seed)?,
            Way::Backwards => unit.adjoint_derivative(&unknowns, &knowns, seed)?,
        };
        write(sensitivity, &found, "sensitivity")
    }
}

/// Reads time derivatives of outputs.
///
/// They are exact, under the inputs of the last step or those that were set since.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    orders: *const Int32,
    values: *mut Float64,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetOutputDerivatives, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        let orders = array(orders, value_reference_count, "orders")?;
        let (outputs, orders) = with_orders(unit, references, orders)?;
        check_count("nValues", value_count, ("variables", outputs.len()))?;
        write(values, &unit.output_derivatives(&outputs, &orders)?, "values")
    })
}

/// Returns the elements of variables, each with the order requested for its variable.
fn with_orders(
    unit: &Unit,
    references: &[Reference],
    orders: &[Int32],
) -> Answer<(Vec<Reference>, Vec<Int32>)> {
    let arrays = unit.arrays();
    let (mut outputs, mut of_each) = (Vec::new(), Vec::new());
    for (&reference, &order) in references.iter().zip(orders) {
        outputs.extend(unit.elements(&arrays, &[reference])?);
        of_each.resize(outputs.len(), order);
    }
    Ok((outputs, of_each))
}

/// # Safety
/// As for [`array`].
unsafe fn elements(
    unit: &Unit,
    references: *const Reference,
    count: usize,
    name: &str,
) -> Answer<Vec<Reference>> {
    // SAFETY: by contract.
    let references = unsafe { array(references, count, name)? };
    unit.elements(&unit.arrays(), references)
}

fn check_count(argument: &str, count: usize, (of, size): (&str, usize)) -> Answer<()> {
    if count == size {
        return Ok(());
    }
    Err(Refusal::error(format!("{argument} is {count}; the {of} have {size} elements")))
}

//! FMI functions that differentiate: sections 2.1.9 and 4.2.1 of the standard.

use super::table::Fmi2;
use super::types::{Handle, Integer, Real, Reference};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::arguments::{array, write};
use crate::fmi::gate::gated;

/// Differentiates outputs by inputs along one direction.
///
/// The result is exact with respect to inputs, at constant unknowns of the bodies: it is the response without delay. In
/// initialization mode parameters are known too; with respect to these it is accurate to about 1e-10.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Handle,
    unknowns: *const Reference,
    unknown_count: usize,
    knowns: *const Reference,
    known_count: usize,
    known_changes: *const Real,
    unknown_changes: *mut Real,
) -> Status {
    gated!(component, Fmi2::fmi2GetDirectionalDerivative, |unit| {
        let unknowns = array(unknowns, unknown_count, "vUnknown_ref")?;
        let knowns = array(knowns, known_count, "vKnown_ref")?;
        let changes = array(known_changes, known_count, "dvKnown")?;
        let found = unit.directional_derivative(unknowns, knowns, changes)?;
        write(unknown_changes, &found, "dvUnknown")
    })
}

/// Sets time derivatives of inputs.
///
/// The derivatives act in the next step and, unless set again, only there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Handle,
    references: *const Reference,
    count: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    gated!(component, Fmi2::fmi2SetRealInputDerivatives, |unit| {
        let references = array(references, count, "vr")?;
        let orders = array(orders, count, "order")?;
        unit.set_input_derivatives(references, orders, array(values, count, "value")?)
    })
}

/// Reads time derivatives of outputs.
///
/// They are exact, under the inputs and input derivatives at the end of the last step, or those that were set since.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Handle,
    references: *const Reference,
    count: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    gated!(component, Fmi2::fmi2GetRealOutputDerivatives, |unit| {
        let references = array(references, count, "vr")?;
        let found = unit.output_derivatives(references, array(orders, count, "order")?)?;
        write(values, &found, "value")
    })
}

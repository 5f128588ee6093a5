//! FMI functions that differentiate: sections 2.1.9 and 4.2.1 of the standard.

use super::instance::{array, call, write};
use super::legality::Fmi2;
use super::types::{Handle, Integer, Real, Reference, Status};

/// With respect to inputs exact, with the unknowns of the bodies held: what outputs follow at once.
/// In initialization mode parameters are known too; with respect to these to about 1e-10.
///
/// # Safety
/// Pointers are null or as the standard asks.
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
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetDirectionalDerivative, |unit| {
            let unknowns = array(unknowns, unknown_count, "vUnknown_ref")?;
            let knowns = array(knowns, known_count, "vKnown_ref")?;
            let changes = array(known_changes, known_count, "dvKnown")?;
            let found = unit.directional_derivative(unknowns, knowns, changes)?;
            write(unknown_changes, &found, "dvUnknown")
        })
    }
}

/// The derivatives act in the next step and, unless set again, only there.
///
/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Handle,
    references: *const Reference,
    count: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetRealInputDerivatives, |unit| {
            let references = array(references, count, "vr")?;
            let orders = array(orders, count, "order")?;
            unit.set_input_derivatives(references, orders, array(values, count, "value")?)
        })
    }
}

/// Exact, under the inputs and the derivatives of inputs that the last step ended with, or that have
/// been set since.
///
/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Handle,
    references: *const Reference,
    count: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetRealOutputDerivatives, |unit| {
            let references = array(references, count, "vr")?;
            let found = unit.output_derivatives(references, array(orders, count, "order")?)?;
            write(values, &found, "value")
        })
    }
}

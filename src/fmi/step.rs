//! FMI functions of co-simulation, section 4.2 of the standard.
//!
//! A step is done when fmi2DoStep returns, so there is no pending status to ask for.

use std::ffi::c_int;

use super::instance::{call, interrupt, write};
use super::legality::Fmi2;
use super::refused::Reason;
use super::types::{
    Answer, Boolean, Handle, Integer, LAST_SUCCESSFUL_TIME, Real, Refusal, Status, TERMINATED, Text,
};

/// A refused step leaves the unit as it was: the master may correct inputs or times and try again. So
/// does a discarded one, but what may follow it is a saved state, a reset or the end.
///
/// No state is needed but the one that the master asks for, so the last argument changes nothing.
///
/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Handle,
    point: Real,
    step: Real,
    _no_set_state_prior_to_current_point: Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::DoStep, |unit| unit.step(point, step)) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    component: Handle,
    kind: c_int,
    value: *mut Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetRealStatus, |unit| match kind {
            LAST_SUCCESSFUL_TIME => write(value, &[unit.time()], "value"),
            _ => no_status(kind),
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Status,
) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::GetStatus, |_| no_status(kind)) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Integer,
) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::GetIntegerStatus, |_| no_status(kind)) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    component: Handle,
    kind: c_int,
    value: *mut Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetBooleanStatus, |_| match kind {
            // A unit never wants to end the simulation.
            TERMINATED => write(value, &[0], "value"),
            _ => no_status(kind),
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Text,
) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::GetStringStatus, |_| no_status(kind)) }
}

fn no_status(kind: c_int) -> Answer {
    let names =
        ["fmi2DoStepStatus", "fmi2PendingStatus", "fmi2LastSuccessfulTime", "fmi2Terminated"];
    let name = usize::try_from(kind).ok().and_then(|kind| names.get(kind));
    Err(Refusal::discard(match name {
        Some(name) => format!("no answer to {name}: steps are done when fmi2DoStep returns"),
        None => format!("status kind {kind} is unknown"),
    }))
}

/// The standard knows it for steps that are pending. Here it ends a step that another thread is in: that
/// fmi2DoStep discards the step between two rounds of its computation, and leaves the unit as it was, in
/// the state stepCanceled.
///
/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe {
        if interrupt(component, Fmi2::CancelStep) {
            return Status::Ok;
        }
        call(component, Fmi2::CancelStep, |_| Err(Reason::NothingPending.into()))
    }
}

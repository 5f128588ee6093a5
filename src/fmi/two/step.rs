//! FMI functions of co-simulation, section 4.2 of the standard.
//!
//! A step is complete when fmi2DoStep returns, so there is no pending status.

use std::ffi::c_int;

use super::table::Fmi2;
use super::types::{Boolean, Handle, Integer, LAST_SUCCESSFUL_TIME, Real, TERMINATED, Text};
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::fmi::gate::arguments::write;
use crate::fmi::gate::gated;
use crate::fmi::gate::instance::{call, interrupt};
use crate::fmi::table::Reason;

/// Advances the unit by a step.
///
/// A refused step leaves the unit unchanged: the master may correct inputs or times and try again. So does a discarded
/// one, after which only a saved state, a reset or termination is allowed.
///
/// No state is kept except those saved by the master, so the last argument has no effect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Handle,
    point: Real,
    step: Real,
    _no_set_state_prior_to_current_point: Boolean,
) -> Status {
    gated!(component, Fmi2::fmi2DoStep, |unit| unit.step(point, step))
}

/// Reads the time of the last successful step; no other numbers exist.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    component: Handle,
    kind: c_int,
    value: *mut Real,
) -> Status {
    gated!(component, Fmi2::fmi2GetRealStatus, |unit| match kind {
        LAST_SUCCESSFUL_TIME => write(value, &[unit.time()], "value"),
        _ => no_status(kind),
    })
}

/// Discards every request: no step is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Status,
) -> Status {
    gated!(component, Fmi2::fmi2GetStatus, |_| no_status(kind))
}

/// Discards every request: no step is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Integer,
) -> Status {
    gated!(component, Fmi2::fmi2GetIntegerStatus, |_| no_status(kind))
}

/// Reports that the unit does not request termination; it never does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    component: Handle,
    kind: c_int,
    value: *mut Boolean,
) -> Status {
    gated!(component, Fmi2::fmi2GetBooleanStatus, |_| match kind {
        // A unit never requests termination.
        TERMINATED => write(value, &[0], "value"),
        _ => no_status(kind),
    })
}

/// Discards every request: no step is pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    component: Handle,
    kind: c_int,
    _value: *mut Text,
) -> Status {
    gated!(component, Fmi2::fmi2GetStringStatus, |_| no_status(kind))
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

/// Cancels the step under way.
///
/// The standard defines this for pending steps. Here it ends a step that runs on another thread. The fmi2DoStep of that
/// thread discards the step between two rounds of its computation, and leaves the unit unchanged in the state
/// stepCanceled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe {
        if interrupt(component, Fmi2::fmi2CancelStep) {
            return Status::Ok;
        }
        call(component, Fmi2::fmi2CancelStep, |_| Err(Reason::NothingPending.into()))
    }
}

//! FMI functions of model exchange, section 3.2 of the standard. A unit is for co-simulation; the
//! functions exist so that tools which look up all names find them. All of them are refused.

use super::instance::call;
use super::legality::Fmi2;
use super::refused::Reason;
use super::types::{Boolean, EventInfo, Handle, Real, Status};

/// Refuses, with the reason in the log.
///
/// # Safety
/// `component` is null or comes from fmi2Instantiate.
unsafe fn refuse(component: Handle, function: Fmi2) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, function, |_| Err(Reason::ModelExchange.into())) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterEventMode(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::EnterEventMode) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(
    component: Handle,
    _event_info: *mut EventInfo,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::NewDiscreteStates) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterContinuousTimeMode(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::EnterContinuousTimeMode) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    component: Handle,
    _no_set_state_prior_to_current_point: Boolean,
    _enter_event_mode: *mut Boolean,
    _terminate_simulation: *mut Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::CompletedIntegratorStep) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetTime(component: Handle, _time: Real) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::SetTime) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetContinuousStates(
    component: Handle,
    _states: *const Real,
    _count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::SetContinuousStates) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDerivatives(
    component: Handle,
    _derivatives: *mut Real,
    _count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::GetDerivatives) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetEventIndicators(
    component: Handle,
    _indicators: *mut Real,
    _count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::GetEventIndicators) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetContinuousStates(
    component: Handle,
    _states: *mut Real,
    _count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::GetContinuousStates) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(
    component: Handle,
    _nominals: *mut Real,
    _count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(component, Fmi2::GetNominalsOfContinuousStates) }
}

//! FMI functions of modes that a unit never enters: events, clocks, configuration, model exchange and
//! scheduled execution. They exist so that tools which look up all names find them. All are refused.

use super::legality::Fmi3;
use super::types::{Boolean, Clock, Float64, Handle, IntervalQualifier, Reference, UInt64};
use crate::fmi::instance::call;
use crate::fmi::legality::Function;
use crate::fmi::types::Status;

/// Refuses, with the reason in the log.
///
/// # Safety
/// As for [`call`].
unsafe fn refuse(instance: Handle, function: Fmi3) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, function, |_| Err(function.never().into())) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterEventMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::EnterEventMode) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterStepMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::EnterStepMode) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EvaluateDiscreteStates(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::EvaluateDiscreteStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: Handle,
    _discrete_states_need_update: *mut Boolean,
    _terminate_simulation: *mut Boolean,
    _nominals_of_continuous_states_changed: *mut Boolean,
    _values_of_continuous_states_changed: *mut Boolean,
    _next_event_time_defined: *mut Boolean,
    _next_event_time: *mut Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::UpdateDiscreteStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterConfigurationMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::EnterConfigurationMode) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitConfigurationMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::ExitConfigurationMode) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetClock(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _values: *mut Clock,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetClock) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetClock(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _values: *const Clock,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetClock) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetIntervalDecimal(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _intervals: *mut Float64,
    _qualifiers: *mut IntervalQualifier,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetIntervalDecimal) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetIntervalFraction(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _counters: *mut UInt64,
    _resolutions: *mut UInt64,
    _qualifiers: *mut IntervalQualifier,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetIntervalFraction) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetShiftDecimal(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _shifts: *mut Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetShiftDecimal) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetShiftFraction(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _counters: *mut UInt64,
    _resolutions: *mut UInt64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetShiftFraction) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetIntervalDecimal(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _intervals: *const Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetIntervalDecimal) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetIntervalFraction(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _counters: *const UInt64,
    _resolutions: *const UInt64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetIntervalFraction) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetShiftDecimal(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _shifts: *const Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetShiftDecimal) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetShiftFraction(
    instance: Handle,
    _value_references: *const Reference,
    _value_reference_count: usize,
    _counters: *const UInt64,
    _resolutions: *const UInt64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetShiftFraction) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterContinuousTimeMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::EnterContinuousTimeMode) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
    instance: Handle,
    _no_set_fmustate_prior_to_current_point: Boolean,
    _enter_event_mode: *mut Boolean,
    _terminate_simulation: *mut Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::CompletedIntegratorStep) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetTime(instance: Handle, _time: Float64) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetTime) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetContinuousStates(
    instance: Handle,
    _continuous_states: *const Float64,
    _continuous_state_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::SetContinuousStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStateDerivatives(
    instance: Handle,
    _derivatives: *mut Float64,
    _continuous_state_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetContinuousStateDerivatives) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetEventIndicators(
    instance: Handle,
    _event_indicators: *mut Float64,
    _event_indicator_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetEventIndicators) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStates(
    instance: Handle,
    _continuous_states: *mut Float64,
    _continuous_state_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetContinuousStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNominalsOfContinuousStates(
    instance: Handle,
    _nominals: *mut Float64,
    _continuous_state_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetNominalsOfContinuousStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(
    instance: Handle,
    _event_indicator_count: *mut usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetNumberOfEventIndicators) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(
    instance: Handle,
    _continuous_state_count: *mut usize,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::GetNumberOfContinuousStates) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ActivateModelPartition(
    instance: Handle,
    _clock_reference: Reference,
    _activation_time: Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe { refuse(instance, Fmi3::ActivateModelPartition) }
}

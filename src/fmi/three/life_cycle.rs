//! FMI functions of life cycle and log, section 2.3 of the standard.

use std::path::Path;

use super::callbacks::{to_ask, to_log_message};
use super::table::Fmi3;
use super::types::{
    Boolean, ClockUpdate, Environment, FALSE, Float64, Handle, IntermediateUpdate, LogMessage,
    Preemption, Reference, Text,
};
use crate::fmi::gate::answer::{Refusal, Status};
use crate::fmi::gate::arguments::text;
use crate::fmi::gate::gated;
use crate::fmi::gate::instance::take_back;
use crate::fmi::gate::life_cycle::{instantiate, no_instance, set_logging};
use crate::fmi::gate::log::Log;
use crate::fmi::table::Reason;
use crate::fmi::unit::{Experiment, StepControl, Unit, read};

/// Names the version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}

/// Creates an instance of the unit whose resources are at a path.
///
/// Inputs are constant over a step, and no variable takes part in intermediate updates. These report the progress of a
/// step of droplets, and let the master end it early.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    early_return_allowed: Boolean,
    _required_intermediate_variables: *const Reference,
    required_intermediate_variable_count: usize,
    instance_environment: Environment,
    log_message: LogMessage,
    intermediate_update: IntermediateUpdate,
) -> Handle {
    let log = Log::new(to_log_message(log_message, instance_environment), logging_on != FALSE);
    let control = StepControl {
        may_end_early: early_return_allowed != FALSE,
        reports_events: event_mode_used != FALSE,
        ask: to_ask(intermediate_update, instance_environment),
    };
    instantiate::<Fmi3>("fmi3InstantiateCoSimulation", log, control, || {
        // SAFETY: by contract.
        let (name, token, resources) = unsafe {
            (
                text(instance_name, "instanceName")?,
                text(instantiation_token, "instantiationToken")?,
                text(resource_path, "resourcePath")?,
            )
        };
        if name.trim().is_empty() {
            return Err(Refusal::error("instanceName is empty"));
        }
        if required_intermediate_variable_count > 0 {
            return Err(Refusal::error("no variable takes part in intermediate updates"));
        }
        let packed = read(Path::new(resources), token).map_err(Refusal::error)?;
        match event_mode_used != FALSE && !packed.has_events() {
            true => Err(Reason::NoEvents.into()),
            false => Ok(packed),
        }
    })
}

/// Refuses to make an instance for model exchange.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _instance_name: Text,
    _instantiation_token: Text,
    _resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    instance_environment: Environment,
    log_message: LogMessage,
) -> Handle {
    let log = Log::new(to_log_message(log_message, instance_environment), logging_on != FALSE);
    no_instance("fmi3InstantiateModelExchange", &log, Reason::ModelExchange.into())
}

/// Refuses to make an instance for scheduled execution.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: Text,
    _instantiation_token: Text,
    _resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    instance_environment: Environment,
    log_message: LogMessage,
    _clock_update: ClockUpdate,
    _lock_preemption: Preemption,
    _unlock_preemption: Preemption,
) -> Handle {
    let log = Log::new(to_log_message(log_message, instance_environment), logging_on != FALSE);
    no_instance("fmi3InstantiateScheduledExecution", &log, Reason::ScheduledExecution.into())
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: Handle) {
    // SAFETY: by contract.
    unsafe { take_back(instance, Fmi3::fmi3FreeInstance) }
}

/// Switches logging, and chooses categories of messages.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Handle,
    logging_on: Boolean,
    category_count: usize,
    categories: *const Text,
) -> Status {
    gated!(instance, Fmi3::fmi3SetDebugLogging, |unit| {
        set_logging(unit, logging_on != FALSE, categories, category_count)
    })
}

/// Sets the times of the experiment and begins the initialization. A tolerance is checked but not used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Handle,
    tolerance_defined: Boolean,
    tolerance: Float64,
    start_time: Float64,
    stop_time_defined: Boolean,
    stop_time: Float64,
) -> Status {
    gated!(instance, Fmi3::fmi3EnterInitializationMode, |unit| {
        let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
        let stop = (stop_time_defined != FALSE).then_some(stop_time);
        unit.set_experiment(tolerance, Experiment { start: start_time, stop })?;
        unit.enter_initialization()
    })
}

/// Ends the initialization; from here on parameters are fixed. Masters that use Event Mode are in it then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: Handle) -> Status {
    gated!(instance, Fmi3::fmi3ExitInitializationMode, Unit::finish_initialization)
}

/// Ends the run; values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: Handle) -> Status {
    gated!(instance, Fmi3::fmi3Terminate, Unit::terminate)
}

/// Restores the start values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: Handle) -> Status {
    gated!(instance, Fmi3::fmi3Reset, Unit::reset)
}

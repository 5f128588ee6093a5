//! FMI functions of life cycle and log, section 2.3 of the standard.

use std::ffi::CString;
use std::path::Path;
use std::ptr;
use std::rc::Rc;

use super::legality::Fmi3;
use super::types::{
    Boolean, ClockUpdate, Environment, FALSE, Float64, Handle, IntermediateUpdate, LogMessage,
    Preemption, Reference, Text,
};
use crate::fmi::common::{text, texts};
use crate::fmi::float_environment;
use crate::fmi::instance::{call, hand_out, take_back};
use crate::fmi::legality::Phase;
use crate::fmi::log::{Log, Sink};
use crate::fmi::panics;
use crate::fmi::refused::Reason;
use crate::fmi::step_control::{Ask, StepControl};
use crate::fmi::types::{Refusal, Status};
use crate::fmi::unit::{Experiment, Unit, read};

/// The callback of FMI 3.0, whose messages are no formats.
fn to_log_message(callback: LogMessage, environment: Environment) -> Sink {
    Box::new(move |status, category, message| {
        let Some(callback) = callback else { return };
        let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
        // SAFETY: the callback came with fmi3Instantiate… and has this signature; the strings live
        // through the call.
        float_environment::of_host(|| unsafe {
            callback(environment, status, category.as_ptr(), message.as_ptr());
        });
    })
}

/// Tells the host of a step under way. No variable takes part in that: none can be set or read then.
fn to_ask(callback: IntermediateUpdate, environment: Environment) -> Option<Ask> {
    let callback = callback?;
    Some(Box::new(move |time, may_end_early| {
        let (mut wanted, mut end) = (FALSE, time);
        let can_return_early = Boolean::from(may_end_early);
        // SAFETY: the callback came with fmi3InstantiateCoSimulation and has this signature; both places
        // live through the call.
        float_environment::of_host(|| unsafe {
            let (wanted, end) = (&raw mut wanted, &raw mut end);
            callback(
                environment,
                time,
                FALSE,
                FALSE,
                Boolean::from(true),
                can_return_early,
                wanted,
                end,
            );
        });
        (wanted != FALSE).then_some(end)
    }))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}

/// Inputs are held over a step, and no variable is for intermediate updates: these tell how far a step of
/// droplets has come, and let the master end it there.
///
/// # Safety
/// Pointers are null or as the standard asks.
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
        ask: to_ask(intermediate_update, instance_environment),
    };
    let load = || {
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
        if event_mode_used != FALSE {
            return Err(Reason::NoEvents.into());
        }
        if required_intermediate_variable_count > 0 {
            return Err(Refusal::error("no variable takes part in intermediate updates"));
        }
        read(Path::new(resources), token).map_err(Refusal::error)
    };
    match panics::caught(load).unwrap_or_else(|panic| Err(Refusal::error(panic))) {
        Ok(packed) => {
            let mut unit = Unit::new(packed, log);
            unit.control = Rc::new(control);
            hand_out::<Fmi3>(unit)
        }
        Err(refusal) => no_instance("fmi3InstantiateCoSimulation", &log, refusal),
    }
}

/// Tells why there is no instance.
fn no_instance(function: &str, log: &Log, refusal: Refusal) -> Handle {
    log.send(refusal.status, &format!("{function}: {}", refusal.message));
    ptr::null_mut()
}

/// # Safety
/// Pointers are null or as the standard asks.
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

/// # Safety
/// Pointers are null or as the standard asks.
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

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: Handle) {
    // SAFETY: by contract.
    unsafe { take_back(instance, Fmi3::FreeInstance) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Handle,
    logging_on: Boolean,
    category_count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SetDebugLogging, |unit| {
            let names = texts(categories, category_count, "categories")?;
            unit.log.configure(logging_on != FALSE, &names).map_err(Refusal::error)?;
            Ok(Status::Ok)
        })
    }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Handle,
    tolerance_defined: Boolean,
    tolerance: Float64,
    start_time: Float64,
    stop_time_defined: Boolean,
    stop_time: Float64,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::EnterInitializationMode, |unit| {
            let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
            let stop = (stop_time_defined != FALSE).then_some(stop_time);
            unit.set_experiment(tolerance, Experiment { start: start_time, stop })?;
            unit.phase = Phase::InitializationMode;
            Ok(Status::Ok)
        })
    }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, Fmi3::ExitInitializationMode, Unit::finish_initialization) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, Fmi3::Terminate, Unit::terminate) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, Fmi3::Reset, Unit::reset) }
}

//! FMI functions of life cycle and log, section 2.1 of the standard.

use std::ffi::{CStr, c_int};
use std::ptr;

use super::logger::to_logger;
use super::table::Fmi2;
use super::types::{Boolean, CO_SIMULATION, Callbacks, Handle, Real, Text};
use super::uri;
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::fmi::gate::arguments::text;
use crate::fmi::gate::gated;
use crate::fmi::gate::instance::take_back;
use crate::fmi::gate::life_cycle::{instantiate, set_logging};
use crate::fmi::gate::log::Log;
use crate::fmi::unit::{Experiment, StepControl, Unit, read};

/// Names the platform whose C types the functions take.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

/// Names the version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// Creates an instance of the unit whose resources are at a URI.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: Text,
    fmu_type: c_int,
    guid: Text,
    resource_location: Text,
    functions: *const Callbacks,
    _visible: Boolean,
    logging_on: Boolean,
) -> Handle {
    if functions.is_null() {
        return ptr::null_mut();
    }
    // SAFETY: by contract.
    let (name, callbacks) = unsafe {
        let name = if instance_name.is_null() { c"" } else { CStr::from_ptr(instance_name) };
        (name, &*functions)
    };
    let log = Log::new(to_logger(name, callbacks), logging_on != 0);
    instantiate::<Fmi2>("fmi2Instantiate", log, StepControl::default(), || {
        check_name_and_type(name, fmu_type)?;
        // SAFETY: by contract.
        let (guid, resources) =
            unsafe { (text(guid, "fmuGUID")?, text(resource_location, "fmuResourceLocation")?) };
        let folder = uri::to_path(resources).map_err(Refusal::error)?;
        read(&folder, guid).map_err(Refusal::error)
    })
}

fn check_name_and_type(name: &CStr, fmu_type: c_int) -> Answer<()> {
    if name.is_empty() {
        return Err(Refusal::error("instanceName is empty"));
    }
    if fmu_type != CO_SIMULATION {
        let message = format!("fmuType {fmu_type} is not fmi2CoSimulation, the only type offered");
        return Err(Refusal::error(message));
    }
    Ok(())
}

/// Frees an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Handle) {
    // SAFETY: by contract.
    unsafe { take_back(component, Fmi2::fmi2FreeInstance) }
}

/// Switches logging, and chooses categories of messages.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    logging_on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    gated!(component, Fmi2::fmi2SetDebugLogging, |unit| {
        set_logging(unit, logging_on != 0, categories, count)
    })
}

/// Sets the times of the experiment. A tolerance is checked but not used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Handle,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    gated!(component, Fmi2::fmi2SetupExperiment, |unit| {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        let stop = (stop_defined != 0).then_some(stop);
        unit.set_experiment(tolerance, Experiment { start, stop })
    })
}

/// Begins the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: Handle) -> Status {
    gated!(component, Fmi2::fmi2EnterInitializationMode, Unit::enter_initialization)
}

/// Ends the initialization; from here on parameters are fixed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: Handle) -> Status {
    gated!(component, Fmi2::fmi2ExitInitializationMode, Unit::finish_initialization)
}

/// Ends the run; values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Handle) -> Status {
    gated!(component, Fmi2::fmi2Terminate, Unit::terminate)
}

/// Restores the start values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Handle) -> Status {
    gated!(component, Fmi2::fmi2Reset, Unit::reset)
}

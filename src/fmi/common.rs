//! FMI functions of life cycle and log, section 2.1 of the standard.

use std::ffi::{CStr, c_int};
use std::ptr;

use super::instance::{array, call, hand_out, take_back};
use super::legality::{Fmi2, Phase};
use super::log::{Log, to_logger};
use super::panics;
use super::types::{
    Answer, Boolean, CO_SIMULATION, Callbacks, Handle, Real, Refusal, Status, Text,
};
use super::unit::{Experiment, Unit, read};
use super::uri;

/// The text behind a C string.
///
/// # Safety
/// `text` is null or a C string that lives through the call.
pub unsafe fn text<'a>(text: Text, name: &str) -> Answer<&'a str> {
    if text.is_null() {
        return Err(Refusal::error(format!("{name} is a null pointer")));
    }
    // SAFETY: by contract.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Refusal::error(format!("{name} {text:?} is not UTF-8")))
}

/// The texts behind an array of C strings.
///
/// # Safety
/// As for [`array`] and [`text`].
pub unsafe fn texts(pointer: *const Text, length: usize, name: &str) -> Answer<Vec<String>> {
    // SAFETY: by contract.
    unsafe {
        let pointers = array(pointer, length, name)?;
        pointers.iter().map(|&pointer| Ok(text(pointer, name)?.to_owned())).collect()
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// # Safety
/// Pointers are null or as the standard asks.
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
    let load = || {
        check_name_and_type(name, fmu_type)?;
        // SAFETY: by contract.
        let (guid, resources) =
            unsafe { (text(guid, "fmuGUID")?, text(resource_location, "fmuResourceLocation")?) };
        let folder = uri::to_path(resources).map_err(Refusal::error)?;
        read(&folder, guid).map_err(Refusal::error)
    };
    match panics::caught(load).unwrap_or_else(|panic| Err(Refusal::error(panic))) {
        Ok(packed) => hand_out::<Fmi2>(Unit::new(packed, log)),
        Err(refusal) => {
            log.send(refusal.status, &format!("fmi2Instantiate: {}", refusal.message));
            ptr::null_mut()
        }
    }
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

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Handle) {
    // SAFETY: by contract.
    unsafe { take_back(component, Fmi2::FreeInstance) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    logging_on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetDebugLogging, |unit| {
            let names = texts(categories, count, "categories")?;
            unit.log.configure(logging_on != 0, &names).map_err(Refusal::error)?;
            Ok(Status::Ok)
        })
    }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Handle,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetupExperiment, |unit| {
            let tolerance = (tolerance_defined != 0).then_some(tolerance);
            let stop = (stop_defined != 0).then_some(stop);
            unit.set_experiment(tolerance, Experiment { start, stop })
        })
    }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::EnterInitializationMode, |unit| {
            unit.phase = Phase::InitializationMode;
            Ok(Status::Ok)
        })
    }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::ExitInitializationMode, Unit::finish_initialization) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::Terminate, Unit::terminate) }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Handle) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Fmi2::Reset, Unit::reset) }
}

//! All functions of FMI 2.0 are exported, and survive null pointers.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::null_mut;

use crate::master::{ERROR, Handle, call, free, library};

/// The functions that act on an instance, in the order of the standard's header.
const ON_AN_INSTANCE: [&str; 40] = [
    "fmi2SetDebugLogging",
    "fmi2SetupExperiment",
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2Terminate",
    "fmi2Reset",
    "fmi2GetReal",
    "fmi2GetInteger",
    "fmi2GetBoolean",
    "fmi2GetString",
    "fmi2SetReal",
    "fmi2SetInteger",
    "fmi2SetBoolean",
    "fmi2SetString",
    "fmi2GetFMUstate",
    "fmi2SetFMUstate",
    "fmi2FreeFMUstate",
    "fmi2SerializedFMUstateSize",
    "fmi2SerializeFMUstate",
    "fmi2DeSerializeFMUstate",
    "fmi2GetDirectionalDerivative",
    "fmi2EnterEventMode",
    "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode",
    "fmi2CompletedIntegratorStep",
    "fmi2SetTime",
    "fmi2SetContinuousStates",
    "fmi2GetDerivatives",
    "fmi2GetEventIndicators",
    "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates",
    "fmi2SetRealInputDerivatives",
    "fmi2GetRealOutputDerivatives",
    "fmi2DoStep",
    "fmi2CancelStep",
    "fmi2GetStatus",
    "fmi2GetRealStatus",
    "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus",
    "fmi2GetStringStatus",
];

#[test]
fn all_44_functions_are_exported() {
    let others = ["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate", "fmi2FreeInstance"];
    for name in ON_AN_INSTANCE.into_iter().chain(others) {
        // SAFETY: the symbol is only looked up.
        unsafe { library().get::<*const c_void>(name) }.expect(name);
    }
}

#[test]
fn version_and_platform_are_the_standards() {
    for (name, expected) in [("fmi2GetVersion", c"2.0"), ("fmi2GetTypesPlatform", c"default")] {
        // SAFETY: both take nothing and return a static string.
        let text = unsafe {
            let function = library().get::<unsafe extern "C" fn() -> *const c_char>(name).unwrap();
            CStr::from_ptr(function())
        };
        assert_eq!(text, expected);
    }
}

/// With an instance of null no other argument is looked at, so zeros do for all of them.
#[test]
fn no_instance_is_an_error_and_no_crash() {
    for name in ON_AN_INSTANCE {
        let status = call!(name, null_mut() => Handle, 0 => usize, 0 => usize, 0 => usize,
            0 => usize, 0 => usize, 0 => usize);
        assert_eq!(status, ERROR, "{name}");
    }
    free(null_mut());
}

#[test]
fn a_pointer_to_something_else_is_an_error() {
    let mut other = [0_u64; 64];
    let pointer: Handle = other.as_mut_ptr().cast();
    assert_eq!(call!("fmi2Reset", pointer => Handle), ERROR);
    let unaligned: Handle = pointer.wrapping_byte_add(1);
    assert_eq!(
        call!("fmi2DoStep", unaligned => Handle, 0.0 => f64, 1e-8 => f64, 1 => c_int),
        ERROR
    );
    free(pointer);
    assert_eq!(other, [0; 64]);
}

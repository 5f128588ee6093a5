//! What the library exports for FMI 3.0, and how the versions keep apart.

use std::ffi::{CStr, c_char, c_void};
use std::ptr::null_mut;

use super::life_cycle::functions;
use super::master::{Unit, free};
use crate::master::{self, ERROR, Handle, call, library};

#[test]
fn all_75_functions_are_exported() {
    let others = [
        "fmi3GetVersion",
        "fmi3InstantiateModelExchange",
        "fmi3InstantiateCoSimulation",
        "fmi3InstantiateScheduledExecution",
        "fmi3FreeInstance",
    ];
    let names: Vec<&str> = functions().into_iter().chain(others).collect();
    assert_eq!(names.len(), 75);
    for name in names {
        // SAFETY: the symbol is only looked up.
        unsafe { library().get::<*const c_void>(name) }.expect(name);
    }
}

#[test]
fn the_version_is_the_standards() {
    // SAFETY: the function takes nothing and returns a static string.
    let text = unsafe {
        type Function = unsafe extern "C" fn() -> *const c_char;
        CStr::from_ptr(library().get::<Function>("fmi3GetVersion").unwrap()())
    };
    assert_eq!(text, c"3.0");
}

/// With an instance of null no other argument is looked at, so zeros do for all of them.
#[test]
fn no_instance_is_an_error_and_no_crash() {
    for name in functions() {
        let status = call!(name, null_mut() => Handle, 0 => usize, 0 => usize, 0 => usize,
            0 => usize, 0 => usize, 0 => usize, 0 => usize, 0 => usize);
        assert_eq!(status, ERROR, "{name}");
    }
    free(null_mut());
}

#[test]
fn an_instance_of_one_version_is_none_of_the_other() {
    let (two, three) = (master::Unit::running(), Unit::running());
    assert_eq!(call!("fmi3Reset", two.handle => Handle), ERROR);
    assert_eq!(call!("fmi2Reset", three.handle => Handle), ERROR);
    free(two.handle);
    master::free(three.handle);
    assert_eq!(two.get("plate.heat_in"), 0.0);
    assert_eq!(three.get("plate.heat_in"), [0.0]);
}

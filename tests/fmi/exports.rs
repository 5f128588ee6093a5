//! All functions of both versions are exported, survive null pointers, and keep apart.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::null_mut;

use crate::functions::names;
use crate::master::{
    ERROR, Handle, Three, Two, UnitOf, Version, both_versions, call, free, library,
};

both_versions! { no_instance_is_an_error_and_no_crash }

#[track_caller]
fn exported<V: Version>(count: usize) {
    let names: Vec<&str> = names::<V>().into_iter().chain(V::OTHERS.iter().copied()).collect();
    assert_eq!(names.len(), count);
    for name in names {
        // SAFETY: the symbol is only looked up.
        unsafe { library().get::<*const c_void>(name) }.expect(name);
    }
}

#[test]
fn all_44_functions_of_fmi_2_and_75_of_fmi_3_are_exported() {
    exported::<Two>(44);
    exported::<Three>(75);
}

#[test]
fn versions_and_platform_are_the_standards() {
    for (name, expected) in [
        ("fmi2GetVersion", c"2.0"),
        ("fmi2GetTypesPlatform", c"default"),
        ("fmi3GetVersion", c"3.0"),
    ] {
        // SAFETY: all take nothing and return a static string.
        let text = unsafe {
            let function = library().get::<unsafe extern "C" fn() -> *const c_char>(name).unwrap();
            CStr::from_ptr(function())
        };
        assert_eq!(text, expected);
    }
}

/// With an instance of null no other argument is looked at, so zeros do for all of them.
fn no_instance_is_an_error_and_no_crash<V: Version>() {
    for name in names::<V>() {
        let status = call!(name, null_mut() => Handle, 0 => usize, 0 => usize, 0 => usize,
            0 => usize, 0 => usize, 0 => usize, 0 => usize, 0 => usize);
        assert_eq!(status, ERROR, "{name}");
    }
    free(null_mut());
    crate::master::three::free(null_mut());
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

#[test]
fn an_instance_of_one_version_is_none_of_the_other() {
    let (two, three) = (UnitOf::<Two>::running(), UnitOf::<Three>::running());
    assert_eq!(call!("fmi3Reset", two.handle => Handle), ERROR);
    assert_eq!(call!("fmi2Reset", three.handle => Handle), ERROR);
    crate::master::three::free(two.handle);
    free(three.handle);
    assert_eq!(two.get("plate.heat_in"), 0.0);
    assert_eq!(three.get("plate.heat_in"), [0.0]);
}

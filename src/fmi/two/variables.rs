//! FMI functions that get and set variables.

use super::table::Fmi2;
use super::types::{Boolean, Handle, Integer, Real, Reference, Text};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::arguments::{array, texts, write, write_texts};
use crate::fmi::gate::gated;
use crate::fmi::gate::refusing::absent;

/// Reads values of Real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Real,
) -> Status {
    gated!(component, Fmi2::fmi2GetReal, |unit| {
        write(values, &unit.reals(array(references, count, "vr")?)?, "value")
    })
}

/// Reads values of Integer variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Integer,
) -> Status {
    gated!(component, Fmi2::fmi2GetInteger, |unit| {
        write(values, &unit.integers(array(references, count, "vr")?)?, "value")
    })
}

/// Refuses all variables: none is Boolean.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Handle,
    references: *const Reference,
    count: usize,
    _values: *mut Boolean,
) -> Status {
    // SAFETY: by the contract of exported functions.
    unsafe { absent(component, Fmi2::fmi2GetBoolean, references, count) }
}

/// Reads texts. They stay in place until the next call on the instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Text,
) -> Status {
    gated!(component, Fmi2::fmi2GetString, |unit| {
        write_texts(values, unit.texts(array(references, count, "vr")?)?, "value")
    })
}

/// Sets Real variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Real,
) -> Status {
    gated!(component, Fmi2::fmi2SetReal, |unit| {
        unit.set_reals(array(references, count, "vr")?, array(values, count, "value")?)
    })
}

/// Sets Integer variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Integer,
) -> Status {
    gated!(component, Fmi2::fmi2SetInteger, |unit| {
        unit.set_integers(array(references, count, "vr")?, array(values, count, "value")?)
    })
}

/// Refuses all variables: none is Boolean.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Handle,
    references: *const Reference,
    count: usize,
    _values: *const Boolean,
) -> Status {
    // SAFETY: by the contract of exported functions.
    unsafe { absent(component, Fmi2::fmi2SetBoolean, references, count) }
}

/// Sets String variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Text,
) -> Status {
    gated!(component, Fmi2::fmi2SetString, |unit| {
        unit.set_texts(array(references, count, "vr")?, texts(values, count, "value")?)
    })
}

//! FMI functions that get and set variables.

use super::common::texts;
use super::instance::{array, call, write};
use super::legality::Fmi2;
use super::types::{Boolean, Handle, Integer, Real, Reference, Status, Text};

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetReal, |unit| {
            let found = unit.reals(array(references, count, "vr")?)?;
            write(values, &found, "value")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Integer,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetInteger, |unit| {
            let found = unit.integers(array(references, count, "vr")?)?;
            write(values, &found, "value")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Handle,
    references: *const Reference,
    count: usize,
    _values: *mut Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetBoolean, |unit| {
            unit.check_booleans(array(references, count, "vr")?)
        })
    }
}

/// The texts stay where they are until the next call on the instance.
///
/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *mut Text,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::GetString, |unit| {
            let found = unit.texts(array(references, count, "vr")?)?;
            let pointers: Vec<Text> = found.iter().map(|text| text.as_ptr()).collect();
            write(values, &pointers, "value")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Real,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetReal, |unit| {
            unit.set_reals(array(references, count, "vr")?, array(values, count, "value")?)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Integer,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetInteger, |unit| {
            unit.set_integers(array(references, count, "vr")?, array(values, count, "value")?)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Handle,
    references: *const Reference,
    count: usize,
    _values: *const Boolean,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetBoolean, |unit| {
            unit.check_booleans(array(references, count, "vr")?)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Handle,
    references: *const Reference,
    count: usize,
    values: *const Text,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Fmi2::SetString, |unit| {
            unit.set_texts(array(references, count, "vr")?, texts(values, count, "value")?)
        })
    }
}

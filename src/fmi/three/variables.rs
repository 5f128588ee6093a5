//! FMI functions that get and set variables of the types in use.

use super::legality::Fmi3;
use super::types::{Float64, Handle, Int32, Reference, Text};
use crate::fmi::common::texts;
use crate::fmi::instance::{array, call, write};
use crate::fmi::types::Status;

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Float64,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::GetFloat64, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            write(values, &unit.floats(references, value_count)?, "values")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Int32,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::GetInt32, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            write(values, &unit.whole_numbers(references, value_count)?, "values")
        })
    }
}

/// The texts stay where they are until the next call on the instance.
///
/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Text,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::GetString, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            let found = unit.strings(references, value_count)?;
            let pointers: Vec<Text> = found.iter().map(|text| text.as_ptr()).collect();
            write(values, &pointers, "values")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Float64,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SetFloat64, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            unit.set_floats(references, array(values, value_count, "values")?)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Int32,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SetInt32, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            unit.set_whole_numbers(references, array(values, value_count, "values")?)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Text,
    value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SetString, |unit| {
            let references = array(value_references, value_reference_count, "valueReferences")?;
            unit.set_strings(references, texts(values, value_count, "values")?)
        })
    }
}

//! FMI functions that get and set variables of the types in use.

use super::table::Fmi3;
use super::types::{Float64, Handle, Int32, Reference, Text};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::arguments::{array, texts, write, write_texts};
use crate::fmi::gate::gated;

/// Reads values of Float64 variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Float64,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetFloat64, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        write(values, &unit.floats(references, value_count)?, "values")
    })
}

/// Reads values of Int32 variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Int32,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetInt32, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        write(values, &unit.whole_numbers(references, value_count)?, "values")
    })
}

/// Reads texts. They stay in place until the next call on the instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *mut Text,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetString, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        write_texts(values, unit.strings(references, value_count)?, "values")
    })
}

/// Sets Float64 variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Float64,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3SetFloat64, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        unit.set_floats(references, array(values, value_count, "values")?)
    })
}

/// Sets Int32 variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Int32,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3SetInt32, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        unit.set_whole_numbers(references, array(values, value_count, "values")?)
    })
}

/// Sets String variables, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    values: *const Text,
    value_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3SetString, |unit| {
        let references = array(value_references, value_reference_count, "valueReferences")?;
        unit.set_strings(references, texts(values, value_count, "values")?)
    })
}

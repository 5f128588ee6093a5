//! FMI functions that get and set variables of types that no variable of a unit has. Asked for none,
//! they do nothing; asked for one, they refuse.

use super::legality::Fmi3;
use super::types::{
    Binary, Boolean, Float32, Handle, Int8, Int16, Int64, Reference, UInt8, UInt16, UInt32, UInt64,
};
use crate::fmi::instance::{array, call};
use crate::fmi::types::Status;

/// # Safety
/// As for [`call`] and [`array`].
unsafe fn check_absent(
    instance: Handle,
    function: Fmi3,
    references: *const Reference,
    count: usize,
    kind: &str,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, function, |unit| {
            unit.check_absent(array(references, count, "valueReferences")?, kind)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut Float32,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetFloat32, value_references, value_reference_count, "Float32")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt8(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut Int8,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetInt8, value_references, value_reference_count, "Int8")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetUInt8(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut UInt8,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetUInt8, value_references, value_reference_count, "UInt8")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt16(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut Int16,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetInt16, value_references, value_reference_count, "Int16")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetUInt16(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut UInt16,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetUInt16, value_references, value_reference_count, "UInt16")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetUInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut UInt32,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetUInt32, value_references, value_reference_count, "UInt32")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut Int64,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetInt64, value_references, value_reference_count, "Int64")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetUInt64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut UInt64,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetUInt64, value_references, value_reference_count, "UInt64")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBoolean(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *mut Boolean,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetBoolean, value_references, value_reference_count, "Boolean")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _value_sizes: *mut usize,
    _values: *mut Binary,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::GetBinary, value_references, value_reference_count, "Binary")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const Float32,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetFloat32, value_references, value_reference_count, "Float32")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt8(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const Int8,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetInt8, value_references, value_reference_count, "Int8")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetUInt8(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const UInt8,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetUInt8, value_references, value_reference_count, "UInt8")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt16(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const Int16,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetInt16, value_references, value_reference_count, "Int16")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetUInt16(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const UInt16,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetUInt16, value_references, value_reference_count, "UInt16")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetUInt32(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const UInt32,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetUInt32, value_references, value_reference_count, "UInt32")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const Int64,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetInt64, value_references, value_reference_count, "Int64")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetUInt64(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const UInt64,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetUInt64, value_references, value_reference_count, "UInt64")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBoolean(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _values: *const Boolean,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetBoolean, value_references, value_reference_count, "Boolean")
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBinary(
    instance: Handle,
    value_references: *const Reference,
    value_reference_count: usize,
    _value_sizes: *const usize,
    _values: *const Binary,
    _value_count: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        check_absent(instance, Fmi3::SetBinary, value_references, value_reference_count, "Binary")
    }
}

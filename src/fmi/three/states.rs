//! FMI functions that save and restore states, section 2.2 of the standard. The states are those of the
//! same unit under FMI 2.0, bytes included.

use super::legality::Fmi3;
use super::step::stay_in_step_mode;
use super::types::{Byte, Handle, SavedState};
use crate::fmi::instance::call;
use crate::fmi::states;
use crate::fmi::types::Status;

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: Handle, fmu_state: *mut SavedState) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, Fmi3::GetFMUState, |unit| states::save(unit, fmu_state)) }
}

/// # Safety
/// `instance` is null or comes from fmi3InstantiateCoSimulation; `fmu_state` may be anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: Handle, fmu_state: SavedState) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SetFMUState, |unit| {
            let status = unit.restore(fmu_state)?;
            stay_in_step_mode(unit);
            Ok(status)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: Handle, fmu_state: *mut SavedState) -> Status {
    // SAFETY: by contract.
    unsafe { call(instance, Fmi3::FreeFMUState, |unit| states::free(unit, fmu_state)) }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: Handle,
    fmu_state: SavedState,
    size: *mut usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SerializedFMUStateSize, |unit| {
            states::serialized_size(unit, fmu_state, size)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: Handle,
    fmu_state: SavedState,
    serialized_state: *mut Byte,
    size: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::SerializeFMUState, |unit| {
            states::serialize(unit, fmu_state, serialized_state, size)
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: Handle,
    serialized_state: *const Byte,
    size: usize,
    fmu_state: *mut SavedState,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::DeserializeFMUState, |unit| {
            states::deserialize(unit, serialized_state, size, fmu_state)
        })
    }
}

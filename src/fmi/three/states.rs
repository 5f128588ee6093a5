//! FMI functions that save and restore states, section 2.2 of the standard. The states, including their bytes, are
//! those of the same unit under FMI 2.0.

use super::step::stay_in_step_mode;
use super::table::Fmi3;
use super::types::{Byte, Handle, SavedState};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::{gated, states};

/// Saves the state, in the place that `fmu_state` points to or in a new one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: Handle, fmu_state: *mut SavedState) -> Status {
    gated!(instance, Fmi3::fmi3GetFMUState, |unit| states::save(unit, fmu_state))
}

/// Restores a saved state, which stays saved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: Handle, fmu_state: SavedState) -> Status {
    gated!(instance, Fmi3::fmi3SetFMUState, |unit| {
        let status = unit.restore(fmu_state)?;
        stay_in_step_mode(unit);
        Ok(status)
    })
}

/// Frees a saved state and leaves null in its place.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: Handle, fmu_state: *mut SavedState) -> Status {
    gated!(instance, Fmi3::fmi3FreeFMUState, |unit| states::free(unit, fmu_state))
}

/// Returns the number of bytes of a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: Handle,
    fmu_state: SavedState,
    size: *mut usize,
) -> Status {
    gated!(instance, Fmi3::fmi3SerializedFMUStateSize, |unit| {
        states::serialized_size(unit, fmu_state, size)
    })
}

/// Writes a saved state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: Handle,
    fmu_state: SavedState,
    serialized_state: *mut Byte,
    size: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3SerializeFMUState, |unit| {
        states::serialize(unit, fmu_state, serialized_state, size)
    })
}

/// Creates a saved state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: Handle,
    serialized_state: *const Byte,
    size: usize,
    fmu_state: *mut SavedState,
) -> Status {
    gated!(instance, Fmi3::fmi3DeserializeFMUState, |unit| {
        states::deserialize(unit, serialized_state, size, fmu_state)
    })
}

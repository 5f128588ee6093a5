//! FMI functions that save and restore states, section 2.1.8 of the standard.

use super::table::Fmi2;
use super::types::{Byte, Handle, SavedState};
use crate::fmi::gate::answer::Status;
use crate::fmi::gate::{gated, states};

/// Saves the state, in the place that `state` points to or in a new one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Handle, state: *mut SavedState) -> Status {
    gated!(component, Fmi2::fmi2GetFMUstate, |unit| states::save(unit, state))
}

/// Restores a saved state, which stays saved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Handle, state: SavedState) -> Status {
    gated!(component, Fmi2::fmi2SetFMUstate, |unit| unit.restore(state))
}

/// Frees a saved state and leaves null in its place.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Handle, state: *mut SavedState) -> Status {
    gated!(component, Fmi2::fmi2FreeFMUstate, |unit| states::free(unit, state))
}

/// Returns the number of bytes of a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Handle,
    state: SavedState,
    size: *mut usize,
) -> Status {
    gated!(component, Fmi2::fmi2SerializedFMUstateSize, |unit| {
        states::serialized_size(unit, state, size)
    })
}

/// Writes a saved state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Handle,
    state: SavedState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    gated!(component, Fmi2::fmi2SerializeFMUstate, |unit| {
        states::serialize(unit, state, bytes.cast(), size)
    })
}

/// Creates a saved state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Handle,
    bytes: *const Byte,
    size: usize,
    state: *mut SavedState,
) -> Status {
    gated!(component, Fmi2::fmi2DeSerializeFMUstate, |unit| {
        states::deserialize(unit, bytes.cast(), size, state)
    })
}

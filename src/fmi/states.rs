//! FMI functions that save and restore states, section 2.1.8 of the standard.

use super::instance::{array, call, null, write};
use super::legality::Function;
use super::types::{Byte, Handle, Refusal, SavedState, Status};

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Handle, state: *mut SavedState) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Function::GetFMUstate, |unit| {
            let place = array(state, 1, "FMUstate")?[0];
            write(state, &[unit.save(place)?], "FMUstate")
        })
    }
}

/// # Safety
/// `component` is null or comes from fmi2Instantiate; `state` may be anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Handle, state: SavedState) -> Status {
    // SAFETY: by contract.
    unsafe { call(component, Function::SetFMUstate, |unit| unit.restore(state)) }
}

/// Leaves a null pointer in `state`; one that is null already is ignored.
///
/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Handle, state: *mut SavedState) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Function::FreeFMUstate, |unit| {
            if state.is_null() || (*state).is_null() {
                return Ok(Status::Ok);
            }
            unit.saved.remove(*state)?;
            write(state, &[std::ptr::null_mut()], "FMUstate")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: Handle,
    state: SavedState,
    size: *mut usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Function::SerializedFMUstateSize, |unit| {
            let bytes = unit.serialize(unit.saved.get(state)?);
            write(size, &[bytes.len()], "size")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Handle,
    state: SavedState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Function::SerializeFMUstate, |unit| {
            let found = unit.serialize(unit.saved.get(state)?);
            if size < found.len() {
                let wanted = found.len();
                let message = format!("room for {size} bytes; the saved state takes {wanted}");
                return Err(Refusal::error(message));
            }
            write(bytes.cast(), &found, "serializedState")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Handle,
    bytes: *const Byte,
    size: usize,
    state: *mut SavedState,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(component, Function::DeSerializeFMUstate, |unit| {
            let snapshot = unit.deserialize(array(bytes.cast(), size, "serializedState")?)?;
            if state.is_null() {
                return Err(null("FMUstate"));
            }
            write(state, &[unit.saved.insert(snapshot)], "FMUstate")
        })
    }
}

//! Saves and restores states through C pointers, in every version of the standard.

use super::answer::{Answer, Refusal, SavedState, Status};
use super::arguments::{array, null, write};
use crate::fmi::unit::{Unit, expect_room};

/// Largest number of copies of a state's bytes in memory while they are read.
const COPIES: usize = 4;

/// Saves the unit's state in the place that `state` points to, or in a new one if that is null.
///
/// # Safety
/// Pointers are null or valid by the standard, here and in the functions below.
pub unsafe fn save(unit: &mut Unit, state: *mut SavedState) -> Answer {
    // SAFETY: by contract.
    unsafe {
        let place = array(state, 1, "FMUstate")?[0];
        write(state, &[unit.save(place)?], "FMUstate")
    }
}

/// Leaves a null pointer in `state`; one that is null already is ignored.
///
/// # Safety
/// As for [`save`].
pub unsafe fn free(unit: &mut Unit, state: *mut SavedState) -> Answer {
    // SAFETY: by contract.
    unsafe {
        if state.is_null() || (*state).is_null() {
            return Ok(Status::Ok);
        }
        unit.saved.remove(*state)?;
        write(state, &[std::ptr::null_mut()], "FMUstate")
    }
}

/// Writes the number of bytes that a saved state takes.
///
/// # Safety
/// As for [`save`].
pub unsafe fn serialized_size(unit: &Unit, state: SavedState, size: *mut usize) -> Answer {
    unit.expect_room()?;
    let bytes = unit.serialize(unit.saved.get(state)?);
    // SAFETY: by contract.
    unsafe { write(size, &[bytes.len()], "size") }
}

/// Writes the bytes of a saved state into room for `size` of them.
///
/// # Safety
/// As for [`save`].
pub unsafe fn serialize(unit: &Unit, state: SavedState, bytes: *mut u8, size: usize) -> Answer {
    unit.expect_room()?;
    let found = unit.serialize(unit.saved.get(state)?);
    if size < found.len() {
        let wanted = found.len();
        let message = format!("room for {size} bytes; the saved state takes {wanted}");
        return Err(Refusal::error(message));
    }
    // SAFETY: by contract.
    unsafe { write(bytes, &found, "serializedState") }
}

/// Creates a saved state from bytes, in a new place.
///
/// # Safety
/// As for [`save`].
pub unsafe fn deserialize(
    unit: &mut Unit,
    bytes: *const u8,
    size: usize,
    state: *mut SavedState,
) -> Answer {
    // SAFETY: by contract.
    unsafe {
        expect_room(COPIES * size)?;
        let snapshot = unit.deserialize(array(bytes, size, "serializedState")?)?;
        if state.is_null() {
            return Err(null("FMUstate"));
        }
        write(state, &[unit.saved.insert(snapshot)], "FMUstate")
    }
}

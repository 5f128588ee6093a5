//! Converts arguments of C functions to slices and texts, and writes results to the master's memory.

use std::ffi::{CStr, CString};
use std::{ptr, slice};

use super::answer::{Answer, Refusal, Status, Text};

/// Converts a C array to a slice.
///
/// # Safety
/// `pointer` is null or points to `length` values that stay unchanged during the call.
pub unsafe fn array<'a, T>(pointer: *const T, length: usize, name: &str) -> Answer<&'a [T]> {
    match (pointer.is_null(), length) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(name)),
        // No array can be larger: its size in bytes would overflow.
        (false, _) if length > isize::MAX as usize / size_of::<T>() => {
            Err(Refusal::error(format!("{length} elements of {name} are more than fit any memory")))
        }
        // SAFETY: by contract.
        (false, _) => Ok(unsafe { slice::from_raw_parts(pointer, length) }),
    }
}

/// Writes results to a C array.
///
/// # Safety
/// `pointer` is null or points to memory for as many values.
pub unsafe fn write<T: Copy>(pointer: *mut T, values: &[T], name: &str) -> Answer {
    if values.is_empty() {
        return Ok(Status::Ok);
    }
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: by contract.
    unsafe { ptr::copy_nonoverlapping(values.as_ptr(), pointer, values.len()) };
    Ok(Status::Ok)
}

/// The refusal of a null pointer.
pub fn null(name: &str) -> Refusal {
    Refusal::error(format!("{name} is a null pointer"))
}

/// The text behind a C string.
///
/// # Safety
/// `text` is null or a C string that lives through the call.
pub unsafe fn text<'a>(text: Text, name: &str) -> Answer<&'a str> {
    if text.is_null() {
        return Err(null(name));
    }
    // SAFETY: by contract.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Refusal::error(format!("{name} {text:?} is not UTF-8")))
}

/// The texts behind an array of C strings.
///
/// # Safety
/// As for [`array`] and [`text`].
pub unsafe fn texts(pointer: *const Text, length: usize, name: &str) -> Answer<Vec<String>> {
    // SAFETY: by contract.
    unsafe {
        let pointers = array(pointer, length, name)?;
        pointers.iter().map(|&pointer| Ok(text(pointer, name)?.to_owned())).collect()
    }
}

/// Writes pointers to texts, which must stay in place until the master has read them.
///
/// # Safety
/// As for [`write`].
pub unsafe fn write_texts(pointer: *mut Text, texts: &[CString], name: &str) -> Answer {
    let pointers: Vec<Text> = texts.iter().map(|text| text.as_ptr()).collect();
    // SAFETY: by contract.
    unsafe { write(pointer, &pointers, name) }
}

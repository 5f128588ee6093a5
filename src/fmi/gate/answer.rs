//! Result of a call, and the C types common to all versions of the standard.

use std::ffi::{c_char, c_void};

/// An instance: `fmi2Component`, `fmi3Instance`.
pub type Handle = *mut c_void;
/// A saved state: `fmi2FMUstate`, `fmi3FMUState`.
pub type SavedState = *mut c_void;
/// A value reference.
pub type Reference = u32;
/// A C string.
pub type Text = *const c_char;

/// `fmi2Status`, `fmi3Status`. `fmi2Pending` is missing: every call is done when it returns.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    Ok = 0,
    Warning = 1,
    Discard = 2,
    Error = 3,
    Fatal = 4,
}

/// Reason why a call was refused, with the status to return.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    pub status: Status,
    pub message: String,
}

impl Refusal {
    /// A refusal as `fmi2Error` or `fmi3Error`.
    pub fn error(message: impl Into<String>) -> Self {
        Self { status: Status::Error, message: message.into() }
    }

    /// A refusal as `fmi2Discard` or `fmi3Discard`.
    pub fn discard(message: impl Into<String>) -> Self {
        Self { status: Status::Discard, message: message.into() }
    }
}

/// Result of a call: its value, or the refusal.
pub type Answer<T = Status> = Result<T, Refusal>;

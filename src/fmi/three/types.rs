//! C types of `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`.
//!
//! C `bool` values, and enumerations passed by a master, are declared as integers, because any value may arrive.

use std::ffi::{c_char, c_int, c_void};

use crate::fmi::gate::answer::Status;

/// `fmi3Instance`.
pub type Handle = *mut c_void;
pub type Environment = *mut c_void;
/// `fmi3FMUState`.
pub type SavedState = *mut c_void;
pub type Reference = u32;
pub type Float32 = f32;
pub type Float64 = f64;
pub type Int8 = i8;
pub type UInt8 = u8;
pub type Int16 = i16;
pub type UInt16 = u16;
pub type Int32 = i32;
pub type UInt32 = u32;
pub type Int64 = i64;
pub type UInt64 = u64;
pub type Boolean = u8;
pub type Clock = u8;
pub type Text = *const c_char;
pub type Byte = u8;
pub type Binary = *const Byte;

/// `fmi3DependencyKind`.
pub type DependencyKind = c_int;
/// `fmi3IntervalQualifier`.
pub type IntervalQualifier = c_int;

/// `fmi3Dependent` of `fmi3DependencyKind`.
pub const DEPENDENT: DependencyKind = 5;
/// `fmi3False`.
pub const FALSE: Boolean = 0;

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessage = Option<unsafe extern "C" fn(Environment, Status, Text, Text)>;

/// `fmi3IntermediateUpdateCallback`: environment, time, whether variables may be set or read, whether a step has
/// finished and whether this one may end early; outputs whether and when it should end.
pub type IntermediateUpdate = Option<
    unsafe extern "C" fn(
        Environment,
        Float64,
        Boolean,
        Boolean,
        Boolean,
        Boolean,
        *mut Boolean,
        *mut Float64,
    ),
>;

/// `fmi3ClockUpdateCallback` of scheduled execution.
pub type ClockUpdate = Option<unsafe extern "C" fn(Environment)>;

/// `fmi3LockPreemptionCallback` and `fmi3UnlockPreemptionCallback` of scheduled execution.
pub type Preemption = Option<unsafe extern "C" fn()>;

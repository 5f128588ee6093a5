//! C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`.
//!
//! Enumerations passed by a master are declared as integers, because any value may arrive.

use std::ffi::{c_char, c_int, c_uint, c_void};

use crate::fmi::gate::answer::Status;

/// `fmi2Component`.
pub type Handle = *mut c_void;
pub type Environment = *mut c_void;
/// `fmi2FMUstate`.
pub type SavedState = *mut c_void;
pub type Reference = c_uint;
pub type Real = f64;
pub type Integer = c_int;
pub type Boolean = c_int;
pub type Text = *const c_char;
pub type Byte = c_char;

/// `fmi2CoSimulation` of `fmi2Type`.
pub const CO_SIMULATION: c_int = 1;
/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
pub const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated` of `fmi2StatusKind`.
pub const TERMINATED: c_int = 3;

/// `fmi2CallbackLogger`: environment, instance name, status, category, `printf` format, …
pub type Logger = Option<unsafe extern "C" fn(Environment, Text, Status, Text, Text, ...)>;

/// `fmi2CallbackFunctions`. Memory functions are declared as unused in the XML.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Callbacks {
    pub logger: Logger,
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(Environment, Status)>,
    pub component_environment: Environment,
}

/// `fmi2EventInfo` of model exchange.
#[repr(C)]
pub struct EventInfo {
    pub new_discrete_states_needed: Boolean,
    pub terminate_simulation: Boolean,
    pub nominals_of_continuous_states_changed: Boolean,
    pub values_of_continuous_states_changed: Boolean,
    pub next_event_time_defined: Boolean,
    pub next_event_time: Real,
}

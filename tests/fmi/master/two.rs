//! Calls of FMI 2.0 alone.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr;

use super::unit::Unit as UnitOf;
use super::{Folder, Handle, Message, Messages, OK, Two, call, free_instance, library, own_guid};

type LoggerFn =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`. The logger is declared without its variable arguments, which it does not
/// look at; all C ABIs in use allow that.
#[repr(C)]
pub struct Callbacks {
    pub logger: Option<LoggerFn>,
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    pub environment: *mut c_void,
}

unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// Formats as masters written in C do, and keeps the result.
unsafe extern "C" fn logger(
    environment: *mut c_void,
    instance: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
) {
    let mut buffer = [0; 4096];
    // SAFETY: the environment is a `Messages` that outlives the instance; the strings are C strings.
    unsafe {
        snprintf(buffer.as_mut_ptr(), buffer.len(), format);
        let text = |pointer| CStr::from_ptr(pointer).to_str().unwrap().to_owned();
        let message = Message {
            instance: text(instance),
            status,
            category: text(category),
            text: text(buffer.as_ptr()),
        };
        (*environment.cast::<Messages>()).keep(message);
    }
}

/// Arguments of fmi2Instantiate, all good until a test changes one.
pub struct Arguments {
    pub name: Option<CString>,
    pub fmu_type: c_int,
    pub guid: Option<CString>,
    pub resources: Option<CString>,
    pub logging_on: c_int,
    pub with_logger: bool,
}

impl Arguments {
    pub fn good(folder: &Folder) -> Self {
        Self::of(folder, &own_guid())
    }

    /// Those of a unit with this GUID.
    pub fn of(folder: &Folder, guid: &str) -> Self {
        Self {
            name: Some(c"unit".into()),
            fmu_type: 1,
            guid: Some(CString::new(guid).unwrap()),
            resources: Some(CString::new(folder.uri()).unwrap()),
            logging_on: 1,
            with_logger: true,
        }
    }

    pub fn instantiate(&self, messages: &Messages) -> Handle {
        let callbacks = Callbacks {
            logger: self.with_logger.then_some(logger as LoggerFn),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment: ptr::from_ref(messages).cast_mut().cast(),
        };
        self.instantiate_with(&callbacks)
    }

    pub fn instantiate_with(&self, callbacks: *const Callbacks) -> Handle {
        type Function = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Handle;
        let pointer =
            |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
        // SAFETY: the types are those of the header; the strings live through the call.
        unsafe {
            let instantiate = library().get::<Function>("fmi2Instantiate").unwrap();
            instantiate(
                pointer(&self.name),
                self.fmu_type,
                pointer(&self.guid),
                pointer(&self.resources),
                callbacks,
                0,
                self.logging_on,
            )
        }
    }
}

/// Frees an instance of FMI 2.0.
pub fn free(handle: Handle) {
    free_instance("fmi2FreeInstance", handle);
}

/// An instance of FMI 2.0.
pub type Unit = UnitOf<Two>;

impl Unit {
    pub fn setup(&self, start: f64, stop: Option<f64>) -> c_int {
        call!("fmi2SetupExperiment", self.handle => Handle, 0 => c_int, 0.0 => f64,
            start => f64, stop.is_some().into() => c_int, stop.unwrap_or(0.0) => f64)
    }

    pub fn enter(&self) -> c_int {
        self.simple("fmi2EnterInitializationMode")
    }

    pub fn step(&self, point: f64, step: f64) -> c_int {
        call!("fmi2DoStep", self.handle => Handle, point => f64, step => f64, 1 => c_int)
    }

    pub fn set(&self, name: &str, value: f64) -> c_int {
        self.put(name, value)
    }

    /// The value of a real, which must be readable now.
    pub fn get(&self, name: &str) -> f64 {
        self.value(name)
    }

    /// Changes of outputs with inputs, which must exist.
    pub fn directional_derivative(&self, outputs: &[u32], inputs: &[u32], by: &[f64]) -> Vec<f64> {
        let mut found = vec![f64::NAN; outputs.len()];
        let status = self.directional_derivative_in(outputs, inputs, by, &mut found);
        assert_eq!(status, OK, "{:?}", self.messages.take());
        found
    }

    pub fn directional_derivative_in(
        &self,
        outputs: &[u32],
        inputs: &[u32],
        by: &[f64],
        found: &mut [f64],
    ) -> c_int {
        call!("fmi2GetDirectionalDerivative", self.handle => Handle,
            outputs.as_ptr() => *const u32, outputs.len() => usize,
            inputs.as_ptr() => *const u32, inputs.len() => usize,
            by.as_ptr() => *const f64, found.as_mut_ptr() => *mut f64)
    }

    pub fn set_derivative(&self, name: &str, order: c_int, value: f64) -> c_int {
        let reference = self.reference(name);
        call!("fmi2SetRealInputDerivatives", self.handle => Handle,
            &raw const reference => *const u32, 1 => usize, &raw const order => *const c_int,
            &raw const value => *const f64)
    }

    pub fn output_derivatives_in(
        &self,
        outputs: &[u32],
        orders: &[c_int],
        found: &mut [f64],
    ) -> c_int {
        call!("fmi2GetRealOutputDerivatives", self.handle => Handle,
            outputs.as_ptr() => *const u32, outputs.len() => usize,
            orders.as_ptr() => *const c_int, found.as_mut_ptr() => *mut f64)
    }

    /// fmi2GetBooleanStatus(fmi2Terminated).
    pub fn wants_to_end(&self) -> c_int {
        let mut value = -1;
        let status = call!("fmi2GetBooleanStatus", self.handle => Handle, 3 => c_int,
            &raw mut value => *mut c_int);
        assert_eq!(status, OK);
        value
    }
}

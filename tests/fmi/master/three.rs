//! Calls of FMI 3.0 alone.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr;

use impinge::variables::{Causality, Content, Slot};

use super::unit::Unit as UnitOf;
use super::{Folder, Handle, Message, Messages, OK, Three, Version, call, free_instance, library};

type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// `fmi3LogMessageCallback` that keeps what it is told.
pub unsafe extern "C" fn listen(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the environment is a `Messages` that outlives the instance; the strings are C strings.
    unsafe {
        let owned = |pointer| CStr::from_ptr(pointer).to_str().unwrap().to_owned();
        let (category, text) = (owned(category), owned(text));
        let message = Message { instance: String::new(), status, category, text };
        (*environment.cast::<Messages>()).keep(message);
    }
}

/// Arguments of fmi3InstantiateCoSimulation, all good until a test changes one.
pub struct Arguments {
    pub name: Option<CString>,
    pub token: Option<CString>,
    pub resources: Option<CString>,
    pub logging_on: bool,
    pub event_mode_used: bool,
    pub intermediate: Vec<u32>,
    pub early_return_allowed: bool,
    pub update: Option<IntermediateUpdate>,
}

pub type IntermediateUpdate =
    unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);

impl Arguments {
    pub fn good(folder: &Folder, token: &str) -> Self {
        let path = format!("{}/", folder.0.display());
        Self {
            name: Some(c"unit".into()),
            token: Some(CString::new(token).unwrap()),
            resources: Some(CString::new(path).unwrap()),
            logging_on: true,
            event_mode_used: false,
            intermediate: Vec::new(),
            early_return_allowed: true,
            update: None,
        }
    }

    pub fn instantiate(&self, messages: &Messages) -> Handle {
        type Function = unsafe extern "C" fn(
            *const c_char,
            *const c_char,
            *const c_char,
            bool,
            bool,
            bool,
            bool,
            *const u32,
            usize,
            *mut c_void,
            Option<LogMessage>,
            Option<IntermediateUpdate>,
        ) -> Handle;
        let pointer =
            |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
        // SAFETY: the types are those of the header; the strings live through the call.
        unsafe {
            let function = library().get::<Function>("fmi3InstantiateCoSimulation").unwrap();
            function(
                pointer(&self.name),
                pointer(&self.token),
                pointer(&self.resources),
                false,
                self.logging_on,
                self.event_mode_used,
                self.early_return_allowed,
                self.intermediate.as_ptr(),
                self.intermediate.len(),
                ptr::from_ref(messages).cast_mut().cast(),
                Some(listen),
                self.update,
            )
        }
    }
}

/// Frees an instance of FMI 3.0.
pub fn free(handle: Handle) {
    free_instance("fmi3FreeInstance", handle);
}

/// What fmi3DoStep answers with besides its status.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped {
    pub flags: [bool; 3],
    pub time: f64,
}

/// An instance of FMI 3.0.
pub type Unit = UnitOf<Three>;

impl Unit {
    /// An instance of a scene with other arguments than usual.
    pub fn instantiated_with(text: &str, change: impl Fn(&mut Arguments)) -> Self {
        Self::made(text, |folder, guid, messages| {
            let mut arguments = Arguments::good(folder, guid);
            change(&mut arguments);
            arguments.instantiate(messages)
        })
    }

    pub fn enter(&self, start: f64, stop: Option<f64>) -> c_int {
        call!("fmi3EnterInitializationMode", self.handle => Handle, false => bool, 0.0 => f64,
            start => f64, stop.is_some() => bool, stop.unwrap_or(0.0) => f64)
    }

    pub fn step(&self, point: f64, step: f64) -> (c_int, Stepped) {
        let (mut flags, mut time) = ([true; 3], f64::NAN);
        let [event, end, early] = &mut flags;
        let status = call!("fmi3DoStep", self.handle => Handle, point => f64, step => f64,
            true => bool, event => *mut bool, end => *mut bool, early => *mut bool,
            &raw mut time => *mut f64);
        (status, Stepped { flags, time })
    }

    pub fn references(&self, names: &[&str]) -> Vec<u32> {
        names.iter().map(|name| self.reference(name)).collect()
    }

    /// Number of elements of variables.
    pub fn size(&self, references: &[u32]) -> usize {
        Three::size(self, references)
    }

    /// The elements of variables, which must be readable now.
    pub fn get_all(&self, references: &[u32]) -> Vec<f64> {
        let mut values = vec![f64::NAN; self.size(references)];
        assert_eq!(self.get_in(references, &mut values), OK, "{:?}", self.messages.take());
        values
    }

    pub fn get(&self, name: &str) -> Vec<f64> {
        self.get_all(&[self.reference(name)])
    }

    pub fn set(&self, name: &str, values: &[f64]) -> c_int {
        self.set_all(&[self.reference(name)], values)
    }

    /// Value references of all Float64 variables of one causality.
    pub fn floats(&self, causality: Option<Causality>) -> Vec<u32> {
        let fits = |reference: &u32| {
            let variable = &self.arrays.variables[*reference as usize];
            let slot = variable.elements(&self.registry).first().map(|element| &element.slot);
            !matches!(slot, Some(Slot::Threads | Slot::OutputDirectory))
                && variable.causality(&self.registry) == causality
        };
        (0..self.arrays.variables.len() as u32).filter(fits).collect()
    }

    /// fmi3GetDirectionalDerivative or fmi3GetAdjointDerivative.
    pub fn differentiate_in(
        &self,
        function: &str,
        [unknowns, knowns]: [&[u32]; 2],
        seed: &[f64],
        found: &mut [f64],
    ) -> c_int {
        call!(function, self.handle => Handle, unknowns.as_ptr() => *const u32,
            unknowns.len() => usize, knowns.as_ptr() => *const u32, knowns.len() => usize,
            seed.as_ptr() => *const f64, seed.len() => usize,
            found.as_mut_ptr() => *mut f64, found.len() => usize)
    }

    pub fn directional(&self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Vec<f64> {
        let mut found = vec![f64::NAN; self.size(unknowns)];
        let name = "fmi3GetDirectionalDerivative";
        let status = self.differentiate_in(name, [unknowns, knowns], seed, &mut found);
        assert_eq!(status, OK, "{:?}", self.messages.take());
        found
    }

    pub fn adjoint(&self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Vec<f64> {
        let mut found = vec![f64::NAN; self.size(knowns)];
        let name = "fmi3GetAdjointDerivative";
        let status = self.differentiate_in(name, [unknowns, knowns], seed, &mut found);
        assert_eq!(status, OK, "{:?}", self.messages.take());
        found
    }

    pub fn output_derivatives_in(
        &self,
        references: &[u32],
        orders: &[c_int],
        found: &mut [f64],
    ) -> c_int {
        call!("fmi3GetOutputDerivatives", self.handle => Handle,
            references.as_ptr() => *const u32, references.len() => usize,
            orders.as_ptr() => *const c_int, found.as_mut_ptr() => *mut f64,
            found.len() => usize)
    }

    /// The names of the scalars that the elements of Float64 variables are under FMI 2.0.
    pub fn scalar_names(&self, references: &[u32]) -> Vec<&str> {
        let elements = |&reference: &u32| {
            let variable = &self.arrays.variables[reference as usize];
            assert!(matches!(variable.content, Content::Elements(_)), "{}", variable.name);
            variable.elements(&self.registry).iter().map(|element| element.name.as_str())
        };
        references.iter().flat_map(elements).collect()
    }
}

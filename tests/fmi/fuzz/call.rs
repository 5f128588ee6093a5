//! A call as plain data, and how it is done.
//!
//! Arrays are always as long as their counts say, or null: a library cannot recognise anything else.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use super::world::Kind;
use crate::master::{Handle, call};

/// A line of a script.
#[derive(Debug, Clone)]
pub struct Line {
    pub instance: usize,
    pub call: Call,
    /// Whether all that can be seen of the instance is compared before and after.
    pub watched: bool,
}

#[derive(Debug, Clone)]
pub enum Call {
    /// An instance that is there is freed first.
    Instantiate(Birth),
    Free,
    Logging {
        on: bool,
        categories: Vec<&'static str>,
        nulls: Nulls,
    },
    Setup {
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    },
    /// A function that takes nothing but the instance.
    Plain(&'static str),
    /// A function of model exchange, called with zeros.
    Exchange(&'static str),
    Get {
        kind: Kind,
        references: Vec<u32>,
        nulls: Nulls,
    },
    Set {
        kind: Kind,
        references: Vec<u32>,
        values: Vec<f64>,
        nulls: Nulls,
    },
    SetTexts {
        references: Vec<u32>,
        values: Vec<Option<&'static [u8]>>,
        nulls: Nulls,
    },
    Step {
        point: Point,
        size: f64,
    },
    Status {
        name: &'static str,
        kind: c_int,
        null: bool,
    },
    State(StateCall),
    Directional {
        unknowns: Vec<u32>,
        knowns: Vec<u32>,
        changes: Vec<f64>,
        nulls: Nulls,
    },
    InputDerivatives {
        references: Vec<u32>,
        orders: Vec<c_int>,
        values: Vec<f64>,
        nulls: Nulls,
    },
    OutputDerivatives {
        references: Vec<u32>,
        orders: Vec<c_int>,
        nulls: Nulls,
    },
}

/// How fmi2Instantiate is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Birth {
    Good,
    NoCallbacks,
    NoName,
    NoGuid,
    OtherGuid,
    NoResources,
    ForModelExchange,
}

/// Which arrays are null.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nulls {
    None,
    References,
    Values,
    /// All of them, and the count says that there is more than memory can hold.
    AllOfMany,
}

/// The communication point of a step.
#[derive(Debug, Clone, Copy)]
pub enum Point {
    /// Where the instance is.
    Here,
    /// Away from there by this part of the step.
    Off(f64),
    At(f64),
}

/// A saved state is named by the instance that saved it and one of its places.
pub type Place = (usize, usize);

#[derive(Debug, Clone, Copy)]
pub enum StateCall {
    Save {
        into: Place,
    },
    SaveNowhere,
    Restore {
        from: Place,
    },
    Free {
        of: Place,
    },
    /// The bytes are kept with the place; `room` is added to their number.
    Serialize {
        of: Place,
        room: isize,
    },
    /// From the bytes kept with `bytes`, some cut off or one changed.
    Deserialize {
        bytes: Place,
        into: Place,
        cut: usize,
        changed: Option<usize>,
    },
}

pub const PLACES: usize = 2;
pub const INSTANCES: usize = 2;

/// What a script keeps between its calls.
#[derive(Default)]
pub struct Kept {
    pub handles: [Option<Handle>; INSTANCES],
    pub states: [[SavedState; PLACES]; INSTANCES],
    pub bytes: [[Vec<u8>; PLACES]; INSTANCES],
}

/// `fmi2FMUstate`.
#[derive(Debug, Clone, Copy)]
pub struct SavedState(pub *mut c_void);

impl Default for SavedState {
    fn default() -> Self {
        Self(null_mut())
    }
}

/// What a call came to: its status, and the bits that it wrote into the arrays for answers, or that
/// these held before.
#[derive(Debug, PartialEq)]
pub struct Answer {
    pub status: c_int,
    pub written: Vec<u64>,
}

/// What arrays for answers hold before a call.
pub const UNTOUCHED: u64 = 0x5aa5_5aa5_5aa5_5aa5;

impl Call {
    /// Name in C.
    pub fn name(&self) -> &'static str {
        match self {
            Call::Instantiate(_) => "fmi2Instantiate",
            Call::Free => "fmi2FreeInstance",
            Call::Logging { .. } => "fmi2SetDebugLogging",
            Call::Setup { .. } => "fmi2SetupExperiment",
            Call::Plain(name) | Call::Exchange(name) | Call::Status { name, .. } => name,
            Call::Get { kind: Kind::Real, .. } => "fmi2GetReal",
            Call::Get { kind: Kind::Integer, .. } => "fmi2GetInteger",
            Call::Get { kind: Kind::Boolean, .. } => "fmi2GetBoolean",
            Call::Get { kind: Kind::String, .. } => "fmi2GetString",
            Call::Set { kind: Kind::Real, .. } => "fmi2SetReal",
            Call::Set { kind: Kind::Integer, .. } => "fmi2SetInteger",
            Call::Set { .. } => "fmi2SetBoolean",
            Call::SetTexts { .. } => "fmi2SetString",
            Call::Step { .. } => "fmi2DoStep",
            Call::State(StateCall::Save { .. } | StateCall::SaveNowhere) => "fmi2GetFMUstate",
            Call::State(StateCall::Restore { .. }) => "fmi2SetFMUstate",
            Call::State(StateCall::Free { .. }) => "fmi2FreeFMUstate",
            Call::State(StateCall::Serialize { .. }) => "fmi2SerializeFMUstate",
            Call::State(StateCall::Deserialize { .. }) => "fmi2DeSerializeFMUstate",
            Call::Directional { .. } => "fmi2GetDirectionalDerivative",
            Call::InputDerivatives { .. } => "fmi2SetRealInputDerivatives",
            Call::OutputDerivatives { .. } => "fmi2GetRealOutputDerivatives",
        }
    }

    /// Whether a call only asks.
    pub fn only_asks(&self) -> bool {
        matches!(
            self,
            Call::Get { .. }
                | Call::Status { .. }
                | Call::Logging { .. }
                | Call::Directional { .. }
                | Call::OutputDerivatives { .. }
        ) || matches!(self, Call::State(state) if !matches!(state, StateCall::Restore { .. }))
    }

    /// Does a call on an instance whose time is `time`.
    pub fn run(&self, handle: Handle, time: f64, kept: &mut Kept) -> Answer {
        let status = match self {
            Call::Logging { on, categories, nulls } => logging(handle, *on, categories, *nulls),
            Call::Setup { tolerance, start, stop } => {
                call!("fmi2SetupExperiment", handle => Handle,
                    tolerance.is_some().into() => c_int, tolerance.unwrap_or(0.0) => f64,
                    *start => f64, stop.is_some().into() => c_int, stop.unwrap_or(0.0) => f64)
            }
            Call::Plain(name) => call!(*name, handle => Handle),
            Call::Exchange(name) => call!(*name, handle => Handle, 0 => usize, 0 => usize),
            Call::Get { references, nulls, .. } => {
                return get(self.name(), handle, references, *nulls);
            }
            Call::Set { kind: Kind::Real, references, values, nulls } => {
                set(self.name(), handle, references, values, *nulls)
            }
            Call::Set { references, values, nulls, .. } => {
                let values: Vec<c_int> = values.iter().map(|&value| value as c_int).collect();
                set(self.name(), handle, references, &values, *nulls)
            }
            Call::SetTexts { references, values, nulls } => {
                let texts: Vec<Option<CString>> =
                    values.iter().map(|text| text.map(|t| CString::new(t).unwrap())).collect();
                let pointers: Vec<*const c_char> =
                    texts.iter().map(|text| text.as_ref().map_or(null(), |t| t.as_ptr())).collect();
                set(self.name(), handle, references, &pointers, *nulls)
            }
            Call::Step { point, size } => {
                call!("fmi2DoStep", handle => Handle, point.of(time, *size) => f64, *size => f64,
                    1 => c_int)
            }
            Call::Status { name, kind, null } => {
                let mut value = UNTOUCHED;
                let pointer = if *null { null_mut() } else { &raw mut value };
                let status = call!(*name, handle => Handle, *kind => c_int, pointer => *mut u64);
                // Not all functions write eight bytes.
                let written = if status == 0 { vec![] } else { vec![value] };
                return Answer { status, written };
            }
            Call::State(state) => state.run(handle, kept),
            Call::Directional { unknowns, knowns, changes, nulls } => {
                return directional(handle, unknowns, knowns, changes, *nulls);
            }
            Call::InputDerivatives { references, orders, values, nulls } => {
                let (vr, value, count) = pointers(references, values, *nulls);
                let orders = if *nulls == Nulls::AllOfMany { null() } else { orders.as_ptr() };
                call!(self.name(), handle => Handle, vr => *const u32, count => usize,
                    orders => *const c_int, value => *const f64)
            }
            Call::OutputDerivatives { references, orders, nulls } => {
                let mut found = vec![UNTOUCHED; references.len()];
                let (vr, value, count) = pointers(references, &found, *nulls);
                let (orders, value) = match nulls {
                    Nulls::AllOfMany => (null(), null_mut()),
                    _ if value.is_null() => (orders.as_ptr(), null_mut()),
                    _ => (orders.as_ptr(), found.as_mut_ptr()),
                };
                let status = call!(self.name(), handle => Handle, vr => *const u32, count => usize,
                    orders => *const c_int, value => *mut u64);
                return Answer { status, written: found };
            }
            Call::Instantiate(_) | Call::Free => unreachable!("not a call on an instance"),
        };
        Answer { status, written: Vec::new() }
    }
}

impl Point {
    pub fn of(self, time: f64, size: f64) -> f64 {
        match self {
            Point::Here => time,
            Point::Off(part) => time + part * size,
            Point::At(time) => time,
        }
    }
}

/// Two arrays of one length as pointers, with their count.
fn pointers<T, U>(references: &[T], values: &[U], nulls: Nulls) -> (*const T, *const U, usize) {
    assert_eq!(references.len(), values.len());
    match nulls {
        Nulls::None => (references.as_ptr(), values.as_ptr(), references.len()),
        Nulls::References => (null(), values.as_ptr(), references.len()),
        Nulls::Values => (references.as_ptr(), null(), references.len()),
        Nulls::AllOfMany => (null(), null(), usize::MAX),
    }
}

fn logging(handle: Handle, on: bool, categories: &[&str], nulls: Nulls) -> c_int {
    let texts: Vec<CString> = categories.iter().map(|text| CString::new(*text).unwrap()).collect();
    let mut names: Vec<*const c_char> = texts.iter().map(|text| text.as_ptr()).collect();
    if nulls == Nulls::Values {
        names.fill(null());
    }
    let (names, count) = match nulls {
        Nulls::None | Nulls::Values => (names.as_ptr(), names.len()),
        Nulls::References => (null(), names.len()),
        Nulls::AllOfMany => (null(), usize::MAX),
    };
    call!("fmi2SetDebugLogging", handle => Handle, on.into() => c_int, count => usize,
        names => *const *const c_char)
}

/// Reads values of any type. Every element has room for the largest, eight bytes.
fn get(name: &str, handle: Handle, references: &[u32], nulls: Nulls) -> Answer {
    let mut values = vec![UNTOUCHED; references.len()];
    let (vr, value, count) = pointers(references, &values, nulls);
    let value = if value.is_null() { null_mut() } else { values.as_mut_ptr() };
    let status = call!(name, handle => Handle, vr => *const u32, count => usize, value => *mut u64);
    Answer { status, written: values }
}

fn set<T>(name: &str, handle: Handle, references: &[u32], values: &[T], nulls: Nulls) -> c_int {
    let (vr, value, count) = pointers(references, values, nulls);
    let value: *const c_void = value.cast();
    call!(name, handle => Handle, vr => *const u32, count => usize, value => *const c_void)
}

fn directional(
    handle: Handle,
    unknowns: &[u32],
    knowns: &[u32],
    changes: &[f64],
    nulls: Nulls,
) -> Answer {
    let mut found = vec![UNTOUCHED; unknowns.len()];
    let (known, change, known_count) = pointers(knowns, changes, nulls);
    let (unknown, written, unknown_count) = match nulls {
        Nulls::AllOfMany => (null(), null_mut(), usize::MAX),
        _ => (unknowns.as_ptr(), found.as_mut_ptr(), unknowns.len()),
    };
    let status = call!("fmi2GetDirectionalDerivative", handle => Handle, unknown => *const u32,
        unknown_count => usize, known => *const u32, known_count => usize,
        change => *const f64, written => *mut u64);
    Answer { status, written: found }
}

impl StateCall {
    fn run(self, handle: Handle, kept: &mut Kept) -> c_int {
        match self {
            StateCall::Save { into: (i, k) } => {
                let place = &raw mut kept.states[i][k].0;
                call!("fmi2GetFMUstate", handle => Handle, place => *mut *mut c_void)
            }
            StateCall::SaveNowhere => {
                call!("fmi2GetFMUstate", handle => Handle, null_mut() => *mut *mut c_void)
            }
            StateCall::Restore { from: (i, k) } => {
                call!("fmi2SetFMUstate", handle => Handle, kept.states[i][k].0 => *mut c_void)
            }
            StateCall::Free { of: (i, k) } => {
                let place = &raw mut kept.states[i][k].0;
                call!("fmi2FreeFMUstate", handle => Handle, place => *mut *mut c_void)
            }
            StateCall::Serialize { of: (i, k), room } => {
                let state = kept.states[i][k].0;
                let mut size = 0;
                let status = call!("fmi2SerializedFMUstateSize", handle => Handle,
                    state => *mut c_void, &raw mut size => *mut usize);
                if status != 0 {
                    return status;
                }
                let mut bytes = vec![0; size.saturating_add_signed(room)];
                let status = call!("fmi2SerializeFMUstate", handle => Handle,
                    state => *mut c_void, bytes.as_mut_ptr() => *mut u8, bytes.len() => usize);
                if status == 0 {
                    bytes.truncate(size);
                    kept.bytes[i][k] = bytes;
                }
                status
            }
            StateCall::Deserialize { bytes: (i, k), into: (j, l), cut, changed } => {
                let mut bytes = kept.bytes[i][k].clone();
                bytes.truncate(bytes.len().saturating_sub(cut));
                if let Some(at) = changed.filter(|_| !bytes.is_empty()) {
                    let at = at % bytes.len();
                    bytes[at] ^= 1 << (at % 8);
                }
                // A place that is in use would be lost, as a master would lose it.
                let mut place = null_mut::<c_void>();
                let status = call!("fmi2DeSerializeFMUstate", handle => Handle,
                    bytes.as_ptr() => *const u8, bytes.len() => usize,
                    &raw mut place => *mut *mut c_void);
                if status == 0 {
                    kept.states[j][l] = SavedState(place);
                }
                status
            }
        }
    }
}

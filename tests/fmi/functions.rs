//! The functions that act on an instance, but for that which frees it, with the phases in which the standards
//! allow them: FMI 2.0.4, section 4.2.4; FMI 3.0, sections 2.3 and 4.2.

use std::ffi::{c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use crate::master::{Handle, Three, Two, UnitOf, Version, call};

/// A call of a function by its name.
pub type Call<V> = fn(&UnitOf<V>, &str) -> c_int;

/// Functions of one kind, the phases that allow them by their letters, and a call that is then done: i instantiated,
/// m initialization mode, s between steps, t terminated.
pub type Group<V> = (&'static [&'static str], &'static str, Call<V>);

/// Pointers and counts of nothing.
fn empty<V: Version>(unit: &UnitOf<V>, name: &str) -> c_int {
    call!(name, unit.handle => Handle, null() => *const u32, 0 => usize, null_mut() => *mut c_void,
        0 => usize, null_mut() => *mut c_void, 0 => usize, null_mut() => *mut c_void, 0 => usize)
}

/// The instance alone.
fn plain<V: Version>(unit: &UnitOf<V>, name: &str) -> c_int {
    unit.simple(name)
}

/// No categories.
fn logging<V: Version>(unit: &UnitOf<V>, name: &str) -> c_int {
    call!(name, unit.handle => Handle, 1 => c_int, 0 => usize, null() => *const *const c_char)
}

/// A place for a saved state that holds none.
fn state<V: Version>(unit: &UnitOf<V>, name: &str) -> c_int {
    let mut saved: *mut c_void = null_mut();
    call!(name, unit.handle => Handle, &raw mut saved => *mut *mut c_void, 0 => usize,
        null_mut() => *mut c_void)
}

fn step<V: Version>(unit: &UnitOf<V>, _: &str) -> c_int {
    unit.advance(0.0, 1e-8)
}

/// Functions of FMI 2.0 that ask for the status of a step.
pub const STATUS: [&str; 5] = [
    "fmi2GetStatus",
    "fmi2GetRealStatus",
    "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus",
    "fmi2GetStringStatus",
];

/// Functions of model exchange in FMI 2.0.
pub const EXCHANGE: [&str; 10] = [
    "fmi2EnterEventMode",
    "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode",
    "fmi2CompletedIntegratorStep",
    "fmi2SetTime",
    "fmi2SetContinuousStates",
    "fmi2GetDerivatives",
    "fmi2GetEventIndicators",
    "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates",
];

/// The functions of FMI 2.0.
pub const TWO: [Group<Two>; 16] = [
    (&["fmi2SetDebugLogging"], "imst", logging),
    (&["fmi2SetupExperiment"], "i", |unit, _| unit.setup(0.0, None)),
    (&["fmi2EnterInitializationMode"], "i", plain),
    (&["fmi2ExitInitializationMode"], "m", plain),
    (&["fmi2Terminate"], "s", plain),
    (&["fmi2Reset"], "imst", plain),
    (&["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString"], "mst", empty),
    (&["fmi2SetReal", "fmi2SetInteger", "fmi2SetBoolean", "fmi2SetString"], "ims", empty),
    (
        &[
            "fmi2GetFMUstate",
            "fmi2SetFMUstate",
            "fmi2FreeFMUstate",
            "fmi2SerializedFMUstateSize",
            "fmi2SerializeFMUstate",
            "fmi2DeSerializeFMUstate",
        ],
        "imst",
        state,
    ),
    (&["fmi2GetDirectionalDerivative"], "mst", empty),
    (&["fmi2SetRealInputDerivatives"], "ims", empty),
    (&["fmi2GetRealOutputDerivatives"], "st", empty),
    (&["fmi2DoStep"], "s", step),
    (&STATUS, "st", |unit, name| {
        let mut value = 0_u64;
        call!(name, unit.handle => Handle, 2 => c_int, &raw mut value => *mut u64)
    }),
    (&["fmi2CancelStep"], "", plain),
    (&EXCHANGE, "", empty),
];

/// The functions of FMI 3.0.
pub const THREE: [Group<Three>; 13] = [
    (&["fmi3SetDebugLogging"], "imst", logging),
    (&["fmi3EnterInitializationMode"], "i", |unit, _| unit.enter(0.0, None)),
    (&["fmi3ExitInitializationMode"], "m", plain),
    (&["fmi3Terminate"], "s", plain),
    (&["fmi3Reset"], "imst", plain),
    (
        &[
            "fmi3GetFloat32",
            "fmi3GetFloat64",
            "fmi3GetInt8",
            "fmi3GetUInt8",
            "fmi3GetInt16",
            "fmi3GetUInt16",
            "fmi3GetInt32",
            "fmi3GetUInt32",
            "fmi3GetInt64",
            "fmi3GetUInt64",
            "fmi3GetBoolean",
            "fmi3GetString",
            "fmi3GetBinary",
        ],
        "imst",
        empty,
    ),
    (
        &[
            "fmi3SetFloat32",
            "fmi3SetFloat64",
            "fmi3SetInt8",
            "fmi3SetUInt8",
            "fmi3SetInt16",
            "fmi3SetUInt16",
            "fmi3SetInt32",
            "fmi3SetUInt32",
            "fmi3SetInt64",
            "fmi3SetUInt64",
            "fmi3SetBoolean",
            "fmi3SetString",
            "fmi3SetBinary",
        ],
        "ims",
        empty,
    ),
    (
        &["fmi3GetNumberOfVariableDependencies", "fmi3GetVariableDependencies"],
        "imst",
        |unit, name| {
            let mut count = 0_usize;
            call!(name, unit.handle => Handle, unit.reference("plate.heat_in") => u32,
                &raw mut count => *mut usize, null() => *const u32, null() => *const u32,
                null() => *const c_int, 0 => usize)
        },
    ),
    (
        &[
            "fmi3GetFMUState",
            "fmi3SetFMUState",
            "fmi3FreeFMUState",
            "fmi3SerializedFMUStateSize",
            "fmi3SerializeFMUState",
            "fmi3DeserializeFMUState",
        ],
        "imst",
        state,
    ),
    (&["fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative"], "mst", empty),
    (&["fmi3GetOutputDerivatives"], "st", |unit, name| {
        call!(name, unit.handle => Handle, null() => *const u32, 0 => usize,
            null() => *const c_int, null_mut() => *mut f64, 0 => usize)
    }),
    (&["fmi3DoStep"], "s", step),
    (
        &[
            "fmi3EnterEventMode",
            "fmi3EnterStepMode",
            "fmi3EvaluateDiscreteStates",
            "fmi3UpdateDiscreteStates",
            "fmi3EnterConfigurationMode",
            "fmi3ExitConfigurationMode",
            "fmi3GetClock",
            "fmi3SetClock",
            "fmi3GetIntervalDecimal",
            "fmi3GetIntervalFraction",
            "fmi3GetShiftDecimal",
            "fmi3GetShiftFraction",
            "fmi3SetIntervalDecimal",
            "fmi3SetIntervalFraction",
            "fmi3SetShiftDecimal",
            "fmi3SetShiftFraction",
            "fmi3EnterContinuousTimeMode",
            "fmi3CompletedIntegratorStep",
            "fmi3SetTime",
            "fmi3SetContinuousStates",
            "fmi3GetContinuousStateDerivatives",
            "fmi3GetEventIndicators",
            "fmi3GetContinuousStates",
            "fmi3GetNominalsOfContinuousStates",
            "fmi3GetNumberOfEventIndicators",
            "fmi3GetNumberOfContinuousStates",
            "fmi3ActivateModelPartition",
        ],
        "",
        empty,
    ),
];

/// The functions of a version that act on an instance, all but that which frees it.
pub fn names<V: Version>() -> Vec<&'static str> {
    V::FUNCTIONS.iter().flat_map(|(names, ..)| names.iter().copied()).collect()
}

/// The phases in which FMI 2.0 allows a function, by their letters.
pub fn allowed_phases(name: &str) -> &'static str {
    let row = TWO.iter().find(|(functions, ..)| functions.contains(&name));
    row.unwrap_or_else(|| panic!("no function {name}")).1
}

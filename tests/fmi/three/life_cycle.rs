//! The state machine of FMI 3.0, sections 2.3 and 4.2.

use std::ffi::{c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use super::master::Unit;
use crate::master::{DISCARD, ERROR, Handle, OK, WARNING, call};

/// Phases that a master can bring a unit into, with the letter they have in [`TABLE`].
const PHASES: [(char, fn() -> Unit); 4] = [
    ('i', Unit::instantiated),
    ('m', Unit::initializing),
    ('s', Unit::running),
    ('t', Unit::terminated),
];

type Call = fn(&Unit, &str) -> c_int;

/// Pointers and counts of nothing.
const EMPTY: Call = |unit, name| {
    call!(name, unit.handle => Handle, null() => *const u32, 0 => usize, null_mut() => *mut c_void,
        0 => usize, null_mut() => *mut c_void, 0 => usize, null_mut() => *mut c_void, 0 => usize)
};

const PLAIN: Call = |unit, name| unit.simple(name);

const STATE: Call = |unit, name| {
    let mut saved: *mut c_void = null_mut();
    call!(name, unit.handle => Handle, &raw mut saved => *mut *mut c_void, 0 => usize,
        null_mut() => *mut c_void)
};

/// Functions of one kind, the phases in which the standard allows them, and a call that it then allows.
const TABLE: [(&[&str], &str, Call); 13] = [
    (&["fmi3SetDebugLogging"], "imst", |unit, name| {
        call!(name, unit.handle => Handle, true => bool, 0 => usize,
            null() => *const *const c_char)
    }),
    (&["fmi3EnterInitializationMode"], "i", |unit, _| unit.enter(0.0, None)),
    (&["fmi3ExitInitializationMode"], "m", PLAIN),
    (&["fmi3Terminate"], "s", PLAIN),
    (&["fmi3Reset"], "imst", PLAIN),
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
        EMPTY,
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
        EMPTY,
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
        STATE,
    ),
    (&["fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative"], "mst", EMPTY),
    (&["fmi3GetOutputDerivatives"], "st", |unit, name| {
        call!(name, unit.handle => Handle, null() => *const u32, 0 => usize,
            null() => *const c_int, null_mut() => *mut f64, 0 => usize)
    }),
    (&["fmi3DoStep"], "s", |unit, _| unit.step(0.0, 1e-8).0),
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
        EMPTY,
    ),
];

/// The functions that act on an instance, all but fmi3FreeInstance.
pub fn functions() -> Vec<&'static str> {
    TABLE.iter().flat_map(|(names, ..)| names.iter().copied()).collect()
}

/// Words of the log when a call comes at the wrong time.
const UNTIMELY: [&str; 3] = ["not allowed in state", "belongs to", "this unit has no"];

#[test]
fn every_call_is_allowed_exactly_when_the_standard_says_so() {
    for (names, allowed, call) in TABLE {
        for (&name, (letter, make)) in names.iter().flat_map(|n| PHASES.map(|phase| (n, phase))) {
            let unit = make();
            unit.messages.take();
            let status = call(&unit, name);
            let messages = unit.messages.take();
            let untimely = messages.iter().any(|m| UNTIMELY.iter().any(|w| m.text.contains(w)));
            assert_eq!(!untimely, allowed.contains(letter), "{name} in {letter}: {messages:?}");
            assert!(!untimely || status == ERROR, "{name} in {letter}: {status}");
            let named = messages.iter().all(|m| m.status == OK || m.text.starts_with(name));
            assert!(named, "{name} in {letter}: {messages:?}");
        }
    }
}

#[test]
fn an_untimely_call_changes_nothing() {
    for (names, allowed, call) in TABLE {
        for (letter, make) in PHASES.into_iter().skip(2) {
            if allowed.contains(letter) {
                continue;
            }
            let unit = make();
            let before = unit.snapshot();
            for name in names {
                call(&unit, name);
                assert_eq!(unit.snapshot(), before, "{name} in {letter}");
            }
        }
    }
}

#[test]
fn a_unit_can_be_freed_in_every_phase() {
    for (_, make) in PHASES {
        drop(make());
    }
}

#[test]
fn a_reset_unit_runs_as_a_fresh_one() {
    let (unit, fresh) = (Unit::instantiated(), Unit::running());
    assert_eq!(unit.set("plate.conductivity", &[20.0]), OK);
    assert_eq!(unit.set("patch.heat_flux", &[1e6; 6]), OK);
    assert_eq!(unit.enter(1e-6, Some(2e-6)), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(1e-6, 1e-8).0, OK);
    assert_eq!(unit.simple("fmi3Terminate"), OK);
    assert_eq!(unit.simple("fmi3Reset"), OK);
    assert_eq!(unit.enter(0.0, None), OK);
    assert_eq!(unit.exit(), OK);
    for at in 0..3 {
        assert_eq!(unit.snapshot(), fresh.snapshot());
        for unit in [&unit, &fresh] {
            assert_eq!(unit.step(f64::from(at) * 1e-8, 1e-8).0, OK);
        }
    }
}

#[test]
fn a_discarded_step_leaves_the_unit_in_step_mode() {
    let unit = Unit::running();
    assert_eq!(unit.step(0.0, 1e-8).0, OK);
    assert_eq!(unit.set("spot.heat_flux", &[-1e14]), OK);
    unit.expect_message(WARNING, &["spot.heat_flux = -1e14: a heat flux is plausible"]);
    let before = unit.snapshot();
    let (status, stepped) = unit.step(1e-8, 1e-8);
    assert_eq!((status, stepped.flags, stepped.time), (DISCARD, [false; 3], 1e-8));
    unit.expect_message(DISCARD, &["fmi3DoStep", "below absolute zero"]);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(unit.set("spot.heat_flux", &[1e6]), OK);
    assert_eq!(unit.step(1e-8, 1e-8).0, OK, "{:?}", unit.messages.take());
}

#[test]
fn a_step_that_fits_tells_its_time_and_does_not_end_early() {
    let unit = Unit::instantiated();
    assert_eq!(unit.enter(1e-6, Some(2e-6)), OK);
    assert_eq!(unit.time(), 1e-6);
    assert_eq!(unit.exit(), OK);
    let (status, stepped) = unit.step(1e-6, 3e-8);
    assert_eq!((status, stepped.flags), (OK, [false; 3]));
    assert_eq!((stepped.time, unit.time()), (1e-6 + 3e-8, 1e-6 + 3e-8));
    unit.messages.take();
    assert_eq!(unit.step(1e-6 + 3e-8, 1e-6).0, ERROR);
    unit.expect_message(ERROR, &["beyond the stop time"]);
}

//! The state machine of FMI 2.0.4, section 4.2.4.

use std::ffi::{c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use crate::master::{ERROR, Folder, Handle, OK, Unit, call};

/// Phases that a master can bring a unit into, with the letter they have in [`TABLE`].
const PHASES: [(char, fn() -> Unit); 4] = [
    ('i', Unit::instantiated),
    ('m', Unit::initializing),
    ('s', Unit::running),
    ('t', Unit::terminated),
];

type Call = fn(&Unit) -> c_int;

fn get(unit: &Unit, name: &str) -> c_int {
    call!(name, unit.handle => Handle, null() => *const u32, 0 => usize, null_mut() => *mut c_void)
}

fn state(unit: &Unit, name: &str) -> c_int {
    let mut saved: *mut c_void = null_mut();
    call!(name, unit.handle => Handle, &raw mut saved => *mut *mut c_void, 0 => usize,
        null_mut() => *mut c_void)
}

fn status(unit: &Unit, name: &str) -> c_int {
    let mut value = 0_u64;
    call!(name, unit.handle => Handle, 2 => c_int, &raw mut value => *mut u64)
}

fn derivatives(unit: &Unit, name: &str) -> c_int {
    call!(name, unit.handle => Handle, null() => *const u32, 0 => usize, null() => *const u32,
        0 => usize, null() => *const f64, null_mut() => *mut f64)
}

/// Every function with the phases in which the standard allows it.
const TABLE: [(&str, &str, Call); 40] = [
    ("fmi2SetDebugLogging", "imst", |unit| {
        call!("fmi2SetDebugLogging", unit.handle => Handle, 1 => c_int, 0 => usize,
            null() => *const *const c_char)
    }),
    ("fmi2SetupExperiment", "i", |unit| unit.setup(0.0, None)),
    ("fmi2EnterInitializationMode", "i", Unit::enter),
    ("fmi2ExitInitializationMode", "m", Unit::exit),
    ("fmi2Terminate", "s", Unit::terminate),
    ("fmi2Reset", "imst", Unit::reset),
    ("fmi2GetReal", "mst", |unit| get(unit, "fmi2GetReal")),
    ("fmi2GetInteger", "mst", |unit| get(unit, "fmi2GetInteger")),
    ("fmi2GetBoolean", "mst", |unit| get(unit, "fmi2GetBoolean")),
    ("fmi2GetString", "mst", |unit| get(unit, "fmi2GetString")),
    ("fmi2SetReal", "ims", |unit| get(unit, "fmi2SetReal")),
    ("fmi2SetInteger", "ims", |unit| get(unit, "fmi2SetInteger")),
    ("fmi2SetBoolean", "ims", |unit| get(unit, "fmi2SetBoolean")),
    ("fmi2SetString", "ims", |unit| get(unit, "fmi2SetString")),
    ("fmi2GetFMUstate", "imst", |unit| state(unit, "fmi2GetFMUstate")),
    ("fmi2SetFMUstate", "imst", |unit| state(unit, "fmi2SetFMUstate")),
    ("fmi2FreeFMUstate", "imst", |unit| state(unit, "fmi2FreeFMUstate")),
    ("fmi2SerializedFMUstateSize", "imst", |unit| state(unit, "fmi2SerializedFMUstateSize")),
    ("fmi2SerializeFMUstate", "imst", |unit| state(unit, "fmi2SerializeFMUstate")),
    ("fmi2DeSerializeFMUstate", "imst", |unit| state(unit, "fmi2DeSerializeFMUstate")),
    ("fmi2GetDirectionalDerivative", "mst", |unit| {
        derivatives(unit, "fmi2GetDirectionalDerivative")
    }),
    ("fmi2SetRealInputDerivatives", "ims", |unit| derivatives(unit, "fmi2SetRealInputDerivatives")),
    ("fmi2GetRealOutputDerivatives", "st", |unit| {
        derivatives(unit, "fmi2GetRealOutputDerivatives")
    }),
    ("fmi2DoStep", "s", |unit| unit.step(0.0, 1e-8)),
    ("fmi2CancelStep", "", |unit| unit.simple("fmi2CancelStep")),
    ("fmi2GetStatus", "st", |unit| status(unit, "fmi2GetStatus")),
    ("fmi2GetRealStatus", "st", |unit| status(unit, "fmi2GetRealStatus")),
    ("fmi2GetIntegerStatus", "st", |unit| status(unit, "fmi2GetIntegerStatus")),
    ("fmi2GetBooleanStatus", "st", |unit| status(unit, "fmi2GetBooleanStatus")),
    ("fmi2GetStringStatus", "st", |unit| status(unit, "fmi2GetStringStatus")),
    ("fmi2EnterEventMode", "", |unit| unit.simple("fmi2EnterEventMode")),
    ("fmi2NewDiscreteStates", "", |unit| state(unit, "fmi2NewDiscreteStates")),
    ("fmi2EnterContinuousTimeMode", "", |unit| unit.simple("fmi2EnterContinuousTimeMode")),
    ("fmi2CompletedIntegratorStep", "", |unit| status(unit, "fmi2CompletedIntegratorStep")),
    ("fmi2SetTime", "", |unit| call!("fmi2SetTime", unit.handle => Handle, 0.0 => f64)),
    ("fmi2SetContinuousStates", "", |unit| get(unit, "fmi2SetContinuousStates")),
    ("fmi2GetDerivatives", "", |unit| get(unit, "fmi2GetDerivatives")),
    ("fmi2GetEventIndicators", "", |unit| get(unit, "fmi2GetEventIndicators")),
    ("fmi2GetContinuousStates", "", |unit| get(unit, "fmi2GetContinuousStates")),
    ("fmi2GetNominalsOfContinuousStates", "", |unit| {
        get(unit, "fmi2GetNominalsOfContinuousStates")
    }),
];

/// The phases in which the standard allows a function, by their letters.
pub fn allowed_phases(name: &str) -> &'static str {
    let row = TABLE.iter().find(|(function, ..)| *function == name);
    row.unwrap_or_else(|| panic!("no function {name}")).1
}

/// Words of the log when a call comes at the wrong time.
const UNTIMELY: [&str; 2] = ["not allowed in state", "belongs to model exchange"];

#[test]
fn every_call_is_allowed_exactly_when_the_standard_says_so() {
    for (name, allowed, call) in TABLE {
        for (letter, make) in PHASES {
            let unit = make();
            unit.messages.take();
            let status = call(&unit);
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
    for (letter, make) in PHASES.into_iter().skip(2) {
        let unit = make();
        let before = unit.snapshot();
        for (name, allowed, call) in TABLE {
            if allowed.contains(letter) {
                continue;
            }
            call(&unit);
            assert_eq!(unit.snapshot(), before, "{name} in {letter}");
            assert_eq!(unit.time(), 0.0, "{name} in {letter}");
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
fn a_terminated_unit_still_answers_and_can_start_again() {
    let unit = Unit::running();
    assert_eq!(unit.step(0.0, 1e-8), OK);
    let heat = unit.get("plate.heat_in");
    assert_eq!(unit.terminate(), OK);
    assert_eq!(unit.get("plate.heat_in"), heat);
    assert_eq!(unit.reset(), OK);
    assert_eq!(unit.setup(0.0, None), OK);
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.get("plate.heat_in"), 0.0);
}

#[test]
fn reset_brings_back_the_start_values_and_the_same_run() {
    let fresh = Unit::running();
    let unit = Unit::instantiated();
    let folder = Folder::new("fields");
    let ways: [&[Call]; 4] = [
        &[],
        &[Unit::enter],
        &[Unit::enter, Unit::exit],
        &[Unit::enter, Unit::exit, Unit::terminate],
    ];
    for way in ways {
        assert_eq!(unit.set("plate.conductivity", 20.0), OK);
        assert_eq!(unit.set("spot.heat_flux", 1e6), OK);
        assert_eq!(unit.set_threads(1), OK);
        assert_eq!(unit.set_directory(&folder.0), OK);
        way.iter().for_each(|call| assert_eq!(call(&unit), OK));
        assert_eq!(unit.reset(), OK);
    }
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.snapshot(), fresh.snapshot());
    for at in 0..3 {
        assert_eq!(unit.step(f64::from(at) * 1e-8, 1e-8), OK);
        assert_eq!(fresh.step(f64::from(at) * 1e-8, 1e-8), OK);
    }
    assert_eq!(unit.snapshot(), fresh.snapshot());
}

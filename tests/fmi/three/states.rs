//! Saving states, going back to them, and sending them elsewhere.

use std::ptr::null_mut;

use super::master::Unit;
use crate::master::{self, ERROR, OK, Saved};
use crate::peaks;

/// A unit amid a run.
fn busy() -> Unit {
    let unit = Unit::instantiated();
    assert_eq!(unit.set("plate.conductivity", &[14.0]), OK);
    assert_eq!((unit.enter(1e-6, Some(3e-6)), unit.exit()), (OK, OK));
    assert_eq!(unit.set("patch.heat_flux", &[1e7, 2e7, 3e7, 4e7, 5e7, 6e7]), OK);
    assert_eq!(unit.step(1e-6, 2e-8).0, OK);
    assert_eq!(unit.set("spot.pressure", &[2e6]), OK);
    unit.messages.take();
    unit
}

/// Steps of different lengths under inputs that change, seen after each.
fn go_on(unit: &Unit) -> Vec<Vec<u64>> {
    let mut seen = Vec::new();
    for (i, step) in [1e-8, 3e-8, 0.5e-8].into_iter().enumerate() {
        assert_eq!(unit.set("spot.x", &[1e-5 * i as f64]), OK);
        assert_eq!(unit.step(unit.time(), step).0, OK, "{:?}", unit.messages.take());
        seen.push(unit.snapshot());
    }
    seen
}

#[test]
fn a_state_goes_on_to_the_bit_in_any_instance() {
    let unit = busy();
    let (mut state, before) = (unit.save(), unit.snapshot());
    let bytes = unit.serialize(state);
    let wanted = go_on(&unit);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(go_on(&unit), wanted);
    for other in [Unit::instantiated(), Unit::running(), Unit::terminated()] {
        let copy = other.deserialize(&bytes);
        assert_eq!(other.restore(copy), OK, "{:?}", other.messages.take());
        assert_eq!(go_on(&other), wanted);
    }
    assert_eq!(unit.free_state(&mut state), OK);
    assert!(state.is_null());
    assert_eq!(unit.free_state(&mut state), OK);
}

#[test]
fn a_freed_or_foreign_state_is_refused() {
    let (unit, other) = (busy(), Unit::running());
    let (state, foreign) = (unit.save(), other.save());
    let before = unit.snapshot();
    let mut freed = state;
    assert_eq!(unit.free_state(&mut freed), OK);
    for wrong in [state, foreign, null_mut()] {
        assert_eq!(unit.restore(wrong), ERROR);
        unit.expect_message(ERROR, &["fmi3SetFMUState", "not freed"]);
    }
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn damaged_bytes_are_refused() {
    let unit = busy();
    let mut bytes = unit.serialize(unit.save());
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    let mut state: Saved = null_mut();
    assert_eq!(unit.deserialize_in(&bytes, &mut state), ERROR);
    unit.expect_message(ERROR, &["fmi3DeserializeFMUState", "checksum"]);
    assert!(state.is_null());
}

/// A state belongs to the unit, not to the version of the standard that it is driven by.
#[test]
fn a_state_of_fmi_2_goes_on_under_fmi_3() {
    let two = master::Unit::running();
    assert_eq!(two.set("spot.heat_flux", 2e7), OK);
    assert_eq!(two.step(0.0, 1e-8), OK);
    let bytes = two.serialize(two.save());
    let three = Unit::instantiated();
    assert_eq!(three.restore(three.deserialize(&bytes)), OK);
    assert_eq!(two.step(1e-8, 2e-8), OK);
    assert_eq!(three.step(1e-8, 2e-8).0, OK);
    for name in ["centre.temperature", "centre.von_mises", "plate.heat_in"] {
        assert_eq!(three.get(name)[0].to_bits(), two.get(name).to_bits(), "{name}");
    }
}

#[test]
fn a_state_that_failed_under_fmi_2_is_in_step_mode_under_fmi_3() {
    let two = master::Unit::running();
    assert_eq!(two.set("spot.heat_flux", -1e13), OK);
    assert_eq!(two.step(0.0, 1e-8), master::DISCARD);
    let bytes = two.serialize(two.save());
    let three = Unit::instantiated();
    assert_eq!(three.restore(three.deserialize(&bytes)), OK);
    assert_eq!(three.set("spot.heat_flux", &[1e6]), OK);
    assert_eq!(three.step(0.0, 1e-8).0, OK, "{:?}", three.messages.take());
}

#[test]
fn running_maxima_are_those_of_fmi_2_and_go_on_to_the_bit() {
    let text = peaks::scene();
    let two = master::Unit::of_scene(&text);
    assert_eq!([two.setup(0.0, None), two.enter(), two.exit()], [OK; 3]);
    let three = Unit::of_scene(&text);
    assert_eq!([three.enter(0.0, None), three.exit()], [OK; 2]);
    let compare = || {
        for key in ["temperature", "von_mises", "max_principal"] {
            for end in ["", "_time", "_x", "_y", "_z"] {
                let name = format!("plate.peak_{key}{end}");
                assert_eq!(three.get(&name)[0].to_bits(), two.get(&name).to_bits(), "{name}");
            }
        }
    };
    let both = |pressure: f64, point: f64| {
        assert_eq!([two.set("spot.pressure", pressure), two.step(point, 1e-8)], [OK; 2]);
        assert_eq!(three.set("spot.pressure", &[pressure]), OK);
        assert_eq!(three.step(point, 1e-8).0, OK, "{:?}", three.messages.take());
    };
    both(4e8, 0.0);
    both(0.0, 1e-8);
    compare();
    assert_eq!(
        three.get("plate.peak_von_mises_time"),
        [0.0],
        "under the pressure of the first step"
    );
    let bytes = two.serialize(two.save());
    let other = Unit::of_scene(&text);
    assert_eq!(other.restore(other.deserialize(&bytes)), OK);
    assert_eq!(other.snapshot(), three.snapshot());
    both(1e8, 2e-8);
    compare();
}

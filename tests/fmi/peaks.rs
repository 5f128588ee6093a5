//! Running maxima of a unit: noted as initialization ends and as steps begin and end, saved and sent with its states.

use std::ptr::null_mut;

use crate::forged::Forged;
use crate::master::{DISCARD, ERROR, OK, SCENE, Saved, Unit};

/// The scene of these tests with running maxima of its plate.
pub fn scene() -> String {
    let list = "peaks = [\"temperature\", \"von_mises\", \"max_principal\"]";
    SCENE.replacen("mesh = {", &format!("{list}\nmesh = {{"), 1)
}

fn initializing() -> Unit {
    let unit = Unit::of_scene(&scene());
    assert_eq!([unit.setup(1e-6, None), unit.enter()], [OK; 2]);
    unit
}

fn running() -> Unit {
    let unit = initializing();
    assert_eq!(unit.exit(), OK, "{:?}", unit.messages.take());
    unit
}

/// A unit amid a run, whose stress was highest as its second step began.
fn busy() -> Unit {
    let unit = running();
    assert_eq!(unit.step(1e-6, 2e-8), OK);
    assert_eq!(unit.set("spot.pressure", 5e8), OK);
    assert_eq!(unit.step(1.02e-6, 1e-8), OK);
    assert_eq!(unit.set("spot.pressure", 0.0), OK);
    assert_eq!(unit.set("spot.heat_flux", 0.0), OK);
    assert_eq!(unit.step(1.03e-6, 3e-8), OK, "{:?}", unit.messages.take());
    unit
}

/// Steps under inputs that change, with all values after each.
fn go_on(unit: &Unit) -> Vec<Vec<u64>> {
    let mut seen = Vec::new();
    for (i, step) in [1e-8, 3e-8, 0.5e-8].into_iter().enumerate() {
        assert_eq!(unit.set("spot.x", 1e-5 * i as f64), OK);
        assert_eq!(unit.set("spot.heat_flux", 2e8 * i as f64), OK);
        assert_eq!(unit.step(unit.time(), step), OK, "{:?}", unit.messages.take());
        seen.push(unit.snapshot().0);
    }
    seen
}

#[test]
fn a_jump_is_noted_as_a_step_begins_and_stays() {
    let unit = busy();
    let time = unit.get("plate.peak_von_mises_time");
    assert!((time - 1.02e-6).abs() < 1e-9, "{time}");
    assert!(unit.get("plate.peak_von_mises") > 10.0 * unit.get("plate.max_von_mises"));
    assert_eq!(unit.get("plate.peak_temperature_time"), 1.02e-6 + 1e-8, "until the flux was gone");
    // Of the four images of a place within the spot the one that is meshed.
    let [x, y, z] = ["x", "y", "z"].map(|axis| unit.get(&format!("plate.peak_temperature_{axis}")));
    assert!(x >= 0.0 && y >= 0.0 && x.hypot(y) < 6e-5 && z == 0.0, "{x}, {y}, {z}");
}

#[test]
fn from_the_end_of_initialization_on_nothing_follows_at_once() {
    let unit = initializing();
    assert_eq!(unit.set("spot.pressure", 1e8), OK);
    let at_start = unit.get("plate.peak_von_mises");
    assert!(at_start > 1e7 && at_start == unit.get("plate.max_von_mises"));
    assert_eq!(unit.set("spot.pressure", 3e8), OK);
    let higher = unit.get("plate.peak_von_mises");
    assert!((higher / at_start - 3.0).abs() < 1e-6, "as long as nothing is noted: the present");
    assert_eq!(unit.exit(), OK);
    for pressure in [9e8, 0.0] {
        assert_eq!(unit.set("spot.pressure", pressure), OK);
        assert_eq!(unit.get("plate.peak_von_mises"), higher);
    }
    let [peak, input] = ["plate.peak_von_mises", "spot.pressure"].map(|name| unit.reference(name));
    assert_eq!(unit.directional_derivative(&[peak], &[input], &[1.0]), [0.0]);
    assert_eq!(unit.step(1e-6, 1e-8), OK);
    assert_eq!(unit.get("plate.peak_von_mises"), higher);
    assert_eq!(unit.get("plate.peak_von_mises_time"), 1e-6);
    unit.messages.take();
    assert_eq!(unit.output_derivatives_in(&[peak], &[1], &mut [0.0]), ERROR);
    unit.expect_message(ERROR, &["have no derivative"]);
}

#[test]
fn a_saved_state_goes_on_to_the_bit() {
    let unit = busy();
    let (state, before) = (unit.save(), unit.snapshot());
    let saved = unit.serialize(state);
    let wanted = go_on(&unit);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(go_on(&unit), wanted);
    for other in [Unit::of_scene(&scene()), running(), busy()] {
        assert_eq!(other.restore(other.deserialize(&saved)), OK, "{:?}", other.messages.take());
        assert_eq!(other.snapshot(), before);
        assert_eq!(go_on(&other), wanted);
    }
}

#[test]
fn a_reset_forgets_what_was_noted() {
    let unit = busy();
    let fresh = running();
    assert_eq!(unit.reset(), OK);
    assert_eq!([unit.setup(1e-6, None), unit.enter(), unit.exit()], [OK; 3]);
    assert_eq!(unit.snapshot(), fresh.snapshot());
    assert_eq!(go_on(&unit), go_on(&fresh));
}

#[test]
fn a_step_that_fails_notes_nothing() {
    let unit = busy();
    assert_eq!(unit.set("spot.pressure", 1e10), OK);
    assert_eq!(unit.set("spot.heat_flux", -1e13), OK);
    let before = unit.snapshot();
    assert_eq!(unit.step(unit.time(), 1e-7), DISCARD);
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn forged_running_maxima_are_refused() {
    let unit = busy();
    let saved = Forged::of(&unit.serialize(unit.save()));
    assert_eq!(saved.peaks.len(), 15);
    unit.messages.take();
    let refused = |change: &dyn Fn(&mut Vec<f64>), words: &str| {
        let mut forged = saved.clone();
        change(&mut forged.peaks);
        let mut place: Saved = null_mut();
        assert_eq!(unit.deserialize_in(&forged.bytes(), &mut place), ERROR, "taken: {words}");
        unit.expect_message(ERROR, &["contradicts itself", words]);
    };
    refused(&|peaks| peaks.truncate(14), "14 numbers of running maxima");
    refused(&|peaks| peaks.truncate(10), "2 running maxima; the scene has 3");
    refused(&|peaks| peaks.extend([1.0; 5]), "4 running maxima; the scene has 3");
    refused(&|peaks| peaks[0] = f64::NAN, "not finite");
    refused(&|peaks| peaks[0] = -5.0, "-5 as a running maximum");
    refused(&|peaks| peaks[1] = 2e-6, "after the state's");
    refused(&|peaks| peaks[6] = 0.5e-6, "before the start");
    refused(&|peaks| peaks[7] = 1.0, "outside of it");
    let whole = unit.deserialize(&saved.bytes());
    assert_eq!(unit.restore(whole), OK);
    // A state before anything is noted.
    let mut early = saved.clone();
    early.peaks.clear();
    assert_eq!(unit.restore(unit.deserialize(&early.bytes())), OK);
    assert_eq!(unit.get("plate.peak_temperature"), unit.get("plate.max_temperature"));
}

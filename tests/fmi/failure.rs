//! Units of brittle bodies: what flaws have met is part of their states, and parameters change it.

use std::ptr::null_mut;

use crate::forged::Forged;
use crate::master::{ERROR, OK, SCENE, Saved, Unit};

/// The scene of these tests with flaws in its plate.
fn scene() -> String {
    let flaws = "expansion = 8.1e-6, weibull = { modulus = 8.0, strength = 100e6, volume = 1e-12 }, toughness = 3e6 }";
    let scratch = "[[flaw]]\nname = \"scratch\"\nin = \"plate\"\nat = [1e-5, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]\n\
                   depth = 5e-6\ngives = [\"stress_intensity\", \"energy_release_rate\", \"safety\"]\n[[field]]";
    SCENE.replacen("expansion = 8.1e-6 }", flaws, 1).replacen("[[field]]", scratch, 1)
}

/// A unit amid a run, whose stress was highest as its second step began.
fn busy(parameters: &[(&str, f64)]) -> Unit {
    let unit = Unit::of_scene(&scene());
    for &(name, value) in parameters {
        assert_eq!(unit.set(name, value), OK, "{:?}", unit.messages.take());
    }
    assert_eq!([unit.setup(0.0, None), unit.enter(), unit.exit()], [OK; 3]);
    for (time, step, flux) in [(0.0, 2e-8, -5e8), (2e-8, 3e-8, -9e8), (5e-8, 1e-8, 4e8)] {
        assert_eq!(unit.set("spot.heat_flux", flux), OK);
        assert_eq!(unit.step(time, step), OK, "{:?}", unit.messages.take());
    }
    unit
}

fn go_on(unit: &Unit) -> Vec<u64> {
    assert_eq!(unit.set("spot.x", 2e-5), OK);
    assert_eq!(unit.set("spot.heat_flux", -2e9), OK);
    assert_eq!(unit.step(unit.time(), 2e-8), OK, "{:?}", unit.messages.take());
    unit.snapshot().0
}

#[test]
fn a_saved_state_goes_on_to_the_bit() {
    let unit = busy(&[]);
    let (state, before) = (unit.save(), unit.snapshot());
    assert!(unit.get("plate.failure_risk") > unit.get("plate.present_failure_risk"));
    let saved = unit.serialize(state);
    let wanted = go_on(&unit);
    assert_eq!(unit.restore(state), OK);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(go_on(&unit), wanted);
    let other = Unit::of_scene(&scene());
    assert_eq!(other.restore(other.deserialize(&saved)), OK, "{:?}", other.messages.take());
    assert_eq!(other.snapshot(), before);
    assert_eq!(go_on(&other), wanted);
}

#[test]
fn forged_stresses_of_flaws_are_refused() {
    let unit = busy(&[]);
    let saved = Forged::of(&unit.serialize(unit.save()));
    unit.messages.take();
    for value in [f64::NAN, f64::INFINITY, f64::MIN] {
        let mut forged = saved.clone();
        *forged.body(0).last_mut().unwrap() = value;
        let mut place: Saved = null_mut();
        assert_eq!(unit.deserialize_in(&forged.bytes(), &mut place), ERROR, "taken: {value}");
        unit.expect_message(ERROR, &["contradicts itself"]);
    }
}

#[test]
fn parameters_scale_what_follows_from_the_same_stress() {
    let usual = busy(&[]);
    let [risk, intensity] = ["plate.failure_risk", "scratch.stress_intensity"];
    let weaker = busy(&[("plate.weibull_strength", 50e6), ("plate.toughness", 6e6)]);
    let ratio = weaker.get(risk) / usual.get(risk);
    assert!((ratio / 256.0 - 1.0).abs() < 1e-9, "{ratio}");
    let ratio = weaker.get("scratch.safety") / usual.get("scratch.safety");
    assert!(usual.get(intensity) == 0.0 || (ratio / 2.0 - 1.0).abs() < 1e-12, "{ratio}");
    let other = busy(&[("plate.weibull_modulus", 4.0), ("scratch.depth", 2e-6)]);
    assert!(other.get(risk) != usual.get(risk));
    assert!(other.get(intensity) != usual.get(intensity) || usual.get(intensity) == 0.0);
}

#[test]
fn derivatives_of_flaws_are_exact_and_those_of_risks_refused() {
    let unit = busy(&[]);
    assert_eq!(unit.set("spot.heat_flux", -5e9), OK);
    assert_eq!(unit.step(unit.time(), 2e-8), OK);
    let references =
        |names: &[&str]| names.iter().map(|name| unit.reference(name)).collect::<Vec<_>>();
    let [flaw, input] = [references(&["scratch.stress_intensity"]), references(&["spot.pressure"])];
    let found = unit.directional_derivative(&flaw, &input, &[1.0])[0];
    let at = |pressure: f64| {
        assert_eq!(unit.set("spot.pressure", pressure), OK);
        unit.get("scratch.stress_intensity")
    };
    let wanted = (at(1e5) - at(-1e5)) / 2e5;
    assert!(at(0.0) > 0.0 && (found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
    unit.messages.take();
    let risk = references(&["plate.failure_risk"]);
    assert_eq!(unit.output_derivatives_in(&risk, &[1], &mut [0.0]), ERROR);
    unit.expect_message(ERROR, &["have no derivative"]);
}

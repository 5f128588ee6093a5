//! Forces on the faces by which solids of large strain are held or moved.

use std::f64::consts::PI;

use impinge::closed_form::{Rubber, Sides};

use crate::common::{Trial, off};
use crate::driven_solids::{BLOCK, DISC, rubber};

/// Supports bear what pulls and presses a body, and its weight, in every model of it.
#[test]
fn held_faces_bear_the_loads() {
    let clamped = "faces = { bottom = { clamped = true }, top = { traction = [0.0, 0.0, 3e4] } }";
    let [area, height, weight] = [80e-6, 12e-3, 9.81e3];
    for (keys, area) in [
        (format!("{BLOCK}\nsymmetry = \"none\""), area),
        (format!("{BLOCK}\nsymmetry = \"quarter\""), area),
        (format!("{BLOCK}\nsymmetry = \"none\"\nmechanics = \"rkpm\""), area),
        (format!("{BLOCK}\nsymmetry = \"none\"\nmechanics = \"sph\""), area),
        (BLOCK.replace("8e-3", "1.0") + "\ndimension = 2\nsymmetry = \"none\"", 10e-3),
        (DISC.replace("6e-3", "12e-3"), PI * 25e-6),
    ] {
        let mut trial = Trial::new(&rubber(&format!("{keys}\ngravity = 9.81\n{clamped}")));
        trial.step(1.0);
        let expected = -3e4 * area + weight * area * height;
        let force = trial.get("pad.bottom.force_z");
        assert!(off(force, expected) < 1e-8, "{keys}: {force} {expected}");
    }
    // Drawn by one face, held by rollers on three.
    let faces = "faces = { bottom = { roller = true }, left = { roller = true }, front = { roller = true }, \
                 right = { traction = [2e4, 1e4, 0.0] } }";
    let mut trial = Trial::new(&rubber(&format!("{BLOCK}\n{faces}")));
    trial.step(1.0);
    let found = [trial.get("pad.left.force_x"), trial.get("pad.front.force_y")];
    let expected = [-2e4 * 96e-6, -1e4 * 96e-6];
    let is_balanced = |(own, wanted): (f64, f64)| off(own, wanted) < 1e-8;
    assert!(found.into_iter().zip(expected).all(is_balanced), "{found:?}");
    assert!(trial.get("pad.bottom.force_z").abs() < 1e-10);
    // Four rollers about a block that is pressed: what opposite ones bear cancels.
    let faces = "faces = { bottom = { clamped = true }, sides = { roller = true }, top = { pressure = 1e5 } }";
    let mut trial = Trial::new(&rubber(&format!("{BLOCK}\nsymmetry = \"none\"\n{faces}")));
    trial.step(1.0);
    assert!(off(trial.get("pad.bottom.force_z"), 1e5 * 80e-6) < 1e-8);
    assert!(trial.get("pad.sides.force_x").abs() < 1e-9);
}

/// In a model of a quarter a face on rollers bears the force on one of its two images.
#[test]
fn models_of_a_quarter_give_the_force_on_one_image() {
    let faces = "faces = { bottom = { roller = true }, right = { roller = true, displacement = [1e-3, 0.0, 0.0] } }";
    let mut trial = Trial::new(&rubber(&format!("{BLOCK}\nsymmetry = \"quarter\"\n{faces}")));
    trial.step(1.0);
    // Half of the length, 5 mm, becomes 6 mm, and the sides are free.
    let expected = 96e-6 * Rubber::of_young(1e6, 0.4).force(1.2, Sides::Free);
    let found = trial.get("pad.right.force_x");
    assert!(off(found, expected) < 1e-8, "{found} {expected}");
}

/// Forces on held faces over a step are the change of momentum beyond loads and weight.
#[test]
fn held_faces_bear_what_moves() {
    let faces = "faces = { bottom = { clamped = true }, right = { traction = [2e4, 0.0, 1e4] } }";
    let keys = "inertia = true\nmotion = \"implicit\"\nsymmetry = \"none\"\ngravity = 9.81";
    let mut trial = Trial::new(&rubber(&format!("{BLOCK}\n{keys}\n{faces}")));
    let weight = 9.81 * 0.96e-6 * 1e3;
    let loads = [2e4 * 96e-6, 0.0, 1e4 * 96e-6 - weight];
    let mut before = [0.0; 3];
    for _ in 0..20 {
        trial.step(1e-3);
        let momentum = ["x", "y", "z"].map(|a| trial.get(&format!("pad.momentum_{a}")));
        let forces = ["x", "y", "z"].map(|a| trial.get(&format!("pad.bottom.force_{a}")));
        for axis in 0..3 {
            let missing = (momentum[axis] - before[axis]) / 1e-3 - forces[axis] - loads[axis];
            assert!(missing.abs() < 1e-8, "{missing}: {forces:?}");
        }
        before = momentum;
    }
}

/// Sides of a bonded pad bulge through the planes of the platens if these press hard enough.
#[test]
fn sides_that_bulge_through_platens_are_warned_of() {
    let faces = "faces = { bottom = { clamped = true }, top = { displacement = [0.0, 0.0, 0.0] } }";
    for (pressed, warned) in [(0.05, false), (0.45, true)] {
        let text =
            rubber(&format!("{DISC}\n{faces}")).replace("spacing = 2e-3", "spacing = 0.5e-3");
        let mut trial = Trial::new(&text.replace("poisson = 0.4", "poisson = 0.49"));
        for n in 1..=10 {
            trial.set("pad.top.displacement_z", -6e-3 * pressed * f64::from(n) / 10.0);
            trial.step(1e-2);
        }
        let found = trial.model.warnings(&trial.state);
        let is_warned = found.iter().any(|warning| warning.finding().id == "sides_pass_faces");
        assert_eq!(is_warned, warned, "{pressed}: height {}", trial.get("pad.height"));
    }
}

/// A strut between two faces that do not turn buckles under `4 π² E I/L²` (L. Euler 1744), which a straight one does not
/// find by itself. In a plane section E is `E/(1 − ν²)`.
#[test]
fn straight_struts_beyond_their_buckling_load_are_warned_of() {
    let buckles = 4.0 * PI.powi(2) * (1.0_f64 / 20.0).powi(2) / 12.0;
    for material in [
        "model = \"neo_hookean\", young = 1e6, poisson = 0.3",
        "model = \"elastoplastic\", young = 70e9, poisson = 0.33, yield_stress = 5e9, isotropic_hardening = 1e9",
    ] {
        for (strain, warned) in [(0.9 * buckles, false), (1.15 * buckles, true)] {
            let text = format!(
                "name = \"Strut\"\nstop_time = 1.0\nstep = 0.1\n[body.strut]\nkind = \"solid\"\nstrain = \"finite\"\n\
                 dimension = 2\nshape = {{ box = [20e-3, 1e-3, 1e-3] }}\ninitial_temperature = 293.15\n\
                 mesh = {{ spacing = 1e-4 }}\nfaces.left = {{ clamped = true }}\n\
                 faces.right = {{ displacement = [0.0, 0.0, 0.0] }}\n\
                 material = {{ density = 1e3, specific_heat = 1e3, conductivity = 1.0, {material} }}\n"
            );
            let mut trial = Trial::new(&text);
            for n in 1..=3 {
                trial.set("strut.right.displacement_x", -20e-3 * strain * f64::from(n) / 3.0);
                trial.step(0.1);
            }
            let found = trial.model.warnings(&trial.state);
            let is_warned = found.iter().any(|own| own.finding().id == "equilibrium_not_stable");
            assert_eq!(is_warned, warned, "{material} {strain}");
        }
    }
}

/// A bar of rubber whose lower face moves at 2 m/s from 2 to 4 ms and stops: waves cross it in 0.3 ms.
fn thrust(step: f64) -> (f64, bool) {
    let text = format!(
        "name = \"Bar\"\nstop_time = 1.0\nstep = {step:e}\n[body.bar]\nkind = \"solid\"\nstrain = \"finite\"\n\
         dimension = 2\nshape = {{ box = [10e-3, 1.0, 20e-3] }}\ninitial_temperature = 293.15\n\
         mesh = {{ spacing = 2e-3 }}\ninertia = true\nmotion = \"implicit\"\n\
         faces.bottom = {{ displacement = [0.0, 0.0, 0.0] }}\n\
         material = {{ density = 1100.0, specific_heat = 1e3, conductivity = 1.0, model = \"neo_hookean\", \
         young = 1e6, poisson = 0.45 }}\n"
    );
    let mut trial = Trial::new(&text);
    while trial.state.time < 6e-3 - 1e-9 {
        let place = 2.0 * (trial.state.time + step - 2e-3).clamp(0.0, 2e-3);
        trial.set("bar.bottom.displacement_z", place);
        trial.step(step);
    }
    let found = trial.model.warnings(&trial.state);
    let is_warned = found.iter().any(|warning| warning.finding().id == "steps_miss_jolts");
    (trial.get("bar.kinetic") + trial.get("bar.stored"), is_warned)
}

/// Whole steps of 2, 1 and 0.5 ms give 3.7, 2.9 and 2.0 times the energy.
#[test]
fn steps_in_which_a_face_jolts_are_cut_and_warned_of() {
    let (energy, _) = thrust(5e-5);
    for (step, error) in [(2e-3, 0.2), (1e-3, 0.1), (5e-4, 0.1)] {
        let (found, is_warned) = thrust(step);
        assert!(is_warned && off(found, energy) < error, "{step}: {found} {energy}");
    }
}

//! Solids that sink into a bath: the steady profile about its surface, heat, complete immersion, states, parameters.

use closed_form::dipped_plate::DippedPlate;
use impinge::model::tolerance::estimates;
use impinge::scene;

use crate::common::{Trial, off};

const START: f64 = 400.0;
const BATH: f64 = 300.0;

/// A thin strip, 20 mm high, that is of one temperature through its thickness to 0.2 %, with keys of its own.
fn strip(keys: &str, more: &str) -> String {
    format!(
        "name = \"Baths\"\nstop_time = 4.0\nstep = 0.1\n[body.strip]\nkind = \"solid\"\n\
         shape = {{ box = [0.2e-3, 0.1e-3, 20e-3] }}\ninitial_temperature = {START}\n\
         material = {{ model = \"thermoelastic\", density = 2500.0, specific_heat = 840.0, conductivity = 10.0 }}\n\
         mesh = {{ spacing = 0.05e-3, depth_spacing = 0.1e-3, growth = 1.0, order = 1 }}\n{keys}\n{more}\n"
    )
}

const SINKS: &str = "bath = { coefficient = 800.0, ambient = 300.0, speed = 8e-3, depth = -1e-3 }";

/// Temperature along the axis of the strip, `(T − T∞)/(T₀ − T∞)`.
fn along(trial: &mut Trial, count: usize) -> Vec<f64> {
    let read = |i| (trial.get(&format!("axis.temperature[1,{}]", i + 1)) - BATH) / (START - BATH);
    (0..count).map(read).collect()
}

const AXIS: &str = "[[field]]\nname = \"axis\"\nin = \"strip\"\nplane = { y = 0.0 }\ngrid = [1, 201]\n\
                    gives = [\"temperature\"]";

#[test]
fn sinking_strip_has_the_steady_profile_about_the_surface() {
    let dry = "faces = { left = { flux = 0.0 }, right = { flux = 0.0 } }";
    let mut trial = Trial::new(&strip(&format!("{dry}\n{SINKS}"), AXIS));
    (0..15).for_each(|_| trial.step(0.1));
    let plate = DippedPlate {
        diffusivity: 10.0 / (2500.0 * 840.0),
        speed: 8e-3,
        rate: 2.0 * 800.0 / (2500.0 * 840.0 * 0.1e-3),
    };
    // The bath has reached 11 mm, and both ends are more than seven lengths of the profile away.
    let surface = 11e-3;
    for (i, found) in along(&mut trial, 201).into_iter().enumerate().skip(40).take(140) {
        let wanted = plate.temperature(20e-3 * i as f64 / 200.0 - surface);
        assert!((found - wanted).abs() < 5e-3, "{i}: {found} {wanted}");
    }
    assert!(trial.heat_residual("strip") < 1e-9);
}

#[test]
fn errors_of_bodies_in_a_bath_are_not_estimated() {
    let dry = "faces = { left = { flux = 0.0 }, right = { flux = 0.0 } }";
    let scene = scene::parse(&strip(&format!("{dry}\n{SINKS}"), AXIS), "strip.toml").unwrap();
    let (_, all) = estimates(&scene);
    let found = &all[0];
    assert!(found.outputs.is_empty() && found.notes == ["no estimate: the body sinks into a bath"]);
}

#[test]
fn immersed_body_cools_as_one_with_convection_on_all_faces() {
    let immersed = "bath = { coefficient = 800.0, ambient = 300.0, speed = 0.0, depth = 30e-3 }";
    let face = "{ convection = { coefficient = 800.0, ambient = 300.0 } }";
    let all = format!("[body.strip.faces]\nsides = {face}\ntop = {face}\nbottom = {face}");
    let newton = "[solver]\nmethod = \"newton\"";
    let mut one = Trial::new(&strip(immersed, ""));
    let mut other = Trial::new(&strip("", &format!("{all}\n{newton}")));
    for trial in [&mut one, &mut other] {
        (0..3).for_each(|_| trial.step(0.1));
    }
    for key in ["strip.max_temperature", "strip.heat_lost", "strip.heat_stored"] {
        // The error of inner steps is 0.1 K at most, that of their linear systems a fiftieth of it.
        assert!(off(one.get(key), other.get(key)) < 1e-4, "{key}");
    }
}

#[test]
fn faces_with_a_condition_of_their_own_stay_dry() {
    let flux = "flux = 0.0";
    let dry = format!("faces = {{ sides = {{ {flux} }}, bottom = {{ {flux} }} }}");
    let immersed = "bath = { coefficient = 800.0, ambient = 300.0, speed = 0.0, depth = 10e-3 }";
    let mut trial = Trial::new(&strip(&format!("{dry}\n{immersed}"), ""));
    trial.step(0.1);
    assert_eq!(trial.get("strip.heat_lost"), 0.0);
}

#[test]
fn bath_moves_with_time_and_is_part_of_the_state() {
    let text = strip(SINKS, AXIS);
    let run = |steps: &[f64]| {
        let mut trial = Trial::new(&text);
        steps.iter().for_each(|&dt| trial.step(dt));
        along(&mut trial, 201)
    };
    // Errors of inner steps are 0.1 K at most.
    let [short, long] = [run(&[0.05; 20]), run(&[1.0])];
    let most = short.iter().zip(&long).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(most < 3e-3, "{most}");
    let mut trial = Trial::new(&text);
    trial.step(0.5);
    let saved = trial.state.clone();
    trial.step(0.5);
    let once = along(&mut trial, 201);
    trial.restart(&saved);
    trial.step(0.5);
    assert_eq!(once, along(&mut trial, 201));
}

#[test]
fn body_that_is_drawn_out_dries() {
    let keys = "bath = { coefficient = 800.0, ambient = 300.0, speed = -10e-3, depth = 20e-3 }";
    let mut trial = Trial::new(&strip(keys, ""));
    (0..21).for_each(|_| trial.step(0.1));
    let lost = trial.get("strip.heat_lost");
    assert!(lost > 0.0);
    trial.step(0.5);
    assert!(off(trial.get("strip.heat_lost"), lost) < 1e-12);
}

#[test]
fn constants_of_the_bath_are_parameters() {
    let scene = scene::parse(&strip(SINKS, ""), "scene.toml").unwrap();
    let strip = &scene.body["strip"];
    let keys: Vec<String> = strip.constants("strip").into_iter().map(|own| own.key).collect();
    for key in ["bath_coefficient", "bath_temperature", "bath_speed", "bath_depth"] {
        assert!(keys.iter().any(|own| own == key), "{key}");
    }
}

//! Inputs, parameters, steps and times that a call sets.

use std::fs;

use crate::{DROP, SCENE, Workplace};

#[test]
fn inputs_are_judged_like_the_scenes_constants() {
    let place = Workplace::new();
    let run = |setting| place.run(&["--overwrite", "--set", setting]).succeeds().stderr();
    let said = run("plate.bottom.temperature=20");
    let wanted = "warning: plate.bottom.temperature = 20: a temperature is plausible from 250 to 6000 K \
                  beside warmer ones, and 20 K is −253.15 °C; did you mean 293.15 (20 °C)?";
    assert!(said.contains(wanted), "{said}");
    assert!(run("spot.pressure=1e12").contains("a pressure or shear is plausible"));
    assert!(!run("plate.bottom.temperature=300").contains("plausible"));
}

#[test]
fn implausible_array_input_warns_once() {
    let place = Workplace::new();
    fs::write(place.path("scene.toml"), DROP).unwrap();
    let said = place.run(&["--set", "wall.temperature=20"]).succeeds().stderr();
    assert_eq!(said.matches("did you mean 293.15").count(), 1, "{said}");
}

#[test]
fn step_option_replaces_that_of_the_scene() {
    let place = Workplace::new();
    place.run(&["--step", "5e-7", "--out", "coarse", "--fields-every", "0"]).succeeds();
    let times: Vec<f64> = place.table("coarse").1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 5e-7, 1e-6]);
    assert!(!place.path("coarse/plate.pvd").exists());
}

#[test]
fn inputs_and_parameters_can_be_set() {
    let place = Workplace::new();
    let options = ["--set", "spot.heat_flux=2e7", "--set", "plate.conductivity = 20", "--out", "a"];
    place.run(&options).succeeds();
    assert!(place.table("a").1.iter().all(|row| row[1] == 2e7));
}

#[test]
fn settings_that_cannot_be_are_refused_by_name() {
    let place = Workplace::new();
    let twice = ["--set", "spot.heat_flux=1", "--set", "spot.heat_flux=2"];
    place.run(&twice).fails(1, &["spot.heat_flux: it is set twice"]);
    for (setting, words) in [
        (
            "spot.heat_flux=1e308",
            "spot.heat_flux = 1e308: expected a number in W/m2, -1e60 to 1e60",
        ),
        ("spot.pressure=-1e61", "spot.pressure = -1e61: expected a number in Pa, -1e60 to 1e60"),
        ("plate.bottom.temperature=1e12", "expected a number in K, above 0 and at most 1e9"),
        ("plate.bottom.temperature=0", "expected a number in K, above 0 and at most 1e9"),
        ("plate.bottom.temperature=-20", "expected a number in K, above 0 and at most 1e9"),
        ("spot.x=1e7", "spot.x = 1e7: expected a number in m, -1e6 to 1e6"),
        ("spot.radius=1e-13", "spot.radius = 1e-13: expected a number in m, 1e-12 to 1e6"),
    ] {
        place.run(&["--set", setting]).fails(1, &[words]);
    }
    assert!(!place.path("out").exists(), "a refused run writes nothing");
}

#[test]
fn steps_and_times_beyond_those_of_scenes_are_refused() {
    let place = Workplace::new();
    for (option, value) in [("--step", "1e304"), ("--step", "1e-31"), ("--until", "1e13")] {
        place.run(&[option, value]).fails(1, &["is beyond all bounds", "1e-30 to 1e12"]);
    }
    let text = SCENE.replace("stop_time = 1e-6", "stop_time = 1e305");
    fs::write(place.path("scene.toml"), text.replace("step = 1e-7", "step = 1e304")).unwrap();
    place
        .call(&["check", "scene.toml"])
        .fails(1, &["scene.toml:4", "scene.toml:5", "1e-30 to 1e12"]);
}

#[test]
fn arrays_are_set_by_name_and_elements_by_index() {
    let place = Workplace::new();
    let rings = SCENE.replace("disc = { radius", "rings = { count = 3, radius");
    fs::write(place.path("scene.toml"), rings).unwrap();
    let options = ["--set", "spot.heat_flux=1e7", "--set", "spot.heat_flux[2]=3e7", "--out", "a"];
    place.run(&options).succeeds();
    assert!(place.table("a").1.iter().all(|row| row[1..4] == [1e7, 3e7, 1e7]));
}

#[test]
fn unsettable_names_are_refused_with_the_reason() {
    let place = Workplace::new();
    let refused = |setting: &str, words: &[&str]| {
        place.run(&["--set", setting]).fails(1, words);
    };
    refused("spot.heatflux=1", &["spot.heatflux", "did you mean spot.heat_flux"]);
    refused("conductivity=1", &["did you mean plate.conductivity"]);
    refused("zzz=1", &["zzz", "impinge check"]);
    refused("centre.temperature=300", &["centre.temperature", "output"]);
    refused("output.directory=here", &["--out"]);
    refused("plate.young=stiff", &["plate.young = stiff", "a number in Pa"]);
    refused("plate.density=NaN", &["plate.density = NaN"]);
    refused("plate.density=-1", &["plate.density = -1", "at least 0"]);
    refused("plate.poisson=0.7", &["plate.poisson = 0.7", "-1 to 0.5"]);
    refused("plate.poisson=0.5", &["0.5"]);
    refused("solver.threads=1.5", &["solver.threads = 1.5", "whole number"]);
    assert!(!place.path("out").exists(), "a refused run writes nothing");
}

#[test]
fn refused_settings_are_reported_together() {
    let place = Workplace::new();
    let options = ["--set", "plate.density=-1", "--set", "nothing=1"];
    place.run(&options).fails(1, &["error: cannot set plate.density", "error: cannot set nothing"]);
}

#[test]
fn footprints_wider_than_their_face_are_refused_by_radius() {
    let place = Workplace::new();
    place.run(&["--set", "spot.radius=1"]).fails(1, &["spot.radius", "half width 1 m"]);
    place.run(&["--set", "spot.x=1.9e-4"]).fails(1, &["spot.x"]);
}

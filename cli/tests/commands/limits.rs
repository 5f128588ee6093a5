//! Runs beyond memory, address space or patience.

use std::fs;
use std::process::Command;

use crate::{Called, DROP, SCENE, Workplace};

#[test]
fn run_of_months_is_refused_with_a_proposal() {
    let place = Workplace::new();
    fs::write(place.path("drop.toml"), DROP.replace("spacing = 1e-5", "spacing = 2e-6")).unwrap();
    let long = ["run", "drop.toml", "--until", "100", "--step", "1e-6"];
    place
        .call(&long)
        .fails(1, &["the run would take about", "years", "allowed: 30 days", "--until"]);
    assert!(!place.path("out").exists());
}

#[cfg(unix)]
#[test]
fn scenes_beyond_the_memory_of_the_machine_are_refused_with_numbers() {
    let place = Workplace::new();
    let huge = SCENE.replace("spacing = 4e-5", "spacing = 1e-8");
    fs::write(place.path("scene.toml"), huge).unwrap();
    let words = ["MB of memory", "plate", "unknowns", "larger `mesh.spacing`"];
    place.call(&["check", "scene.toml"]).fails(1, &words);
    place.run(&[]).fails(1, &words);
    assert!(!place.path("out").exists(), "a refused run writes nothing");
}

#[test]
fn memory_limit_of_a_scene_is_kept() {
    let place = Workplace::new();
    let limited = |memory: &str| format!("solver = {{ memory = {memory} }}\n{SCENE}");
    let words = ["MB of memory", "have 1.000e0 MB", "larger `mesh.spacing`"];
    // The same as in the documentation.
    for memory in ["1_000_000", "1e6", "1000000.0"] {
        fs::write(place.path("scene.toml"), limited(memory)).unwrap();
        place.call(&["check", "scene.toml"]).fails(1, &words);
        place.run(&[]).fails(1, &words);
    }
    for (memory, words) in [
        ("1234567.5", ["scene.toml:1: solver.memory = 1234567.5", "whole number"]),
        ("2e15", ["scene.toml:1: solver.memory = 2e15", "1e6 to 1e15"]),
        ("\"1e6\"", ["scene.toml:1: solver.memory", "this text has no unit"]),
        ("\"2 m\"", ["scene.toml:1: solver.memory", "cannot be converted to B"]),
    ] {
        fs::write(place.path("scene.toml"), limited(memory)).unwrap();
        place.call(&["check", "scene.toml"]).fails(1, &words);
    }
    for memory in ["1_000_000_000", "\"1 GB\""] {
        fs::write(place.path("scene.toml"), limited(memory)).unwrap();
        place.call(&["check", "scene.toml"]).succeeds();
    }
}

/// If the address space is limited, the scene's own memory limit applies as well.
#[cfg(target_os = "linux")]
#[test]
fn limited_address_space_counts_as_missing_memory() {
    let place = Workplace::new();
    let large = SCENE.replace("spacing = 4e-5, order = 1", "spacing = 5e-7");
    fs::write(place.path("scene.toml"), large).unwrap();
    let program = env!("CARGO_BIN_EXE_impinge");
    let limited = format!("ulimit -v 500000; exec {program} check scene.toml");
    let output =
        Command::new("sh").args(["-c", &limited]).current_dir(place.0.path()).output().unwrap();
    Called(output).fails(1, &["MB of address space", "RLIMIT_AS", "larger `mesh.spacing`"]);
}

/// Runs finish or are refused, whatever the limit is.
#[cfg(target_os = "linux")]
#[test]
fn too_little_address_space_is_refused() {
    let place = Workplace::new();
    let coarse = SCENE.replace("spacing = 4e-5", "spacing = 5e-5");
    fs::write(place.path("scene.toml"), coarse).unwrap();
    let program = env!("CARGO_BIN_EXE_impinge");
    let mut done = 0;
    for megabytes in (40..=196).step_by(26) {
        let limited = format!(
            "ulimit -v {megabytes}000; exec {program} run scene.toml --until 2e-7 --overwrite \
             --set solver.threads=3"
        );
        let output =
            Command::new("sh").args(["-c", &limited]).current_dir(place.0.path()).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        match output.status.code() {
            Some(0) => done += 1,
            Some(1) => assert!(said.contains("RLIMIT_AS"), "{megabytes} MB: {said}"),
            code => panic!("{megabytes} MB: {code:?}, {said}"),
        }
    }
    assert!(done > 2, "{done} runs of 7 had enough");
}

#[cfg(unix)]
#[test]
fn endless_scenes_are_refused() {
    let place = Workplace::new();
    place.call(&["check", "/dev/zero"]).fails(1, &["/dev/zero", "a pipe, socket or device"]);
}

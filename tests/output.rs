//! Files written by the library alone.

use std::fs;
use std::path::Path;

use impinge::model::{Cache, Model, State};
use impinge::output::FieldSeries;
use impinge::scene;
use tempfile::TempDir;

const SCENE: &str = r#"
name = "Block"
stop_time = 1e-6
step = 1e-7
[body.block]
kind = "solid"
shape = { box = [4e-4, 4e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 5e-5 }
[body.block.faces]
sides = { clamped = true }
[[load]]
name = "spot"
on = "block.top"
footprint = { disc = { radius = 1e-4 } }
carries = ["heat_flux"]
"#;

fn model() -> Model {
    let scene = scene::parse(SCENE, "block.toml").unwrap();
    Model::build(&scene, 1).unwrap()
}

/// The initial state, called a state of another time.
fn at(model: &Model, time: f64) -> State {
    State { time, ..model.initial_state() }
}

/// Times in the list of the block's files.
fn listed(folder: &Path) -> Vec<String> {
    let list = fs::read_to_string(folder.join("block.pvd")).unwrap();
    list.split("timestep=\"").skip(1).map(|s| s.split('"').next().unwrap().to_owned()).collect()
}

#[test]
fn the_list_is_readable_after_each_time() {
    let folder = TempDir::new().unwrap();
    let model = model();
    let mut series = FieldSeries::create(folder.path(), &model).unwrap();
    assert_eq!(listed(folder.path()), [""; 0]);
    for (time, expected) in [(0.0, &["0.0"][..]), (1e-7, &["0.0", "1e-7"])] {
        series.write(&model, &at(&model, time), &mut Cache::default()).unwrap();
        assert_eq!(listed(folder.path()), expected);
    }
    let names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names.len(), 3, "two grids, a list and nothing else: {names:?}");
}

#[test]
fn a_restored_state_replaces_what_came_after_it() {
    let folder = TempDir::new().unwrap();
    let model = model();
    let mut series = FieldSeries::create(folder.path(), &model).unwrap();
    for time in [0.0, 1.0, 2.0, 1.0] {
        series.write(&model, &at(&model, time), &mut Cache::default()).unwrap();
    }
    assert_eq!(listed(folder.path()), ["0.0", "1.0"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_named_with_the_reason() {
    let folder = TempDir::new().unwrap();
    let taken = folder.path().join("taken");
    fs::write(&taken, "a file").unwrap();
    let error = FieldSeries::create(&taken.join("here"), &model()).err().unwrap().to_string();
    assert!(error.starts_with("cannot create the folder") && error.contains("taken"), "{error}");
}

//! Files written by the library alone.

use std::fs;
use std::path::Path;

use impinge::model::{Cache, Model, State};
use impinge::output::{Discs, FieldSeries};
use impinge::scene;
use impinge::variables::{Registry, Slot};
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
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Sections).unwrap();
    assert_eq!(listed(folder.path()), [""; 0]);
    for (time, expected) in [(0.0, &["0.0"][..]), (1e-7, &["0.0", "1e-7"])] {
        series.write(&model, &at(&model, time), &mut Cache::default()).unwrap();
        assert_eq!(listed(folder.path()), expected);
    }
    let names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names.len(), 3, "two grids, their list and nothing else: {names:?}");
}

#[test]
fn a_restored_state_replaces_what_came_after_it() {
    let folder = TempDir::new().unwrap();
    let model = model();
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Sections).unwrap();
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
    let error = FieldSeries::create(&taken.join("here"), &model(), Discs::Sections)
        .err()
        .unwrap()
        .to_string();
    assert!(error.starts_with("cannot create the folder") && error.contains("taken"), "{error}");
}

/// Names of all files of a folder, in order.
fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn files_of_an_earlier_run_do_not_stay() {
    let folder = TempDir::new().unwrap();
    let model = model();
    let foreign = ["block.txt", "block_000007.txt", "blocks_000003.vtr", "block_7.vtr"];
    let ours = ["block_000005.vtr", "block_1000000.vtr", "block_000001.vtr.part12_3"];
    for name in foreign.iter().chain(&ours).chain(&["block.pvd.part", "block_000009.vtp"]) {
        fs::write(folder.path().join(name), "earlier").unwrap();
    }
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Sections).unwrap();
    let mut expected = [&foreign[..], &["block.pvd"]].concat();
    expected.sort();
    assert_eq!(files(folder.path()), expected);
    for time in [0.0, 1.0, 2.0] {
        series.write(&model, &at(&model, time), &mut Cache::default()).unwrap();
    }
    // A state of an earlier time takes the later ones away at once.
    series.go_back(0.5).unwrap();
    assert_eq!(listed(folder.path()), ["0.0"]);
    let left: Vec<_> =
        files(folder.path()).into_iter().filter(|name| name.starts_with("block_00000")).collect();
    assert_eq!(left, ["block_000000.vtr", "block_000007.txt"]);
}

#[test]
fn a_file_that_cannot_be_written_is_not_listed() {
    let folder = TempDir::new().unwrap();
    let model = model();
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Sections).unwrap();
    series.write(&model, &at(&model, 0.0), &mut Cache::default()).unwrap();
    let taken = folder.path().join("block_000001.vtr");
    fs::create_dir(&taken).unwrap();
    let error = series.write(&model, &at(&model, 1.0), &mut Cache::default()).unwrap_err();
    assert!(error.to_string().contains("block_000001.vtr"), "{error}");
    assert_eq!(listed(folder.path()), ["0.0"]);
    let left = ["block.pvd", "block_000000.vtr", "block_000001.vtr"];
    assert_eq!(files(folder.path()), left);
    // Once the way is free the series goes on with the number that was not used.
    fs::remove_dir(&taken).unwrap();
    series.write(&model, &at(&model, 2.0), &mut Cache::default()).unwrap();
    assert_eq!(listed(folder.path()), ["0.0", "2.0"]);
    assert!(taken.is_file());
}

#[test]
fn a_disc_is_written_as_a_body_of_three_dimensions() {
    let folder = TempDir::new().unwrap();
    let text =
        SCENE.replace("box = [4e-4, 4e-4, 1e-4]", "disc = { radius = 2e-4, thickness = 1e-4 }");
    let model = Model::build(&scene::parse(&text, "disc.toml").unwrap(), 1).unwrap();
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Revolved).unwrap();
    series.write(&model, &at(&model, 0.0), &mut Cache::default()).unwrap();
    assert_eq!(files(folder.path()), ["block.pvd", "block_000000.vts"]);
    let bytes = fs::read(folder.path().join("block_000000.vts")).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let (head, _) = text.split_once("<AppendedData").unwrap();
    for words in ["StructuredGrid", "temperature", "position"] {
        assert!(head.contains(words), "{words}: {head}");
    }
}

/// A plate, a drop that an input releases above it, and a recorded one.
const DROPS: &str = r#"
name = "Drops"
stop_time = 2e-6
step = 1e-6
[body.plate]
kind = "solid"
shape = { box = [4e-4, 4e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 293.15
mesh = { spacing = 1e-4 }
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 10.0
initial_temperature = 350.0
spacing = 12.5e-6
release = "input"
most = 1
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.07 }
[body.film]
kind = "droplet"
method = "film"
diameter = 1e-4
impact_velocity = 10.0
initial_temperature = 350.0
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.07 }
[[coupling]]
from = "drop"
to = "plate.top"
[[wall]]
name = "wall"
under = "film"
footprint = { rings = { count = 4, radius = 2e-4 } }
"#;

#[test]
fn one_list_opens_all_bodies_and_no_file_is_without_points() {
    let folder = TempDir::new().unwrap();
    let model = Model::build(&scene::parse(DROPS, "drops.toml").unwrap(), 1).unwrap();
    let mut series = FieldSeries::create(folder.path(), &model, Discs::Sections).unwrap();
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    series.write(&model, &state, &mut cache).unwrap();
    let release = Registry::of(model.scene()).variables;
    let release = release.iter().find(|variable| variable.name == "drop.release").unwrap();
    let Slot::Input(release) = release.slot else { panic!("{release:?}") };
    state.inputs[release] = 1.0;
    model.step(&mut state, &mut cache, 1e-6).unwrap();
    series.write(&model, &state, &mut cache).unwrap();
    series.check_present().unwrap();
    let expected = [
        "all-bodies.pvd",
        "drop.pvd",
        "drop_000001.vtp",
        "plate.pvd",
        "plate_000000.vtr",
        "plate_000001.vtr",
    ];
    assert_eq!(files(folder.path()), expected);
    let list = fs::read_to_string(folder.path().join("all-bodies.pvd")).unwrap();
    let entries: Vec<&str> = list.lines().filter(|line| line.contains("<DataSet")).collect();
    assert_eq!(entries.len(), 3, "the plate twice, the drop once it is there: {list}");
    let parts = ["plate_000000.vtr", "drop_000001.vtp", "plate_000001.vtr"];
    assert!(parts.iter().all(|file| list.contains(file)), "{list}");
    let times: Vec<bool> = entries.iter().map(|entry| entry.contains("timestep=\"0.0\"")).collect();
    assert_eq!(times, [true, false, false], "in the order of time");
}

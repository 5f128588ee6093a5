//! Scenes with more probes than are tried: meshes and errors follow from a sample of them, and what describes a unit
//! says the same of each as it would alone.

use std::fmt::Write;

use impinge::model::tolerance::{estimates, note_on_sample};
use impinge::scene::{self, Scene};
use impinge::variables::{ArrayRegistry, Registry};

const HEAD: &str = r#"
name = "Many"
stop_time = 10.0
step = 1.0
[body.bed]
kind = "solid"
shape = { disc = { radius = 0.05, thickness = 0.006 } }
material = { model = "thermoelastic", density = 2700.0, specific_heat = 900.0, conductivity = 150.0 }
initial_temperature = 300.0
[body.bed.faces]
top = { temperature = 300.0 }
[[load]]
name = "heater"
on = "bed.bottom"
carries = ["heat_flux"]
start = { heat_flux = 1e4 }
footprint = { disc = { radius = 0.03 } }
"#;

/// Text of a scene with the probes of these numbers among `count` that lie on a spiral.
fn text(numbers: impl Iterator<Item = usize>, count: usize) -> String {
    let mut text = HEAD.to_owned();
    for i in numbers {
        let part = (i as f64 + 0.5) / count as f64;
        let (radius, z) = (0.049 * part.sqrt(), -0.006 * (7.0 * part).fract());
        let _ = writeln!(
            text,
            "[[probe]]\nname = \"p{i}\"\nin = \"bed\"\nat = [{radius:?}, 0.0, {z:?}]\ngives = [\"temperature\"]"
        );
    }
    text
}

fn scene_of(numbers: impl Iterator<Item = usize>, count: usize) -> Scene {
    scene::parse(&text(numbers, count), "many.toml").unwrap()
}

/// Numbers of the probes whose errors are estimated.
fn estimated(scene: &Scene) -> Vec<usize> {
    let (_, found) = estimates(scene);
    let names = found[0].outputs.iter().filter_map(|one| one.name.strip_suffix(".temperature"));
    names.filter_map(|name| name.strip_prefix('p')?.parse().ok()).collect()
}

#[test]
fn meshes_and_errors_of_many_probes_are_those_of_a_sample_which_is_said() {
    let count = 700;
    let many = scene_of(0..count, count);
    let sample = estimated(&many);
    assert_eq!(sample.len(), 256);
    let (resolved, found) = estimates(&many);
    let (of_sample, alone) = estimates(&scene_of(sample.iter().copied(), count));
    assert_eq!(found[0].outputs, alone[0].outputs);
    assert_eq!(resolved.refinement, of_sample.refinement);
    let note = "in the estimate 256 of 700 probes stand for all of them";
    assert!(found[0].notes.iter().any(|one| one == note), "{:?}", found[0].notes);
    assert!(note_on_sample(&many).is_some_and(|note| note.contains("of 700 probes, 256 a body")));
}

#[test]
fn up_to_256_probes_are_all_estimated() {
    let few = scene_of(0..256, 256);
    assert_eq!(estimated(&few), (0..256).collect::<Vec<_>>());
    assert_eq!(note_on_sample(&few), None);
    assert!(!estimates(&few).1[0].notes.iter().any(|note| note.contains("stand for all")));
}

#[test]
fn dependencies_of_all_outputs_at_once_are_those_of_each() {
    let scene = scene_of(0..300, 300);
    let (registry, arrays) = (Registry::of(&scene), ArrayRegistry::of(&scene));
    let all = arrays.all_dependencies(&scene, &registry);
    assert!(all.len() > 300);
    for (reference, inputs) in &all {
        let own = arrays.dependencies(&scene, &registry, &arrays.variables[*reference]);
        assert_eq!(inputs[..], own[..]);
    }
    assert!(all.iter().any(|(_, inputs)| !inputs.is_empty()));
}

#[test]
fn a_large_text_is_said_before_it_is_read() {
    let text = text(0..20_000, 20_000);
    let note = scene::note_on_reading(&text, "many.toml").unwrap();
    assert!(note.starts_with("reading many.toml, 2."), "{note}");
    assert_eq!(scene::note_on_reading(HEAD, "few.toml"), None);
    assert_eq!(scene::parse(&text, "many.toml").unwrap().probe.len(), 20_000);
}

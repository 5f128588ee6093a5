//! What `level = "auto"` comes to, what is told of it, and reductions that are stored.

use impinge::model::tolerance::{Levels, levels, levels_fit, packed_text, stored_reductions};
use impinge::model::{Model, forecast, keep_reduction};
use impinge::scene::{self, Scene, SolidLevel};
use impinge::variables::Registry;

use crate::common::Trial;

const AVAILABLE: f64 = 4e9;

/// A plate below a spot, held from below.
fn text(constants: [f64; 3], level: &str, tolerance: f64) -> String {
    let [density, specific_heat, conductivity] = constants;
    format!(
        "name = \"Levels\"\nstop_time = 1e-3\nstep = 1e-5\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ box = [2e-3, 1.6e-3, 0.4e-3] }}\n\
         material = {{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, \
         conductivity = {conductivity:?} }}\ninitial_temperature = 300.0\n\
         mesh = {{ spacing = 1e-4, depth_spacing = 3e-5, growth = 1.5 }}\n\
         [body.plate.faces]\nbottom = {{ temperature = 300.0 }}\n\
         [[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\"]\n\
         footprint = {{ gaussian = {{ radius = 2e-4 }} }}\nstart = {{ heat_flux = 3e7 }}\n\
         [[probe]]\nname = \"a\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"temperature\"]\n\
         [[probe]]\nname = \"b\"\nin = \"plate\"\nat = [1e-4, 5e-5, -5e-5]\ngives = [\"temperature\"]\n\
         [fidelity]\nlevel = \"{level}\"\ntolerance = {tolerance:e}\n"
    )
}

const COPPER: [f64; 3] = [8960.0, 385.0, 400.0];
/// Heat stays so near to the top that the probe within gets none worth its bound.
const AEROGEL: [f64; 3] = [100.0, 1000.0, 0.015];

fn parsed(text: &str) -> Scene {
    scene::parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn names(scene: &Scene) -> Vec<String> {
    Registry::of(scene).variables.into_iter().map(|variable| variable.name).collect()
}

#[test]
fn auto_is_reduced_where_the_bound_keeps_the_tolerance_and_full_elsewhere() {
    let cases = [
        (COPPER, 1e-4, SolidLevel::Reduced, "plate: reduced, which keeps the tolerance"),
        (AEROGEL, 1e-2, SolidLevel::Reduced, "plate: reduced, which keeps the tolerance"),
        (AEROGEL, 1e-4, SolidLevel::Full, "plate: full, as the bound of the error of temp"),
    ];
    for (constants, tolerance, wanted, words) in cases {
        let text = text(constants, "auto", tolerance);
        let scene = parsed(&text);
        let found = levels(&scene, AVAILABLE);
        assert_eq!(found.scene.resolved["plate"].level, wanted);
        assert!(found.notes[0].starts_with(words), "{}", found.notes[0]);
        // Whoever reads the packed scene has the same variables, without deciding again.
        let packed = parsed(&packed_text(&scene, &text, &found.scene));
        assert_eq!(packed.resolved, found.scene.resolved);
        assert_eq!(names(&packed), names(&found.scene));
        let has_bound = names(&packed).contains(&"plate.error_bound_temperature".to_owned());
        assert_eq!(has_bound, wanted == SolidLevel::Reduced);
        assert!(levels(&packed, AVAILABLE).notes.is_empty());
    }
}

#[test]
fn auto_says_what_stands_against_a_reduced_model() {
    let peaks = text(COPPER, "auto", 1e-2).replace(
        "initial_temperature = 300.0",
        "initial_temperature = 300.0\npeaks = [\"temperature\"]",
    );
    let Levels { scene, notes, .. } = levels(&parsed(&peaks), AVAILABLE);
    assert_eq!(scene.resolved["plate"].level, SolidLevel::Full);
    assert!(notes[0].contains("computes only its probes and fields"), "{}", notes[0]);
    // What does not fit into memory is not tried.
    let open = parsed(&text(COPPER, "auto", 1e-2));
    let Levels { notes, .. } = levels(&open, 1e3);
    assert!(notes[0].starts_with("plate: full, as"), "{}", notes[0]);
    assert!(levels_fit(&open, AVAILABLE) && !levels_fit(&open, 1e3));
    assert!(levels_fit(&parsed(&peaks), 1e3), "memory does not decide on it");
}

#[test]
fn reduced_solids_that_cannot_keep_the_tolerance_are_warned_of() {
    let model = Model::build(&parsed(&text(AEROGEL, "reduced", 1e-4)), 1).unwrap();
    let warnings: Vec<String> = model.reduction_warnings().map(|one| one.to_string()).collect();
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    for words in [
        "plate: the bound of the error of temperatures",
        "tolerance of 1e-4",
        "fidelity.level = \"full\"",
    ] {
        assert!(warning.contains(words), "{warning}");
    }
    // The bound that is told is that of the outputs themselves.
    let told: f64 =
        warning.split(" model is ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(told > 1e-4 && told < 1e-2, "{told}");
    let fine = Model::build(&parsed(&text(COPPER, "reduced", 1e-4)), 1).unwrap();
    assert_eq!(fine.reduction_warnings().count(), 0);
}

#[test]
fn a_reduction_is_made_once_for_all_that_it_follows_from() {
    let first = Model::build(&parsed(&text(COPPER, "reduced", 1e-3)), 1).unwrap();
    let of = |text: &str| Model::build(&parsed(text), 1).unwrap().reductions();
    let own = text(COPPER, "reduced", 1e-3);
    // Names, threads and other bodies do not matter; by `auto` it is the same one.
    let others = "[body.room]\nkind = \"reservoir\"\nheat_capacity = 1e3\ninitial_temperature = 300.0\n[[load]]";
    let same = [
        own.clone(),
        own.replace("name = \"Levels\"", "name = \"Other\"\nsolver = { threads = 2 }"),
        own.replacen("[[load]]", others, 1),
        own.replace("\"reduced\"", "\"auto\""),
    ];
    for text in &same {
        assert!(of(text) == first.reductions(), "{text}");
    }
    let different = [
        own.replace("385.0", "386.0"),
        own.replace("tolerance = 1e-3", "tolerance = 2e-3"),
        own.replace("stop_time = 1e-3", "stop_time = 2e-3"),
        own.replace("step = 1e-5", "step = 2e-5"),
        own.replace("heat_flux = 3e7", "heat_flux = 2e7"),
        own.replace("at = [0.0, 0.0, 0.0]", "at = [1e-5, 0.0, 0.0]"),
        own.replace("bottom = { temperature = 300.0 }", "bottom = { temperature = 310.0 }"),
        own.replace("spacing = 1e-4", "spacing = 1.1e-4"),
        own.replace("[fidelity]", "[refinement.plate]\nalong = 1.1\nthrough = 1.0\n[fidelity]"),
    ];
    for text in &different {
        assert!(of(text) != first.reductions(), "{text}");
    }
}

#[test]
fn stored_reductions_are_those_that_are_made() {
    let scene = parsed(&text([7850.0, 470.0, 45.0], "reduced", 1e-3));
    let model = Model::build(&scene, 1).unwrap();
    let [(name, bytes)] = &stored_reductions(&scene).unwrap()[..] else { panic!("one solid") };
    assert_eq!(name, "plate");
    let kept = keep_reduction(bytes).unwrap();
    assert!(model.reductions()[0].1 == kept);
    // What is read again, when nobody holds it any more, makes the same bytes.
    drop((model, kept));
    let kept = keep_reduction(bytes).unwrap();
    let model = Model::build(&scene, 1).unwrap();
    assert!(model.reductions()[0].1 == kept);
    assert_eq!(&stored_reductions(&scene).unwrap()[0].1, bytes);
}

#[test]
fn a_forecast_is_of_the_reduced_model() {
    let scene = parsed(&text([2700.0, 900.0, 200.0], "reduced", 1e-3));
    let full = parsed(&text([2700.0, 900.0, 200.0], "full", 1e-3));
    let of = |scene: &Scene| forecast(scene).bodies.remove(0);
    let (before, without) = (of(&scene), of(&full));
    assert_eq!((before.reduced, without.reduced), (Some(None), None));
    assert!(before.step_time < 0.01 * without.step_time && before.build_time >= without.build_time);
    let model = Model::build(&scene, 1).unwrap();
    let known = of(&scene);
    let order = model.initial_state().bodies[0].len() - 4;
    assert_eq!(known.reduced, Some(Some(order)));
    assert!(known.memory < 1e5 && before.memory > without.memory);
}

const TILES: &str = r#"
name = "Levels"
stop_time = 1e-3
step = 1e-5
[body.plate]
kind = "solid"
shape = { box = [2e-3, 2e-3, 0.2e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 300.0
mesh = { spacing = 1e-4, depth_spacing = 2e-5, growth = 1.5 }
[body.plate.faces]
bottom = { convection = { coefficient = 1e3, ambient = 300.0 } }
[[load]]
name = "spray"
on = "plate.top"
footprint = { tiles = { count = [4, 4], size = [1e-3, 1e-3] } }
carries = ["heat_flux"]
[[probe]]
name = "a"
in = "plate"
at = [4e-4, 4e-4, 0.0]
gives = ["temperature"]
[[probe]]
name = "b"
in = "plate"
at = [-1e-4, 1e-4, -5e-5]
gives = ["temperature"]
"#;

#[test]
fn cells_that_heat_does_not_go_from_to_a_probe_do_not_decide() {
    let text = |level: &str| format!("{TILES}[fidelity]\nlevel = \"{level}\"\ntolerance = 1e-2\n");
    let Levels { scene, notes, .. } = levels(&parsed(&text("auto")), AVAILABLE);
    assert_eq!(scene.resolved["plate"].level, SolidLevel::Reduced, "{notes:?}");
    let mut trials = ["full", "reduced"].map(|level| Trial::new(&text(level)));
    for n in 0..20 {
        for trial in &mut trials {
            for cell in 0..16 {
                let name = format!("spray.heat_flux[{},{}]", cell / 4 + 1, cell % 4 + 1);
                trial.set(&name, 1e7 * f64::from((7 * n + 5 * cell) % 11) / 11.0);
            }
            trial.step(if n < 15 { 2e-5 } else { 1e-3 });
        }
        let [full, reduced] = &mut trials;
        let bound = reduced.get("plate.error_bound_temperature");
        for name in ["a.temperature", "b.temperature"] {
            let (wanted, found) = (full.get(name), reduced.get(name));
            assert!((wanted - found).abs() <= bound, "{name}: {wanted} {found}, {bound:e}");
        }
        assert!(reduced.heat_residual("plate") < 1e-12);
    }
}

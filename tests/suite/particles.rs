//! What particles must do as the heat of a solid: balance, symmetry, threads, stress, places of
//! outputs. Their accuracy is measured in `tests/verification/`.

use crate::common::{Trial, off};
use impinge::closed_form::{Conductor, DiscFlux};

/// A box or disc of soft numbers with the given mesh, settings, faces and further tables.
fn block(shape: &str, mesh: &str, sph: &str, faces: &str, rest: &str) -> String {
    format!(
        r#"
name = "Block"
stop_time = 1.0
step = 0.1
[body.block]
kind = "solid"
shape = {{ {shape} }}
material = {{ model = "thermoelastic", density = 2.0, specific_heat = 3.0, conductivity = 5.0, young = 1000.0, poisson = 0.3, expansion = 1e-3 }}
initial_temperature = 300.0
heat = "sph"
sph = {{ {sph} }}
mesh = {{ {mesh} }}
[body.block.faces]
{faces}
{rest}
"#
    )
}

fn probes(gives: &str) -> String {
    let probe = |(i, at): (usize, &[f64; 3])| {
        format!("[[probe]]\nname = \"p{i}\"\nin = \"block\"\nat = {at:?}\ngives = [{gives}]\n")
    };
    POINTS.iter().enumerate().map(probe).collect()
}

const BOX: &str = "box = [2.0, 1.5, 0.5]";
const EQUAL: &str = "spacing = 0.15, growth = 1.0";
const GRADED: &str = "spacing = 0.15, depth_spacing = 0.04, growth = 1.3";
const MIXED: &str = "left = { temperature = 320.0 }\nright = { convection = { coefficient = 8.0, ambient = 280.0 } }\nfront = { temperature = 305.0 }\nbottom = { flux = 30.0 }";
const SPOT: &str = r#"
[[load]]
name = "spot"
on = "block.top"
footprint = { gaussian = { radius = 0.2 } }
carries = ["heat_flux"]
start = { heat_flux = 4000.0, x = 0.3, y = -0.2 }
"#;
const POINTS: [[f64; 3]; 3] = [[0.31, -0.22, -0.11], [-0.9, 0.7, -0.5], [1.0, 0.75, 0.0]];

#[test]
fn heat_balances_to_rounding_at_equal_distances_whatever_the_operator() {
    for operator in ["corrected", "plain"] {
        let sph = format!("operator = \"{operator}\"");
        let mut trial = Trial::new(&block(BOX, EQUAL, &sph, MIXED, SPOT));
        for (i, dt) in [1e-6, 0.3, 1e-3, 7.0, 0.02].into_iter().enumerate() {
            trial.set("block.left.temperature", 320.0 - 10.0 * i as f64);
            trial.set("block.right.ambient", 270.0 + 20.0 * i as f64);
            trial.set("spot.x", 0.3 - 0.1 * i as f64);
            trial.step(dt);
            let residual = trial.heat_residual("block");
            assert!(residual < 1e-9, "{operator}, step {i}: {residual}");
            let drift = trial.get("block.heat_drift").abs() / trial.get("block.heat_in").abs();
            assert!(drift < 1e-8, "{operator}, step {i}: {drift}");
        }
    }
}

#[test]
fn a_graded_mesh_says_by_how_much_the_balance_fails() {
    let mut trial = Trial::new(&block(BOX, GRADED, "", MIXED, SPOT));
    trial.step(0.1);
    let [drift, stored, heat_in, lost] = ["heat_drift", "heat_stored", "heat_in", "heat_lost"]
        .map(|key| trial.get(&format!("block.{key}")));
    assert_eq!(drift, stored - (heat_in - lost));
    let share = (drift / heat_in).abs();
    assert!(share > 1e-6 && share < 0.1, "{share}");
    assert_eq!(trial.get("block.fallback_particles"), 0.0);
}

#[test]
fn a_support_of_next_neighbours_falls_back_and_says_so() {
    let mut trial = Trial::new(&block(BOX, EQUAL, "support = 1.2", "", SPOT));
    // A quarter of the box: 8 × 6 × 5 nodes.
    assert_eq!(trial.get("block.fallback_particles"), 240.0);
    let told = trial.model.notes().iter().any(|note| note.contains("240 of 240 particles"));
    assert!(told, "{:?}", trial.model.notes());
}

#[test]
fn half_models_give_what_the_whole_gives_for_any_load() {
    let rest = format!("{SPOT}{}", probes("\"temperature\", \"stress\""));
    let faces = "sides = { clamped = true, convection = { coefficient = 8.0, ambient = 280.0 } }\nbottom = { temperature = 290.0 }";
    let text = block(BOX, "spacing = 0.25, growth = 1.0", "", faces, &rest);
    let mut halves = Trial::new(&text);
    let mut whole = Trial::new(&text.replace("mesh = {", "symmetry = \"none\"\nmesh = {"));
    for trial in [&mut halves, &mut whole] {
        trial.step(0.05);
    }
    for (i, name) in (0..3).flat_map(|i| ["temperature", "stress_xx"].map(|name| (i, name))) {
        let name = format!("p{i}.{name}");
        let (a, b) = (halves.get(&name), whole.get(&name));
        assert!((a - b).abs() < 1e-9 * b.abs(), "{name}: {a} {b}");
    }
}

#[test]
fn results_are_the_same_to_the_bit_on_any_number_of_threads() {
    let rest = format!("{SPOT}{}", probes("\"temperature\", \"stress\""));
    let text = block(BOX, GRADED, "", "bottom = { clamped = true, temperature = 310.0 }", &rest);
    let run = |threads| {
        let mut trial = Trial::on_threads(&text, threads);
        trial.step(0.05);
        trial.step(0.01);
        (trial.state.clone(), trial.get("p0.stress_xy"), trial.get("p1.temperature"))
    };
    let one = run(1);
    assert!(one == run(2) && one == run(5));
}

#[test]
fn the_temperature_of_particles_makes_the_stress_of_finite_elements() {
    // Rollers all round and uniform heating: σ = −E α ΔT/(1 − 2ν) in every direction.
    let faces = "sides = { roller = true }\nbottom = { roller = true }\ntop = { roller = true, temperature = 310.0 }";
    for mesh in [EQUAL, GRADED] {
        let mut trial = Trial::new(&block(BOX, mesh, "", faces, &probes("\"stress\"")));
        trial.step(20.0);
        for (i, component) in (0..3).flat_map(|i| ["xx", "yy", "zz"].map(|c| (i, c))) {
            let value = trial.get(&format!("p{i}.stress_{component}"));
            assert!(off(value, -1000.0 * 1e-3 * 10.0 / 0.4) < 1e-7, "{component}: {value}");
        }
    }
}

#[test]
fn a_probe_follows_a_prescribed_temperature_at_once() {
    let mut trial = Trial::new(&block(
        BOX,
        EQUAL,
        "",
        "top = { temperature = 300.0 }",
        &probes("\"temperature\""),
    ));
    trial.step(0.1);
    trial.set("block.top.temperature", 333.0);
    assert_eq!(trial.get("p2.temperature"), 333.0);
    assert_eq!(trial.get("block.heat_stored"), 0.0);
}

#[test]
fn steps_of_any_length_give_the_same() {
    let text = block(BOX, GRADED, "", MIXED, &format!("{SPOT}{}", probes("\"temperature\"")));
    let run = |steps: &[f64]| {
        let mut trial = Trial::new(&text);
        steps.iter().for_each(|&dt| trial.step(dt));
        trial.get("p0.temperature") - 300.0
    };
    let once = run(&[0.5]);
    let often = run(&[1e-4, 0.1, 0.0499, 0.25, 0.1]);
    assert!(off(often, once) < 1e-9, "{once} {often}");
}

#[test]
fn a_state_goes_on_where_it_was_saved_and_only_with_the_same_method() {
    let text = block(BOX, EQUAL, "", MIXED, SPOT);
    let mut trial = Trial::new(&text);
    trial.step(0.1);
    let saved = trial.state.clone();
    trial.step(0.2);
    let after = trial.state.clone();
    let mut other = Trial::new(&text);
    other.model.check_state(&saved).unwrap();
    other.restart(&saved);
    other.step(0.2);
    assert_eq!(other.state, after);
    let elements = Trial::new(&text.replace("heat = \"sph\"\nsph = {  }\n", ""));
    let error = elements.model.check_state(&saved).unwrap_err().to_string();
    assert!(error.contains("unknowns of block"), "{error}");
}

#[test]
fn a_disc_flux_on_a_box_and_on_a_disc_converges_to_the_closed_form() {
    let body = Conductor { conductivity: 5.0, heat_capacity: 6.0 };
    let exact = DiscFlux { body, flux: 1e3, radius: 0.1 };
    let spot = r#"
[[load]]
name = "spot"
on = "block.top"
footprint = { disc = { radius = 0.1 } }
carries = ["heat_flux"]
start = { heat_flux = 1e3 }
[[probe]]
name = "centre"
in = "block"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"#;
    for shape in ["box = [1.0, 1.0, 0.5]", "disc = { radius = 0.5, thickness = 0.5 }"] {
        let error = |spacing: f64| {
            let growth = 1.0 + 6.0 * spacing;
            let mesh = format!("spacing = {spacing}, growth = {growth}");
            let mut trial = Trial::new(&block(shape, &mesh, "", "", spot));
            trial.step(4e-3);
            (trial.get("centre.temperature") - 300.0) / exact.rise_on_axis(0.0, 4e-3) - 1.0
        };
        let [coarse, fine] = [0.04, 0.02].map(error);
        assert!(coarse.abs() < 0.05 && fine.abs() < 0.5 * coarse.abs(), "{shape}: {coarse} {fine}");
    }
}

#[test]
fn particles_that_are_not_to_be_trusted_warn() {
    let spot = SPOT.replace(", x = 0.3, y = -0.2", "");
    let warned = |growth: f64, sph: &str| {
        let mesh = format!("spacing = 0.02, depth_spacing = 0.01, growth = {growth:?}");
        let shape = "disc = { radius = 1.0, thickness = 1.0 }";
        let mut trial = Trial::new(&block(shape, &mesh, sph, "", &spot));
        trial.step(0.1);
        let found = trial.model.warnings(&trial.state);
        found.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(warned(1.1, ""), [""; 0]);
    let few = warned(1.0, "support = 1.2");
    let says = |found: &[String], what: &str| found.iter().any(|warning| warning.contains(what));
    assert!(says(&few, "too few neighbours") && says(&few, "`sph.support` of 2"), "{few:?}");
    let steep = warned(2.0, "support = 2.0");
    assert!(says(&steep, "made or lost") && says(&steep, "`mesh.growth` nearer 1"), "{steep:?}");
}

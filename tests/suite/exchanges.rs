//! Exchanges between solids in contact: how many there are, and what they agree with.

use crate::common::{Trial, off};
use impinge::model::forecast;
use impinge::scene::parse;

const COPPER: &str = "density = 8960.0, specific_heat = 385.0, conductivity = 400.0";
const GLASS: &str = "density = 2500.0, specific_heat = 840.0, conductivity = 1.0";
const GRADED: &str = "density = 3000.0, specific_heat = { temperature = [300.0, 900.0], value = [400.0, 1600.0] }, \
                      conductivity = { temperature = [300.0, 900.0], value = [5.0, 25.0] }";

const LOWER: f64 = 4e-3;
const UPPER: f64 = 2e-3;
const CONDUCTANCE: f64 = 2e3;

fn material(constants: &str) -> String {
    format!("{{ model = \"thermoelastic\", {constants} }}")
}

fn head(step: f64) -> String {
    format!("name = \"Pair\"\nstop_time = {:e}\nstep = {step:e}\n", 10.0 * step)
}

fn probe(name: &str, body: &str, z: f64) -> String {
    format!(
        "[[probe]]\nname = \"{name}\"\nin = \"{body}\"\nat = [0.0, 0.0, {z:?}]\ngives = [\"temperature\"]\n"
    )
}

/// Two bodies of 300 K, of the same face; `shape` makes one of a thickness.
fn pair(
    shape: &dyn Fn(f64) -> String,
    [lower, upper]: [&str; 2],
    [bottom, top]: [&str; 2],
    step: f64,
) -> String {
    let body = |name: &str, thickness: f64, constants: &str, faces: &str| {
        format!(
            "[body.{name}]\nkind = \"solid\"\nshape = {}\ninitial_temperature = 300.0\nmaterial = {}\n\
             [body.{name}.faces]\n{faces}\n",
            shape(thickness),
            material(constants)
        )
    };
    format!(
        "{}{}{}[[coupling]]\nfrom = \"lower.top\"\nto = \"upper.bottom\"\nconductance = {CONDUCTANCE:?}\n{}{}{}",
        head(step),
        body("lower", LOWER, lower, &format!("bottom = {bottom}")),
        body("upper", UPPER, upper, &format!("top = {top}")),
        probe("top", "upper", 0.0),
        probe("over", "upper", -UPPER),
        probe("under", "lower", 0.0),
    )
}

/// The same as layers of one body; probes at the contact stand on either side of it.
fn layers(
    shape: &dyn Fn(f64) -> String,
    [lower, upper]: [&str; 2],
    [bottom, top]: [&str; 2],
    step: f64,
) -> String {
    let probe =
        |name: &str, z: f64, side: &str| format!("{}side = \"{side}\"\n", probe(name, "stack", z));
    format!(
        "{}[body.stack]\nkind = \"solid\"\nshape = {}\ninitial_temperature = 300.0\nlayers = [ \
         {{ material = {}, thickness = {UPPER:?} }}, {{ material = {}, thickness = {LOWER:?}, contact_resistance = {:?} }} ]\n\
         [body.stack.faces]\nbottom = {bottom}\ntop = {top}\n{}{}{}",
        head(step),
        shape(UPPER + LOWER),
        material(upper),
        material(lower),
        1.0 / CONDUCTANCE,
        self::probe("top", "stack", 0.0),
        probe("over", -UPPER, "above"),
        probe("under", -UPPER, "below"),
    )
}

fn square(thickness: f64) -> String {
    format!("{{ box = [0.01, 0.01, {thickness:?}] }}")
}

fn disc(thickness: f64) -> String {
    format!("{{ disc = {{ radius = 0.01, thickness = {thickness:?} }} }}")
}

const HELD: &str = "{ temperature = 300.0 }";
const HEATED: &str = "{ flux = 5e4 }";
const BLOWN: &str = "{ convection = { coefficient = 200.0, ambient = 300.0 } }";
const HOT: &str = "{ convection = { coefficient = 500.0, ambient = 600.0 } }";
const GLOWING: &str = "{ radiation = { emissivity = 0.9, ambient = 1500.0 } }";

const PROBES: [&str; 3] = ["top.temperature", "over.temperature", "under.temperature"];

/// Heat balances in both bodies, and what leaves the one enters the other.
fn assert_balanced(trial: &mut Trial) {
    let mut read = |key: &str| ["lower", "upper"].map(|body| trial.get(&format!("{body}.{key}")));
    let [given, stored, lost] = ["heat_in", "heat_stored", "heat_lost"].map(&mut read);
    let scale = [given, stored, lost].as_flattened().iter().fold(0.0_f64, |m, q| m.max(q.abs()));
    for body in [0, 1] {
        let off = given[body] - stored[body] - lost[body];
        assert!(off.abs() <= 1e-9 * scale, "{given:?} {stored:?} {lost:?}");
    }
}

#[test]
fn solids_in_contact_agree_with_layers_in_steps_of_any_length() {
    // The slowest change takes some 10 s, the fastest 10 ms.
    for materials in [[COPPER, GLASS], [GLASS, COPPER], [GRADED, GLASS], [GRADED, GRADED]] {
        for faces in [[BLOWN, HEATED], [HELD, HOT], [BLOWN, GLOWING]] {
            // Steps of nonlinear heat have a tolerance of 0.1 K, and its elements are linear.
            let is_linear = faces[1] != GLOWING && !materials.contains(&GRADED);
            let [relative, absolute] = if is_linear { [3e-3, 0.0] } else { [1.5e-2, 0.1] };
            let steps = [1e-2, 10.0, 1e5, 0.3, 1e3];
            for &step in if is_linear { &steps[..] } else { &steps[..3] } {
                let mut both = Trial::new(&pair(&square, materials, faces, step));
                let mut one = Trial::new(&layers(&square, materials, faces, step));
                for _ in 0..4 {
                    both.step(step);
                    one.step(step);
                    let [found, wanted] =
                        [&mut both, &mut one].map(|trial| PROBES.map(|name| trial.get(name)));
                    let spread = wanted.iter().fold(0.0_f64, |m, t| m.max((t - 300.0).abs()));
                    for (found, wanted) in found.iter().zip(wanted) {
                        let off = (found - wanted).abs();
                        assert!(
                            off < relative * spread + absolute,
                            "{materials:?} {faces:?} {step}: {found} {wanted}"
                        );
                    }
                    assert_balanced(&mut both);
                }
            }
        }
    }
}

#[test]
fn steady_fluxes_need_hardly_any_exchanges() {
    for materials in [[COPPER, GLASS], [GRADED, GRADED]] {
        for faces in [[HELD, HOT], [BLOWN, GLOWING]] {
            let mut trial = Trial::new(&pair(&disc, materials, faces, 1e4));
            let counts: Vec<u64> = (0..5).map(|_| trial.exchanges_of_step(1e4)).collect();
            // The first step has a transient of ten parts, each with some iterations.
            assert!(counts[0] < 200, "{materials:?} {faces:?}: {counts:?}");
            let is_rare = counts[1..].iter().all(|&count| count <= 12);
            assert!(is_rare, "{materials:?} {faces:?}: {counts:?}");
        }
    }
}

#[test]
fn bodies_that_touch_over_whole_faces_are_columns() {
    let nodes = |text: &str| -> Vec<[usize; 3]> {
        let scene = parse(text, "scene").unwrap();
        forecast(&scene).bodies.iter().map(|body| body.nodes).collect()
    };
    let faces = [HELD, HEATED];
    for shape in [&square as &dyn Fn(f64) -> String, &disc] {
        for nodes in nodes(&pair(shape, [GRADED, GLASS], faces, 1.0)) {
            assert!(nodes[0] <= 3 && nodes[1] <= 3, "{nodes:?}");
        }
    }
    let whole = pair(&square, [COPPER, GLASS], faces, 1.0);
    let smaller = whole.replacen("0.01, 0.01,", "0.01, 0.009,", 1);
    let held = whole.replacen("top = {", "sides = { temperature = 300.0 }\ntop = {", 1);
    let spot = format!(
        "{whole}[[load]]\nname = \"spot\"\non = \"upper.top\"\nfootprint = {{ disc = {{ radius = 1e-3 }} }}\n\
         carries = [\"heat_flux\"]\n"
    );
    for text in [smaller, held, spot] {
        for nodes in nodes(&text) {
            assert!(nodes[0] > 3 && nodes[1] > 3, "{nodes:?} {text}");
        }
    }
}

#[test]
fn columns_in_contact_have_the_temperatures_of_fine_meshes() {
    let text = pair(&square, [COPPER, GLASS], [BLOWN, HEATED], 0.5);
    let fine = text
        .replace("material = {", "mesh = { spacing = 1e-3, depth_spacing = 1e-4 }\nmaterial = {");
    let [mut column, mut fine] = [text, fine].map(|text| Trial::new(&text));
    for _ in 0..4 {
        column.step(0.5);
        fine.step(0.5);
        for name in PROBES {
            let [found, wanted] = [&mut column, &mut fine].map(|trial| trial.get(name) - 300.0);
            assert!(off(found, wanted) < 2e-3, "{name}: {found} {wanted}");
        }
    }
}

#[test]
fn forecasts_count_exchanges() {
    for materials in [[COPPER, GLASS], [GRADED, GRADED]] {
        for faces in [[HELD, HOT], [BLOWN, GLOWING]] {
            for step in [0.3, 10.0, 1e3, 1e5] {
                let text = pair(&disc, materials, faces, step);
                let said = forecast(&parse(&text, "scene").unwrap()).exchanges.trials;
                let mut trial = Trial::new(&text);
                let count: u64 = (0..10).map(|_| trial.exchanges_of_step(step)).sum();
                let ratio = count as f64 / said;
                assert!(
                    (0.3..3.0).contains(&ratio),
                    "{materials:?} {faces:?} {step}: {count} {said}"
                );
            }
        }
    }
}

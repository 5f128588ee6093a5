//! Quadratic elements of solids of large strain: bends with one across, round shapes, rubber that keeps its volume.

use std::f64::consts::PI;

use impinge::scene::parse;

use crate::common::{Trial, off};
use crate::driven_solids::{probe, rubber};

/// A strip that is clamped on the left, of one element across, by a key of its mesh.
fn strip(keys: &str) -> String {
    let faces = "faces = { left = { clamped = true }, right = { traction = [0.0, 0.0, 0.0] } }";
    rubber(&format!("shape = {{ box = [0.1, 0.01, 0.01] }}\ndimension = 2\n{faces}\n{keys}"))
}

/// Under a small load the end sinks as that of a beam in plane strain: Timoshenko and Goodier (1970), §21.
#[test]
fn one_element_across_bends_as_a_beam() {
    let (length, height, load, poisson) = (0.1, 0.01, 1.0, 0.4);
    let end = probe("end", [0.5 * length, 0.0, -0.5 * height], "\"displacement\"");
    let plane = 1e6 / (1.0 - poisson * poisson);
    let bent = 4.0 * load * length.powi(3) / (plane * height * height);
    let sheared = 6.0 / 5.0 * load * length / (1e6 / (2.0 * (1.0 + poisson)));
    let sunk = |mesh: &str| {
        let mut trial = Trial::new(&(strip(mesh) + &end));
        trial.set("pad.right.traction_z", load);
        trial.step(1.0);
        trial.get("end.displacement_z") / (bent + sheared) - 1.0
    };
    let [linear, quadratic] =
        ["mesh = { spacing = 5e-3 }", "mesh = { spacing = 5e-3, order = 2 }"].map(sunk);
    assert!(linear.abs() > 0.05, "{linear}");
    assert!(quadratic.abs() < 0.01, "{quadratic}");
}

/// A ball has its volume, and a disc bears a pressure at its rim evenly.
#[test]
fn round_shapes_are_round() {
    let ball = |mesh: &str| {
        let shape =
            "shape = { ball = { radius = 5e-3 } }\ninertia = true\nstart = { height = 1e-3 }";
        Trial::new(&rubber(&format!("{shape}\nmesh = {{ {mesh} }}"))).get("pad.mass")
    };
    let mass = 1000.0 * 4.0 / 3.0 * PI * 5e-3_f64.powi(3);
    let [linear, quadratic] =
        ["spacing = 1e-3", "spacing = 1e-3, order = 2"].map(|mesh| off(ball(mesh), mass));
    assert!(linear > 1e-2 && quadratic < 1.5e-3, "{linear} {quadratic}");
    let faces = "faces = { sides = { pressure = 0.0 }, bottom = { roller = true } }";
    let shape = "shape = { disc = { radius = 5e-3, thickness = 4e-3 } }";
    for symmetry in ["axisymmetric", "quarter"] {
        let mesh = "mesh = { spacing = 1e-3, order = 2 }";
        let at = probe("inside", [2e-3, 1e-3, -1e-3], "\"stress\"");
        let text = rubber(&format!("{shape}\nsymmetry = \"{symmetry}\"\n{mesh}\n{faces}"));
        let mut trial = Trial::new(&(text + &at));
        trial.set("pad.sides.pressure", 100.0);
        trial.step(1.0);
        for (name, wanted) in [("xx", -100.0), ("yy", -100.0), ("zz", 0.0), ("xy", 0.0)] {
            let found = trial.get(&format!("inside.stress_{name}"));
            assert!((found - wanted).abs() < 0.1, "{symmetry} {name}: {found}");
        }
    }
}

/// The stress between plates is smooth where the volume hardly changes: probes of both orders agree as meshes get fine,
/// those of quadratic elements at once.
#[test]
fn nearly_incompressible_rubber_has_a_smooth_pressure() {
    let faces = "faces = { bottom = { clamped = true }, top = { displacement = [0.0, 0.0, 0.0] } }";
    let at = probe("inside", [1e-3, 0.0, -2e-3], "\"stress\"");
    let pressed = |mesh: &str| {
        let keys = "shape = { box = [12e-3, 1.0, 4e-3] }\ndimension = 2";
        let text = rubber(&format!("{keys}\n{faces}\nmesh = {{ {mesh} }}"));
        let mut trial = Trial::new(&(text.replace("poisson = 0.4", "poisson = 0.4999") + &at));
        trial.set("pad.top.displacement_z", -0.2e-3);
        trial.step(1.0);
        trial.get("inside.stress_zz")
    };
    let fine = pressed("spacing = 0.125e-3");
    let [linear, quadratic] =
        ["spacing = 1e-3", "spacing = 1e-3, order = 2"].map(|mesh| off(pressed(mesh), fine));
    assert!(linear > 0.05 && quadratic < 0.02, "{linear} {quadratic}");
}

/// What falls bounces with the momentum and the energy that it had, by time steps of both kinds.
#[test]
fn quadratic_elements_move() {
    let shape = "shape = { ball = { radius = 5e-3 } }\nmesh = { spacing = 1e-3, order = 2 }";
    let start = "inertia = true\nstart = { height = 1e-4, velocity = [0.0, 0.0, -0.5] }";
    let mut trial = Trial::new(&rubber(&format!("{shape}\n{start}")));
    let whole = trial.get("pad.kinetic") + trial.get("pad.stored");
    let mut pressed: f64 = 0.0;
    for _ in 0..40 {
        trial.step(1e-3);
        pressed = pressed.max(trial.get("pad.contact_force"));
    }
    assert!(pressed > 0.0);
    let left = trial.get("pad.kinetic") + trial.get("pad.stored");
    assert!(off(left, whole) < 1e-3, "{left} of {whole}");
    let faces = "faces = { left = { clamped = true }, right = { traction = [0.0, 0.0, 0.0] } }";
    let mesh = "mesh = { spacing = 5e-3, order = 2 }\ninertia = true\nmotion = \"implicit\"";
    let text =
        rubber(&format!("shape = {{ box = [0.1, 0.01, 0.01] }}\ndimension = 2\n{faces}\n{mesh}"));
    let mut trial = Trial::new(&text);
    trial.set("pad.right.traction_z", 20.0);
    for _ in 0..30 {
        trial.step(0.01);
    }
    let work = trial.get("pad.load_work");
    let all = trial.get("pad.kinetic") + trial.get("pad.stored");
    assert!(work > 0.0 && off(all, work) < 1e-6, "{all} of {work}");
}

/// A state is its own before the first step, too, whose energy is rounding.
#[test]
fn states_at_rest_are_taken_back() {
    let faces = "faces = { bottom = { clamped = true }, top = { traction = [0.0, 0.0, 0.0] } }";
    let shapes = [
        "shape = { box = [21.3e-3, 11.7e-3, 9.1e-3] }\nmesh = { spacing = 2.7e-3, order = 2 }",
        "shape = { disc = { radius = 5.3e-3, thickness = 3.7e-3 } }\nmesh = { spacing = 1e-3, order = 2 }",
    ];
    for shape in shapes {
        let trial = Trial::new(&rubber(&format!("{shape}\n{faces}")));
        trial.model.check_state(&trial.state).unwrap();
    }
}

#[test]
fn what_quadratic_elements_lack_is_refused() {
    let faces = "faces = { left = { clamped = true } }";
    for (keys, wanted) in [
        ("mechanics = \"rkpm\"", "only finite elements have functions of this order"),
        ("mechanics = \"sph\"", "only finite elements have functions of this order"),
        ("faces.right = { temperature = 300.0 }", "quadratic elements have a uniform temperature"),
    ] {
        let text =
            strip("mesh = { order = 2 }").replace(", right = { traction = [0.0, 0.0, 0.0] }", "");
        let text = text.replace(faces, "faces.left = { clamped = true }") + keys;
        let error = parse(&text, "scene.toml").unwrap_err().to_string();
        assert!(error.contains(wanted) && error.contains("mesh.order"), "{keys}: {error}");
    }
}

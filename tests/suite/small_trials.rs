//! Errors of solids of large strain by their meshes, as estimated from small inputs.

use impinge::model::tolerance::{BodyEstimate, estimates};
use impinge::scene::{Scene, parse};

use crate::common::Trial;
use crate::driven_solids::rubber;

fn scene(text: &str) -> Scene {
    parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn estimate(text: &str) -> BodyEstimate {
    let (_, found) = estimates(&scene(text));
    found.into_iter().next().unwrap()
}

/// A strip of 10 mm that a traction bends.
fn strip(keys: &str, spacing: f64) -> String {
    let faces = "faces = { left = { clamped = true }, right = { traction = [0.0, 0.0, 100.0] } }";
    rubber(&format!(
        "shape = {{ box = [0.1, 0.01, 0.01] }}\ndimension = 2\nmesh = {{ spacing = {spacing:e} }}\n{faces}\n{keys}"
    ))
}

/// Change of the height of a strip under its traction at the start.
fn rise(text: &str) -> f64 {
    let mut trial = Trial::new(text);
    trial.step(1.0);
    trial.get("pad.height") - 0.01
}

#[test]
fn estimates_are_as_large_as_errors() {
    for keys in ["", "mechanics = \"rkpm\"", "mechanics = \"sph\""] {
        let [coarse, middle, fine] =
            [2.5e-3, 1.25e-3, 0.625e-3].map(|spacing| rise(&strip(keys, spacing)));
        let limit = fine + (fine - middle) / 3.0;
        let error = (coarse / limit - 1.0).abs();
        let found = estimate(&strip(keys, 2.5e-3));
        let own = found.outputs.iter().find(|one| one.name == "pad.height").unwrap();
        let ratio = own.total() / error;
        assert!((0.5..2.5).contains(&ratio), "{keys}: {} for {error}", own.total());
    }
}

/// Of a strip that particles make too soft and linear elements too stiff, quadratic elements with nodes as far apart
/// have less than half the error.
#[test]
fn another_discretisation_with_a_smaller_error_is_named() {
    for (keys, remedy) in [
        ("mechanics = \"sph\"", "`mechanics = \"fem\"` and `mesh.order = 2` with the same"),
        ("", "note: `mesh.order = 2` with the same"),
    ] {
        let found = estimate(&strip(keys, 2.5e-3));
        assert!(found.worst().unwrap() > 0.01, "{:?}", found.outputs);
        let named = found.notes.iter().any(|note| format!("note: {note}").contains(remedy));
        assert!(named, "{:?}", found.notes);
    }
}

#[test]
fn what_moves_freely_has_no_estimate() {
    let ball = "shape = { ball = { radius = 5e-3 } }\ninertia = true\nstart = { height = 1e-3 }";
    let found = estimate(&rubber(ball));
    assert!(found.outputs.is_empty());
    assert_eq!(found.notes, ["no estimate: the body moves freely"]);
}

/// A force that is zero by symmetry has no error, and a strip that shrinks evenly none at all.
#[test]
fn forces_without_size_are_left_out() {
    let faces = "faces = { bottom = { roller = true }, left = { roller = true }, right = { roller = true, displacement = [0.0, 0.0, 0.0] } }";
    let text = rubber(&format!(
        "shape = {{ box = [0.02, 0.01, 0.01] }}\ndimension = 2\nmesh = {{ spacing = 2.5e-3 }}\n{faces}\nsymmetry = \"none\""
    ));
    let found = estimate(&text);
    assert!(found.outputs.iter().all(|one| one.total() < 1e-6), "{:?}", found.outputs);
}

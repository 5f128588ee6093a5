//! Solids of large strain whose shape is a strand along a path.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use crate::driven_solids::{probe, rubber};

/// A quarter of a ring, clamped at one end and loaded at the other, beside curved beams whose section is thin (energy of
/// bending, twisting, stretching and shear).
#[test]
fn strands_along_a_path_bend_and_twist() {
    let (bend, radius, load) = (10e-3, 1e-3, 5.0);
    let angle = |n: i32| PI / 2.0 * f64::from(n) / 24.0;
    let path: Vec<[f64; 3]> =
        (0..=24).map(|n| [bend * angle(n).sin(), bend * (1.0 - angle(n).cos()), 0.0]).collect();
    let shape = format!("shape = {{ strand = {{ path = {path:?}, radius = {radius:?} }} }}");
    let faces = "faces = { left = { clamped = true }, right = { traction = [0.0, 0.0, 0.0] } }";
    let mesh = "mesh = { spacing = 0.3e-3 }";
    let end = probe("end", [bend, bend, 0.0], "\"displacement\"");
    let mut trial = Trial::new(&format!("{}{end}", rubber(&format!("{shape}\n{faces}\n{mesh}"))));
    let [young, shear] = [1e6, 1e6 / 2.8];
    let area = PI * radius * radius;
    let second = 0.25 * area * radius * radius;
    let force = load * area;
    // Pulled out of its plane, bent about its radius, and along its end.
    let along = force * bend;
    let [axial, transverse] = [along / (young * area), along / (shear * area) * 7.0 / 6.0];
    let bending = along * bend * bend / (young * second);
    let twisting = along * bend * bend / (2.0 * shear * second);
    let expected = [
        PI / 4.0 * (bending + axial + transverse),
        (0.75 * PI - 2.0) * bending + PI / 4.0 * (axial + transverse),
        PI / 4.0 * bending + (0.75 * PI - 2.0) * twisting + PI / 2.0 * transverse,
    ];
    for (name, expected) in ["x", "y", "z"].into_iter().zip(expected) {
        for other in ["x", "y", "z"] {
            let own = if other == name { load } else { 0.0 };
            trial.set(&format!("pad.right.traction_{other}"), own);
        }
        trial.step(1.0);
        let found = trial.get(&format!("end.displacement_{name}"));
        assert!(off(found, expected) < 0.04, "{name} {found} of {expected}");
    }
}

//! Steps of metals of large strain: they find their equilibrium at once, whether the metal yields on or unloads.

use crate::common::{Trial, off};
use crate::driven_solids::probe;

/// A body of metal with its keys, and constants of its law.
pub fn metal(keys: &str, constants: &str) -> String {
    format!(
        r#"
name = "Metal"
stop_time = 20.0
step = 1.0
[body.pad]
kind = "solid"
strain = "finite"
initial_temperature = 293.15
material = {{ model = "elastoplastic", density = 8000.0, specific_heat = 400.0, conductivity = 20.0, {constants} }}
{keys}
"#
    )
}

/// Steps of fifty times the yield strain, in a metal that hardly hardens and is nearly incompressible: none is cut,
/// although rounding decides at the beginning of each step which points are beyond their yield surfaces.
#[test]
fn steps_far_beyond_the_yield_strain_are_not_cut() {
    let keys = "shape = { disc = { radius = 3e-3, thickness = 10e-3 } }\nmesh = { spacing = 1.5e-3 }\n\
                faces = { top = { roller = true, displacement = [0.0, 0.0, 0.0] }, bottom = { roller = true } }";
    let soft = "young = 11e9, poisson = 0.46, yield_stress = 2e6, hardening = { saturation = 2.6e6, rate = 20.0 }";
    for hardening in ["", ", kinematic_hardening = 1e7", ", isotropic_hardening = 1e7"] {
        let mut trial = Trial::new(&metal(keys, &format!("{soft}{hardening}")));
        let ways = (1..=6).chain((-2..6).rev()).map(f64::from);
        let mut count = 0.0;
        for way in ways {
            trial.set("pad.top.displacement_z", 1e-4 * way);
            trial.step(1.0);
            count += 1.0;
            // One to where the face has jumped, and one over the time of the step.
            assert_eq!(trial.get("pad.steps"), 2.0 * count, "{hardening}: {way}");
        }
        assert!(trial.get("pad.top.force_z") < -2e6 * 2.5e-5);
    }
}

/// A strip that was bent beyond its yield stress and is let go springs back as an elastic one would be bent.
#[test]
fn bent_strips_spring_back() {
    let (young, length, height) = (70e9, 50e-3, 2e-3);
    let keys = format!(
        "shape = {{ box = [{length:?}, 1.0, {height:?}] }}\ndimension = 2\nsection = \"plane_stress\"\n\
         mesh = {{ spacing = 0.25e-3 }}\nfaces = {{ left = {{ clamped = true }}, right = {{ traction = [0.0, 0.0, 0.0] }} }}"
    );
    let constants = "young = 70e9, poisson = 0.33, yield_stress = 100e6, isotropic_hardening = 1e9";
    let end = probe("end", [0.5 * length, 0.0, -0.5 * height], "\"displacement\"");
    let mut trial = Trial::new(&format!("{}{end}", metal(&keys, constants)));
    let first_yield = 100e6 * height / (6.0 * length);
    let mut bend = |load: f64| {
        trial.set("pad.right.traction_z", load * first_yield);
        trial.step(1.0);
        trial.get("end.displacement_z")
    };
    let elastic = 4.0 * first_yield * length.powi(3) / (young * height * height);
    let small = bend(0.5);
    assert!(off(small, 0.5 * elastic) < 0.01, "{small} {elastic}");
    [0.9, 1.1, 1.2].into_iter().for_each(|load| _ = bend(load));
    let bent = bend(1.3);
    bend(0.7);
    let left = bend(0.0);
    assert!(left > 0.02 * bent && left < 0.05 * bent, "{left} of {bent}");
    // The elastic deflection of 1.3 times the load, less what the strip is shortened by turning.
    assert!(off(bent - left, 2.6 * small) < 2e-3, "{} {}", bent - left, 2.6 * small);
}

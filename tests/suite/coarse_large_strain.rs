//! Warnings of solids of large strain whose discretisation is too coarse for what is asked.

use impinge::advice::parse_with_warnings;

use crate::driven_solids::{BLOCK, probe, rubber};

/// Slender bodies with one or two elements across are warned of: their deflection is wrong by a fifth or more, or by
/// some per cent. Stout ones, planes of finer meshes and other methods are not.
#[test]
fn meshes_too_coarse_to_bend_are_warned_of() {
    let told = |shape: &str, spacing: f64, keys: &str| {
        let keys = format!(
            "inertia = true\nshape = {{ {shape} }}\nmesh = {{ spacing = {spacing:?} }}\n{keys}"
        );
        let (_, found) = parse_with_warnings(&rubber(&keys), "scene.toml").unwrap();
        let own = found.iter().find(|warning| warning.finding().id == "bending_unresolved");
        own.map(ToString::to_string)
    };
    let beam = "box = [50e-3, 5e-3, 5e-3]";
    let one = told(beam, 5e-3, "").unwrap();
    assert!(one.contains("one element") && one.contains("0.00125 m"), "{one}");
    assert!(told(beam, 2.5e-3, "").unwrap().contains("two elements"));
    assert!(told("disc = { radius = 10e-3, thickness = 1e-3 }", 1e-3, "").is_some());
    assert_eq!(told(beam, 1.6e-3, ""), None);
    assert_eq!(told(beam, 5e-3, "mechanics = \"rkpm\""), None);
    assert_eq!(told("box = [50e-3, 1e-3, 20e-3]", 5e-3, "dimension = 2"), None);
    assert_eq!(told("box = [8e-3, 8e-3, 5e-3]", 5e-3, ""), None);
}

/// The pressure of kernels and particles swings from point to point where the volume hardly changes.
#[test]
fn stresses_of_kernels_of_incompressible_bodies_are_warned_of() {
    let told = |poisson: &str, keys: &str, gives: &str| {
        let keys = format!("inertia = true\n{BLOCK}\n{keys}\n{}", probe("p", [0.0; 3], gives));
        let text = rubber(&keys).replace("poisson = 0.4 ", &format!("poisson = {poisson} "));
        let (_, found) = parse_with_warnings(&text, "scene.toml").unwrap();
        found.iter().any(|warning| warning.finding().id == "pressure_is_spurious")
    };
    let stress = "\"stress\"";
    for keys in ["rkpm", "efg", "sph"].map(|name| format!("mechanics = \"{name}\"")) {
        assert!(told("0.4999", &keys, stress), "{keys}");
        assert!(!told("0.4", &keys, stress), "{keys}");
        assert!(!told("0.4999", &keys, "\"displacement\""), "{keys}");
    }
    let gauss = "mechanics = \"rkpm\"\nrkpm = { integration = \"gauss\" }";
    assert!(!told("0.4999", "", stress) && !told("0.4999", gauss, stress));
}

//! The generated modelDescription.xml of FMI 3.0.

use impinge::fmi::three::xml::model_description;
use impinge::scene;

use crate::master::SCENE;
use crate::master::three::Unit;

fn xml() -> String {
    model_description(&scene::parse(SCENE, "scene.toml").unwrap(), SCENE)
}

/// Modes of heat take any step in one; particles, of heat or of droplets, do not.
#[test]
fn only_units_whose_steps_can_be_too_long_may_return_early() {
    let particles = SCENE.replacen("kind = \"solid\"", "kind = \"solid\"\nheat = \"sph\"", 1);
    for (scene, early, updates) in
        [(SCENE, false, false), (&particles, true, false), (crate::droplets::WALL, true, true)]
    {
        let parsed = scene::parse(scene, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        let xml = model_description(&parsed, scene);
        for (flag, wanted) in [
            ("mightReturnEarlyFromDoStep", early),
            ("providesIntermediateUpdate", updates),
            ("canReturnEarlyAfterIntermediateUpdate", updates),
        ] {
            assert!(xml.contains(&format!("{flag}=\"{wanted}\"")), "{flag}: {wanted}");
        }
    }
}

#[test]
fn every_variable_is_there_once_with_reference_and_dimensions() {
    let xml = xml();
    for (reference, variable) in Unit::instantiated().arrays.variables.iter().enumerate() {
        let start = format!(" name=\"{}\" valueReference=\"{reference}\" ", variable.name);
        let parts: Vec<&str> = xml.split(&start).collect();
        let [_, rest] = parts[..] else { panic!("not once: {start}") };
        let (attributes, behind) = rest.split_once('>').unwrap();
        let content = match attributes.ends_with('/') {
            true => "",
            false => behind.split_once("</").unwrap().0,
        };
        let counts: Vec<usize> = content
            .split("<Dimension start=\"")
            .skip(1)
            .map(|part| part.split_once('"').unwrap().0.parse().unwrap())
            .collect();
        assert_eq!(counts, variable.dimensions, "{}", variable.name);
        if let Some((_, values)) = attributes.split_once(" start=\"") {
            let count = values.split_once('"').unwrap().0.split(' ').count();
            assert_eq!(count, variable.size(), "{}", variable.name);
        }
    }
}

#[test]
fn outputs_name_the_arrays_that_they_follow_at_once() {
    let (xml, unit) = (xml(), Unit::instantiated());
    let inputs = |name: &str| {
        let start = format!("<Output valueReference=\"{}\" dependencies=\"", unit.reference(name));
        let rest = xml.split_once(&start).unwrap_or_else(|| panic!("no {start}")).1;
        let list = rest.split_once('"').unwrap().0.split_whitespace();
        list.map(|reference| reference.parse().unwrap()).collect::<Vec<u32>>()
    };
    assert!(inputs("surface.temperature").is_empty());
    let traction = inputs("surface.von_mises");
    assert!(traction.contains(&unit.reference("patch.pressure")), "{traction:?}");
    assert!(!traction.contains(&unit.reference("patch.heat_flux")), "{traction:?}");
}

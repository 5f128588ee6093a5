//! Inputs that nothing is connected to are tunable parameters.

use impinge::fmi::two::xml::model_description;
use impinge::scene;

use crate::master::{ERROR, OK, SCENE, Unit};

/// The scene with a spot that stays where it is put, above what flows by at a temperature that is set.
fn tunable() -> String {
    SCENE
        .replacen(
            "start = { heat_flux = 5e7 }",
            "start = { heat_flux = 5e7 }\nrole = \"parameter\"",
            1,
        )
        .replacen("ambient = 293.15 } }", "ambient = 293.15 }, role = \"parameter\" }", 1)
}

fn running(text: &str) -> Unit {
    let unit = Unit::of_scene(text);
    assert_eq!(unit.setup(0.0, None), OK);
    assert_eq!(unit.enter(), OK);
    assert_eq!(unit.exit(), OK);
    unit.messages.take();
    unit
}

const TUNABLE: [&str; 4] = ["spot.x", "spot.y", "spot.radius", "plate.bottom.ambient"];

#[test]
fn the_description_calls_them_tunable_and_no_output_follows_them() {
    let text = tunable();
    let parsed = scene::parse(&text, "scene.toml").unwrap();
    let xml = model_description(&parsed, &text);
    for name in TUNABLE {
        let (_, rest) = xml.split_once(&format!("name=\"{name}\"")).unwrap();
        let (attributes, _) = rest.split_once('>').unwrap();
        for words in ["causality=\"parameter\"", "variability=\"tunable\"", "initial=\"exact\""] {
            assert!(attributes.contains(words), "{name}: {attributes}");
        }
    }
    assert!(xml.contains("name=\"patch.x\""));
    assert_eq!(xml.matches("variability=\"tunable\"").count(), TUNABLE.len());
}

#[test]
fn they_act_between_steps_as_the_inputs_that_they_are() {
    let [own, plain] = [running(&tunable()), running(SCENE)];
    for unit in [&own, &plain] {
        assert_eq!(unit.step(0.0, 1e-8), OK);
        assert_eq!(unit.set("spot.x", 3e-5), OK);
        assert_eq!(unit.set("spot.radius", 5e-5), OK);
        assert_eq!(unit.set("plate.bottom.ambient", 400.0), OK);
        assert_eq!(unit.step(1e-8, 1e-8), OK);
    }
    assert_eq!(own.get("centre.temperature").to_bits(), plain.get("centre.temperature").to_bits());
    let saved = own.save();
    assert_eq!(own.set("spot.x", 0.0), OK);
    assert_eq!(own.restore(saved), OK);
    assert_eq!(own.get("spot.x"), 3e-5);
    let mut saved = saved;
    assert_eq!(own.free_state(&mut saved), OK);
}

#[test]
fn they_have_no_derivatives_and_keep_their_bounds() {
    let unit = running(&tunable());
    assert_eq!(unit.set_derivative("spot.x", 1, 1.0), ERROR);
    unit.expect_message(ERROR, &["fmi2SetRealInputDerivatives", "spot.x is no input"]);
    assert_eq!(unit.set("spot.radius", 1e-3), ERROR);
    unit.expect_message(ERROR, &["spot.radius"]);
    assert_eq!(unit.set("plate.conductivity", 12.0), ERROR);
    unit.expect_message(ERROR, &["plate.conductivity is a fixed parameter"]);
}

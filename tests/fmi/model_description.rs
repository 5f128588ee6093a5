//! The generated modelDescription.xml.

use std::fs;
use std::path::Path;

use impinge::fmi::three;
use impinge::fmi::two::xml::model_description;
use impinge::scene;
use impinge::variables::Registry;

use crate::master::{SCENE, own_guid, registry};

fn xml() -> String {
    model_description(&scene::parse(SCENE, "scene.toml").unwrap(), SCENE)
}

/// The description of each version, its last elements, and its name of the GUID.
fn both() -> [(String, [&'static str; 2], &'static str); 2] {
    let scene = scene::parse(SCENE, "scene.toml").unwrap();
    [
        (xml(), ["<Outputs>", "<InitialUnknowns>"], "guid"),
        (
            three::xml::model_description(&scene, SCENE),
            ["<Output ", "<InitialUnknown "],
            "instantiationToken",
        ),
    ]
}

/// The elements of the root in the order of the schema.
#[test]
fn elements_stand_in_the_order_of_the_schema() {
    for (xml, last, _) in both() {
        let first = [
            "<fmiModelDescription ",
            "<CoSimulation ",
            "<UnitDefinitions>",
            "<TypeDefinitions>",
            "<LogCategories>",
            "<DefaultExperiment ",
            "<ModelVariables>",
            "<ModelStructure>",
        ];
        let place = |element: &str| xml.find(element).unwrap_or_else(|| panic!("no {element}"));
        let places: Vec<usize> = first.into_iter().chain(last).map(place).collect();
        assert!(places.is_sorted(), "{places:?}");
    }
}

#[test]
fn texts_are_escaped_and_the_guid_is_the_units() {
    for (xml, _, guid) in both() {
        assert!(xml.contains("hot spot &amp; a 2 × 3 patch"));
        assert!(xml.contains(&format!("{guid}=\"{}\"", own_guid())));
    }
}

#[test]
fn every_variable_is_there_once_with_its_reference() {
    let xml = xml();
    for (reference, variable) in registry().variables.iter().enumerate() {
        let start =
            format!("<ScalarVariable name=\"{}\" valueReference=\"{reference}\" ", variable.name);
        assert_eq!(xml.matches(&start).count(), 1, "{start}");
    }
}

#[test]
fn outputs_name_the_inputs_that_they_follow_at_once() {
    let (xml, registry) = (xml(), registry());
    let index = |name: &str| registry.find(name).unwrap() + 1;
    let unknown = |name: &str| {
        let start = format!("<Unknown index=\"{}\" dependencies=\"", index(name));
        let rest = xml.split_once(&start).unwrap_or_else(|| panic!("no {start}")).1;
        rest.split_once('"').unwrap().0.to_owned()
    };
    assert_eq!(unknown("centre.temperature"), "");
    let traction = unknown("centre.stress_xx");
    let names: Vec<String> = traction.split(' ').map(str::to_owned).collect();
    assert!(names.contains(&index("spot.pressure").to_string()), "{traction}");
    assert!(!names.contains(&index("spot.heat_flux").to_string()), "{traction}");
}

/// The attributes of an output in ModelStructure.
fn unknown<'a>(xml: &'a str, registry: &Registry, name: &str) -> &'a str {
    let start = format!("<Unknown index=\"{}\"", registry.find(name).unwrap() + 1);
    let outputs = xml.split_once("<Outputs>").unwrap().1.split_once("</Outputs>").unwrap().0;
    let rest = outputs.split_once(&start).unwrap_or_else(|| panic!("no {name}")).1;
    rest.split_once("/>").unwrap().0
}

/// Two lists of dependencies may be left out: that of all inputs, because this is what it means, and
/// one of so many inputs and outputs that a tool would take long to read it.
#[test]
fn long_lists_of_dependencies_are_left_out() {
    let many = SCENE
        .replace("count = [2, 3]", "count = [100, 100]")
        .replace("grid = [4, 4]", "grid = [40, 40]");
    let scene = scene::parse(&many, "scene.toml").unwrap();
    let (xml, registry) = (model_description(&scene, &many), Registry::of(&scene));
    assert!(registry.variables.len() > 23_000);
    assert!(xml.len() < 8_000_000, "{} bytes", xml.len());
    assert_eq!(unknown(&xml, &registry, "surface.von_mises[40,40]"), "");
    assert_eq!(unknown(&xml, &registry, "surface.temperature[1,1]"), " dependencies=\"\"");

    let pressed = SCENE
        .replace("[\"heat_flux\", \"pressure\", \"shear\"]", "[\"pressure\"]")
        .replace("start = { heat_flux = 5e7 }", "")
        .replace("[\"heat_flux\", \"pressure\"]", "[\"pressure\"]")
        .replace("bottom = { convection = { coefficient = 50.0, ambient = 293.15 } }", "");
    let scene = scene::parse(&pressed, "scene.toml").unwrap();
    let (xml, registry) = (model_description(&scene, &pressed), Registry::of(&scene));
    assert_eq!(unknown(&xml, &registry, "surface.von_mises[4,4]"), "");
    assert_eq!(unknown(&xml, &registry, "plate.heat_in"), " dependencies=\"\"");
}

#[test]
fn what_a_droplet_gives_follows_no_input_at_once() {
    let text = include_str!("../../examples/droplet_unit/scene.toml");
    let xml = model_description(&scene::parse(text, "scene.toml").unwrap(), text);
    let outputs = xml.split_once("<Outputs>").unwrap().1.split_once("</Outputs>").unwrap().0;
    let count = outputs.matches("<Unknown ").count();
    assert!(count > 100, "{count}");
    assert_eq!(outputs.matches("dependencies=\"\"").count(), count);
    for name in ["wall.temperature[30]", "wall.shear_r[1]", "drop.sound_speed", "drop.force"] {
        assert!(xml.contains(&format!("<ScalarVariable name=\"{name}\" ")), "no {name}");
    }
    for unit in ["N", "W", "Pa.s", "N/m", "m/s", "kg", "kg.m/s"] {
        assert!(xml.contains(&format!("<Unit name=\"{unit}\">")), "no {unit}");
    }
}

/// The copies under modelDescription are what `build-fmu SCENE --xml FILE` writes now.
#[test]
fn checked_in_copies_of_the_examples_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Ok(folders) = fs::read_dir(root.join("examples")) else { return };
    let scenes: Vec<_> = folders
        .map(|folder| folder.unwrap().path().join("scene.toml"))
        .filter(|path| path.exists())
        .collect();
    assert!(!scenes.is_empty(), "examples holds no scene");
    for path in scenes {
        let file = path.display().to_string();
        let text = scene::text_of(&path, &file).unwrap();
        let scene = scene::parse(&text, &file).unwrap();
        let copy = root.join("modelDescription").join(format!("{}.xml", scene.name));
        let found = fs::read_to_string(&copy).unwrap_or_default();
        let remedy = format!("build-fmu {} --xml {}", path.display(), copy.display());
        assert!(found == model_description(&scene, &text), "out of date; run: {remedy}");
    }
}

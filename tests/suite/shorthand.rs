//! Numbers with units and names of substances in scenes: each gives what its numbers and tables give, to the bit, and
//! what cannot be meant is refused at its place.

use std::collections::BTreeMap;

use impinge::advice::parse_with_warnings;
use impinge::limits::number;
use impinge::scene::{Scene, parse};
use impinge::substances::Kind;

const PLATE: &str = include_str!("../scenes/plate.toml");
const IMPACT: &str = include_str!("../scenes/impact.toml");

fn read(text: &str) -> Scene {
    parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The text with a part replaced, which must be in it.
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

/// The scene without the names of its substances.
fn anonymous(text: &str) -> Scene {
    Scene { substances: Vec::new(), in_degrees: BTreeMap::new(), ..read(text) }
}

fn refusal(text: &str) -> String {
    parse(text, "scene.toml").unwrap_err().to_string()
}

#[test]
fn numbers_with_units_read_as_their_si_values() {
    let pairs = [
        ("box = [2e-3, 2e-3, 0.26e-3]", "box = [\"2 mm\", \"2 mm\", \"260 µm\"]"),
        ("density = 3950.0", "density = \"3.95 g/cm³\""),
        ("conductivity = 10.0", "conductivity = \"10 W/(m K)\""),
        ("young = 300e9", "young = \"300 GPa\""),
        ("expansion = 8.1e-6", "expansion = \"8.1 ppm/K\""),
        ("bottom = { temperature = 293.15 }", "bottom = { temperature = \"20 °C\" }"),
        ("initial_temperature = 293.15", "initial_temperature = \"20 °C\""),
        ("heat_flux = 5e7", "heat_flux = \"50 W/mm²\""),
        ("at = [0.0, 0.0, 0.0]", "at = [\"0 mm\", 0, 0.0]"),
        ("stop_time = 3.5e-6", "stop_time = \"3.5 µs\""),
        ("step = 1e-8", "step = \"10 ns\""),
        ("size = [4e-4, 4e-4]", "size = [\"0.4 mm\", 4e-4]"),
        ("tolerance = 1e-3", "tolerance = \"0.1 %\""),
    ];
    let text = pairs.iter().fold(PLATE.to_owned(), |text, (from, to)| with(&text, from, to));
    assert_eq!(anonymous(&text), read(PLATE));
    assert_eq!(parse_with_warnings(&text, "scene.toml").unwrap().1, Vec::new());

    let table = "conductivity = { temperature = [300.0, 373.15], value = [10.0, 9.0] }";
    let units = "conductivity = { temperature = [300, \"100 °C\"], value = [\"10 W/m/K\", \"0.009 W/mm/K\"] }";
    let [si, units] = [table, units].map(|to| anonymous(&with(PLATE, "conductivity = 10.0", to)));
    assert_eq!(si, units);
}

#[test]
fn quantities_of_droplets_read_as_their_si_values() {
    let pairs = [
        ("diameter = 1e-4", "diameter = \"0.1 mm\""),
        ("impact_velocity = 20.0", "impact_velocity = \"20 m/s\""),
        ("viscosity = 1e-3", "viscosity = \"1 mPa s\""),
        (
            "arrivals = [{ x = 2e-4, y = -1e-4 }]",
            "arrivals = [{ x = \"200 µm\", y = \"-0.1 mm\" }]",
        ),
        ("interval = 5e-8", "interval = \"50 ns\""),
    ];
    let text = pairs.iter().fold(IMPACT.to_owned(), |text, (from, to)| with(&text, from, to));
    assert_eq!(read(&text), read(IMPACT));
    let angle = |value: &str| {
        with(IMPACT, "spacing = 1e-5", &format!("spacing = 1e-5\nimpact_angle = {value}"))
    };
    assert_eq!(read(&angle("\"30°\"")), read(&angle(&30f64.to_radians().to_string())));
}

#[test]
fn misfits_are_refused_at_their_place_with_a_remedy() {
    let refuse = |from: &str, to: &str, place: &str, message: &str, allowed: &str| {
        let text = refusal(&with(PLATE, from, to));
        for part in [place, message, allowed] {
            assert!(text.contains(part), "{to}: no {part} in\n{text}");
        }
        assert_eq!(text.matches("allowed").count(), 1, "{text}");
    };
    let line = "scene.toml:9";
    refuse(
        "density = 3950.0",
        "density = \"3950 kg\"",
        line,
        "cannot be converted to kg/m³",
        "\"1 kg/m³\"",
    );
    refuse(
        "density = 3950.0",
        "density = \"3950\"",
        line,
        "this text has no unit",
        "a number in kg/m³",
    );
    refuse("density = 3950.0", "density = \"3,95 g/cm³\"", line, "a point, not a comma", "kg/m³");
    refuse(
        "density = 3950.0",
        "density = \"3.95 g/cc\"",
        line,
        "`cc` is not a known unit",
        "kg/m³",
    );
    refuse(
        "density = 3950.0",
        "density = \"-3950 kg/m³\"",
        line,
        "density must be positive",
        "> 0",
    );
    refuse("density = 3950.0", "density = \"heavy\"", line, "not a finite number", "kg/m³");
    let threads = "stop_time = 3.5e-6\nsolver = { threads = \"2 m\" }";
    refuse("stop_time = 3.5e-6", threads, "scene.toml:4", "whole number", "threads");
}

#[test]
fn celsius_belongs_to_temperatures_alone() {
    let creep = "model = \"viscoplastic\", creep = { coefficient = 1e-40, exponent = 5.0, activation_temperature = \"20 °C\" }";
    let text = refusal(&with(PLATE, "model = \"thermoelastic\"", creep));
    assert!(text.contains("is for temperatures"), "{text}");
}

#[test]
fn implausible_numbers_with_units_are_warned_of() {
    let text = with(PLATE, "initial_temperature = 293.15", "initial_temperature = \"90 K\"");
    let found = parse_with_warnings(&text, "scene.toml").unwrap().1;
    assert!(found.iter().any(|warning| warning.to_string().contains("363.15")), "{found:?}");
}

#[test]
fn substances_stand_for_their_tables() {
    let own = "material = { model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, \
               young = 300e9, poisson = 0.21, expansion = 8.1e-6 }";
    let sheet = Kind::Solid.find("copper").unwrap().sheet();
    let mut table = sheet.constants.clone();
    table.insert("model".to_owned(), "thermoelastic".into());
    let materials = toml::Table::from_iter([("copper".to_owned(), toml::Value::Table(table))]);
    let root = toml::Table::from_iter([("material".to_owned(), toml::Value::Table(materials))]);
    let written = toml::to_string(&root).unwrap();
    let named = format!("{}\n{written}", with(PLATE, own, "material = \"copper\""));
    let short = with(PLATE, own, "material = \"copper\"");
    assert_eq!(anonymous(&short), read(&named));

    // Keys replace constants, and `at` takes them at a temperature, where nothing melts.
    let at = "material = { substance = \"copper\", at = \"350 K\", young = \"100 GPa\" }";
    let wanted = "material = { model = \"thermoelastic\", density = 8933.0, specific_heat = 391.0, conductivity = 397.0, \
                  young = 100e9, poisson = 0.343, expansion = 1.65e-5 }";
    assert_eq!(anonymous(&with(PLATE, own, at)), read(&with(PLATE, own, wanted)));

    // Alone, a table of the scene goes before the library.
    let tin = "material = \"tin\"";
    let text = format!(
        "{}\n[material.tin]\nmodel = \"thermoelastic\"\ndensity = 1.0\nspecific_heat = 2.0\n\
                        conductivity = 3.0\nyoung = 1e9\npoisson = 0.3\nexpansion = 1e-6\n",
        with(PLATE, own, tin)
    );
    let scene = read(&text);
    assert_eq!(scene.material["tin"].heat.density, 1.0);
}

#[test]
fn fluids_are_taken_at_the_temperature_of_their_drops() {
    let own = "fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }";
    let fluid =
        |text: &str| read(&with(IMPACT, own, text)).droplets().next().unwrap().1.fluid.clone();
    let water = fluid("fluid = \"water\"");
    // IAPWS at 350 K and 1 atm: 973.7 kg/m³, 0.3688 mPa s, 0.0632 N/m.
    assert!((water.density - 973.7).abs() < 0.1, "{water:?}");
    assert!((water.viscosity.constant().unwrap() - 3.688e-4).abs() < 3e-6, "{water:?}");
    assert!((water.surface_tension - 0.0632).abs() < 1e-4, "{water:?}");
    let cold = fluid("fluid = { substance = \"water\", at = \"20 °C\", contact_angle = \"60°\" }");
    assert!((cold.density - 998.2).abs() < 0.5, "{cold:?}");
    assert!((cold.contact_angle - 60f64.to_radians()).abs() < 1e-15);
    assert_eq!(fluid("fluid = \"tin\""), fluid("fluid = \"molten-tin\""));
}

#[test]
fn unknown_substances_are_refused_with_a_suggestion() {
    let own = "fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }";
    let text = refusal(&with(IMPACT, own, "fluid = \"watter\""));
    assert!(text.contains("did you mean `water`?") && text.contains("scene.toml:10"), "{text}");
    let material = "material = { model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }";
    let text = refusal(&with(IMPACT, material, "material = \"coper\""));
    assert!(text.contains("did you mean `copper`?"), "{text}");
    let text = refusal(&with(IMPACT, material, "material = { substance = 3 }"));
    assert!(text.contains("not the name of a substance"), "{text}");
    let text = refusal(&with(IMPACT, material, "material = { substance = \"coper\" }"));
    assert!(text.contains("did you mean `copper`?"), "{text}");
    assert_eq!(text.matches("allowed").count(), 1, "{text}");
}

#[test]
fn temperatures_beyond_the_range_of_a_substance_are_warned_of() {
    let own = "fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }";
    let text = with(IMPACT, own, "fluid = \"acetone\"");
    let text = with(&text, "initial_temperature = 350.0", "initial_temperature = 345.0");
    let found = parse_with_warnings(&text, "scene.toml").unwrap().1;
    let [_, high] = Kind::Fluid.find("acetone").unwrap().sheet().valid;
    let wanted = format!("to {} K", number(high));
    assert!(found.iter().any(|warning| warning.to_string().contains(&wanted)), "{found:?}");

    // 20 is meant in °C.
    let text = with(IMPACT, own, "fluid = { substance = \"water\", at = 20 }");
    let found = parse_with_warnings(&text, "scene.toml").unwrap().1;
    assert!(found.iter().any(|warning| warning.to_string().contains("this is 20 K")), "{found:?}");
}

/// Every substance makes a scene whose values nothing is said about in the middle of its range.
#[test]
fn substances_raise_no_warning_within_their_range() {
    let plate = |name: &str, temperature: f64| {
        format!(
            "name = \"Plate\"\nstop_time = \"1 s\"\nstep = \"0.1 s\"\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [\"10 mm\", \"10 mm\", \"2 mm\"] }}\nmaterial = \"{name}\"\n\
             initial_temperature = {temperature}\n"
        )
    };
    let drop = |name: &str, temperature: f64| {
        format!(
            "name = \"Drop\"\nstop_time = \"2 ms\"\nstep = \"0.1 ms\"\n[body.drop]\nkind = \"droplet\"\n\
             diameter = \"1 mm\"\nimpact_velocity = \"0.3 m/s\"\nspacing = \"40 µm\"\nfluid = \"{name}\"\n\
             initial_temperature = {temperature}\n[[wall]]\nname = \"wall\"\nunder = \"drop\"\n\
             footprint = {{ tiles = {{ count = [8, 8], size = [\"4 mm\", \"4 mm\"] }} }}\n\
             start = {{ temperature = {temperature} }}\n"
        )
    };
    for (kind, scene) in
        [(Kind::Solid, &plate as &dyn Fn(&str, f64) -> String), (Kind::Fluid, &drop)]
    {
        for substance in kind.all() {
            let [low, high] = substance.sheet().valid;
            let mut text = scene(substance.name, 0.5 * (low + high));
            if high < 200.0 {
                text = format!("cryogenic = true\n{text}");
            }
            let (_, mut found) = parse_with_warnings(&text, "scene.toml")
                .unwrap_or_else(|error| panic!("{}: {error}", substance.name));
            // What a resolution is worth depends on the drop, not on the library.
            found.retain(|warning| !warning.subject().starts_with("body.drop.spacing"));
            assert!(found.is_empty(), "{}: {found:?}", substance.name);
        }
    }
}

/// A mean coefficient at one temperature is that from the temperature without stress on, whatever the reference of the
/// table.
#[test]
fn expansion_at_one_temperature_is_the_mean_from_the_temperature_without_stress() {
    let silicon = |free: f64, at: f64| {
        let material = format!("material = {{ substance = \"silicon\", at = {at:?} }}\n");
        let scene = format!(
            "name = \"Die\"\nstop_time = 1.0\nstep = 0.1\n[body.die]\nkind = \"solid\"\nshape.box = [1e-3, 1e-3, \
             1e-4]\n{material}initial_temperature = 900.0\nstress_free_temperature = {free:?}\n"
        );
        let scene = read(&scene);
        let (_, die) = scene.solids().next().unwrap();
        die.material.as_ref().unwrap().material().at(at).expansion.unwrap()
    };
    let [at_800, at_1000] = [3.59e-6 * (800.0 - 293.15), 3.76e-6 * (1000.0 - 293.15)];
    let mean = (at_1000 - at_800) / 200.0;
    assert!((silicon(800.0, 1000.0) / mean - 1.0).abs() < 1e-12);
    assert!((silicon(293.15, 1000.0) / 3.76e-6 - 1.0).abs() < 1e-12);
    // Where both are one, it is the slope there, above the mean from room temperature.
    assert!((4.1e-6..4.5e-6).contains(&silicon(900.0, 900.0)));
}

/// The reference of the library's coefficient goes with it: a coefficient of the scene counts from the temperature
/// without stress unless the scene says otherwise, with `at` or without.
#[test]
fn expansion_of_a_scene_leaves_the_reference_of_the_library() {
    let reference = |keys: &str| {
        let scene = read(&format!(
            "name = \"Die\"\nstop_time = 1.0\nstep = 0.1\n[body.die]\nkind = \"solid\"\nshape.box = [1e-3, 1e-3, \
             1e-4]\nmaterial = {{ substance = \"silicon\"{keys} }}\ninitial_temperature = 400.0\n"
        ));
        let (_, die) = scene.solids().next().unwrap();
        let law = die.material.as_ref().unwrap().material().law.deformation();
        law.elasticity().expansion_reference
    };
    let own = "expansion = { temperature = [300.0, 900.0], value = [3e-6, 4e-6] }";
    assert_eq!(reference(""), Some(293.15));
    for at in ["", ", at = 400.0"] {
        assert_eq!(reference(&format!("{at}, {own}")), None, "{at}");
        let given = format!("{at}, {own}, expansion_reference = 300.0");
        assert_eq!(reference(&given), Some(300.0), "{at}");
    }
}

/// Bodies that share a material at one temperature each have the mean from their own temperature without stress on, in
/// layers, too; one whose temperature is set later keeps its mean and is warned of.
#[test]
fn bodies_of_one_material_expand_from_their_own_temperature_without_stress() {
    let body = |name: &str, free: f64, of: &str| {
        format!(
            "[body.{name}]\nkind = \"solid\"\nshape.box = [1e-3, 1e-3, 1e-4]\ninitial_temperature = {free:?}\n{of}\n"
        )
    };
    let named = "material = \"die\"";
    let layers = "layers = [{ thickness = 4e-5, material = \"die\" }, { thickness = 6e-5, material = \"die\" }]";
    let head = "name = \"Dies\"\nstop_time = 1.0\nstep = 0.1\n";
    let shared = "[material.die]\nsubstance = \"silicon\"\nat = 400.0\n";
    let bodies = [("a", 300.0, named), ("b", 900.0, named), ("c", 700.0, layers)];
    let text: String = bodies.iter().map(|(name, free, of)| body(name, *free, of)).collect();
    let scene = read(&format!("{head}{shared}{text}"));
    for (name, free, _) in bodies {
        let alone = "material = { substance = \"silicon\", at = 400.0 }";
        let alone = read(&format!("{head}{}", body(name, free, alone)));
        let expansion = |scene: &Scene| -> Vec<f64> {
            let materials = scene.solid(name).unwrap().materials_of_layers();
            materials.into_iter().map(|own| own.at(400.0).expansion.unwrap()).collect()
        };
        let wanted = expansion(&alone)[0];
        assert!(expansion(&scene).iter().all(|found| *found == wanted), "{name}");
    }
    let told = |temperature: f64| {
        let mut scene = scene.clone();
        *scene.body.get_mut("a").unwrap().initial_temperature_mut() = temperature;
        let found = impinge::advice::warnings(&scene);
        found.iter().any(|own| own.finding().id == "expansion_from_other_temperature")
    };
    assert_eq!([300.0, 310.0, 900.0].map(told), [false, false, true]);
}

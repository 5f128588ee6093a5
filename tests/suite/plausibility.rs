//! Warnings of what is implausible: no real material causes one, unit mistakes and forgotten parts do,
//! with file, line, key and value.

mod cold;
mod of_drops;

use impinge::advice::{implausible_place, parse_with_warnings};
use impinge::scene::{Scene, parse};
use impinge::warning::Warning;

fn warnings(text: &str) -> Vec<String> {
    let (_, found) =
        parse_with_warnings(text, "scene.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    found.iter().map(Warning::to_string).collect()
}

/// Warnings of a scene that was changed after it was read.
fn of_changed(scene: &Scene) -> Vec<String> {
    impinge::advice::warnings(scene).iter().map(Warning::to_string).collect()
}

/// Name, density, specific heat, conductivity, Young's modulus, Poisson's ratio, expansion.
type SolidRow = (&'static str, f64, f64, f64, f64, f64, f64);

const SOLIDS: [SolidRow; 20] = [
    ("silica aerogel", 100.0, 1000.0, 0.015, 1e6, 0.2, 4e-6),
    ("light aerogel", 10.0, 900.0, 0.012, 1e4, 0.2, 4e-6),
    ("polystyrene foam", 20.0, 1300.0, 0.035, 6e6, 0.1, 7e-5),
    ("silicone rubber", 1100.0, 1300.0, 0.2, 1e6, 0.49, 3e-4),
    ("paraffin wax", 900.0, 2500.0, 0.25, 2e8, 0.4, 5e-4),
    ("balsa", 130.0, 2900.0, 0.05, 3e9, 0.25, 6e-6),
    ("polycarbonate", 1200.0, 1200.0, 0.2, 2.4e9, 0.37, 6.5e-5),
    ("glass", 2500.0, 840.0, 1.0, 70e9, 0.22, 9e-6),
    ("fused silica", 2200.0, 740.0, 1.4, 72e9, 0.17, 5.5e-7),
    ("zirconium tungstate", 5090.0, 500.0, 0.8, 90e9, 0.2, -9e-6),
    ("ice", 917.0, 2100.0, 2.2, 9e9, 0.33, 5e-5),
    ("stainless steel", 7900.0, 500.0, 15.0, 193e9, 0.29, 17e-6),
    ("alumina", 3950.0, 900.0, 10.0, 300e9, 0.21, 8.1e-6),
    ("copper", 8960.0, 385.0, 400.0, 117e9, 0.34, 17e-6),
    ("lithium", 534.0, 3570.0, 85.0, 4.9e9, 0.36, 46e-6),
    ("beryllium", 1850.0, 1825.0, 200.0, 287e9, 0.03, 11e-6),
    ("tungsten", 19_300.0, 132.0, 173.0, 411e9, 0.28, 4.5e-6),
    ("osmium", 22_590.0, 130.0, 88.0, 550e9, 0.25, 5e-6),
    ("diamond", 3515.0, 510.0, 2200.0, 1.22e12, 0.07, 1e-6),
    ("graphite foam", 250.0, 700.0, 50.0, 5e8, 0.2, 3e-6),
];

/// Name, density, viscosity, specific heat, conductivity, surface tension, temperature.
type FluidRow = (&'static str, f64, f64, f64, f64, f64, f64);

const FLUIDS: [FluidRow; 18] = [
    ("hydrogen", 70.8, 1.3e-5, 9700.0, 0.104, 1.9e-3, 20.3),
    ("nitrogen", 807.0, 1.6e-4, 2040.0, 0.14, 8.9e-3, 77.4),
    ("ammonia", 682.0, 2.6e-4, 4700.0, 0.5, 0.034, 240.0),
    ("ethanol", 789.0, 1.2e-3, 2440.0, 0.17, 0.022, 293.0),
    ("water", 998.0, 1e-3, 4180.0, 0.6, 0.072, 293.0),
    ("hot water", 958.0, 2.8e-4, 4216.0, 0.68, 0.059, 373.0),
    ("glycerol", 1260.0, 1.41, 2430.0, 0.29, 0.063, 293.0),
    ("honey", 1420.0, 10.0, 2500.0, 0.5, 0.06, 293.0),
    ("silicone oil", 971.0, 0.97, 1460.0, 0.16, 0.021, 293.0),
    ("molten wax", 780.0, 5e-3, 2500.0, 0.15, 0.026, 350.0),
    ("molten polyamide", 980.0, 50.0, 2700.0, 0.2, 0.036, 530.0),
    ("mercury", 13_534.0, 1.53e-3, 139.0, 8.3, 0.485, 293.0),
    ("sodium", 927.0, 7e-4, 1385.0, 86.0, 0.2, 400.0),
    ("lithium", 512.0, 6e-4, 4300.0, 43.0, 0.4, 460.0),
    ("tin", 6970.0, 1.9e-3, 250.0, 30.0, 0.55, 520.0),
    ("copper", 8000.0, 4e-3, 500.0, 165.0, 1.3, 1370.0),
    ("tungsten", 17_600.0, 7e-3, 300.0, 70.0, 2.5, 3700.0),
    ("molten alumina", 2800.0, 0.04, 1450.0, 2.0, 0.65, 2400.0),
];

fn plate((_, density, specific_heat, conductivity, young, poisson, expansion): SolidRow) -> String {
    format!(
        r#"name = "Plate"
stop_time = 1e-5
step = 1e-6
[body.plate]
kind = "solid"
shape = {{ box = [2e-3, 2e-3, 0.26e-3] }}
material = {{ model = "thermoelastic", density = {density:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?}, young = {young:?}, poisson = {poisson:?}, expansion = {expansion:?} }}
initial_temperature = 293.15
mesh = {{ spacing = 5e-6 }}
[body.plate.faces]
sides = {{ clamped = true }}
bottom = {{ convection = {{ coefficient = 50.0, ambient = 293.15 }} }}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ disc = {{ radius = 30e-6 }} }}
carries = ["heat_flux", "pressure"]
start = {{ heat_flux = 1e5 }}
"#
    )
}

fn drop(row: FluidRow) -> String {
    let (_, density, viscosity, specific_heat, conductivity, tension, temperature) = row;
    // Liquids as light as hydrogen say so themselves.
    let said = if temperature < 200.0 && density > 150.0 { "cryogenic = true\n" } else { "" };
    format!(
        r#"{said}name = "Drop"
stop_time = 1e-5
step = 1e-6
[body.drop]
kind = "droplet"
diameter = 1e-3
impact_velocity = 2.0
initial_temperature = {temperature:?}
spacing = 5e-5
fluid = {{ density = {density:?}, viscosity = {viscosity:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?}, surface_tension = {tension:?} }}
[[wall]]
name = "wall"
under = "drop"
footprint = {{ rings = {{ count = 10, radius = 3e-3 }} }}
start = {{ temperature = {temperature:?} }}
"#
    )
}

const ALUMINA: SolidRow = SOLIDS[12];
const WATER: FluidRow = FLUIDS[5];

/// The text with a part of it, which occurs once, replaced.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} does not occur once in {text}");
    text.replace(from, to)
}

#[test]
fn no_real_solid_is_warned_of() {
    for row in SOLIDS {
        assert_eq!(warnings(&plate(row)), [""; 0], "{}", row.0);
    }
}

#[test]
fn no_real_liquid_is_warned_of() {
    for row in FLUIDS {
        assert_eq!(warnings(&drop(row)), [""; 0], "{}", row.0);
    }
}

#[test]
fn solids_with_constants_in_wrong_units_are_warned_of() {
    for row in SOLIDS {
        let (name, density, specific_heat, _, young, _, expansion) = row;
        let said = |changed: SolidRow, key: &str| {
            let found = warnings(&plate(changed));
            assert!(found.iter().any(|w| w.contains(key)), "{name}, {key}: {found:?}");
        };
        // Aerogels in g/cm³ would pass for still lighter ones where they are 0.1.
        said(
            SolidRow::from((name, 1e-3 * density, row.2, row.3, young, row.5, expansion)),
            "density",
        );
        said(
            SolidRow::from((name, density, 1e-3 * specific_heat, row.3, young, row.5, expansion)),
            "specific_heat",
        );
        // Diamond in GPa would pass for a gel.
        if young < 1e12 {
            said(
                SolidRow::from((name, density, row.2, row.3, 1e-9 * young, row.5, expansion)),
                "young",
            );
        }
        if expansion.abs() >= 1.1e-6 {
            let written = 1e6 * expansion;
            said((name, density, row.2, row.3, young, row.5, written), "expansion");
        }
    }
}

#[test]
fn liquids_with_constants_in_wrong_units_are_warned_of() {
    for row in FLUIDS {
        let (name, density, viscosity, specific_heat, conductivity, tension, temperature) = row;
        let said = |changed: FluidRow, key: &str| {
            let found = warnings(&drop(changed));
            assert!(found.iter().any(|w| w.contains(key)), "{name}, {key}: {found:?}");
        };
        said(
            (name, 1e-3 * density, viscosity, specific_heat, conductivity, tension, temperature),
            "density",
        );
        said(
            (name, density, viscosity, 1e-3 * specific_heat, conductivity, tension, temperature),
            "specific_heat",
        );
        if tension > 4e-3 {
            said(
                (name, density, viscosity, specific_heat, conductivity, 1e3 * tension, temperature),
                "surface_tension",
            );
        }
        let watery = specific_heat > 3900.0 && density > 900.0;
        if watery || conductivity > 7.0 {
            said(
                (name, density, 1e3 * viscosity, specific_heat, conductivity, tension, temperature),
                "viscosity",
            );
        }
    }
}

#[test]
fn a_warning_names_file_line_key_value_range_and_what_was_meant() {
    let text = edited(&plate(ALUMINA), "young = 300000000000.0", "young = 300.0");
    assert_eq!(
        warnings(&text),
        [
            "scene.toml:7: body.plate.material.young = 300.0: Young's modulus is plausible from 700 to \
          1.4e12 Pa; did you mean 3e11 (300 GPa)? [wrong_unit]"
        ]
    );
    let text =
        edited(&plate(ALUMINA), "initial_temperature = 293.15", "initial_temperature = 20.0");
    assert_eq!(
        warnings(&text),
        [
            "scene.toml:8: body.plate.initial_temperature = 20.0: a temperature is plausible from 250 \
          to 6000 K beside warmer ones, and 20 K is −253.15 °C; did you mean 293.15 (20 °C)? If the \
          scene is meant to be this cold, set `cryogenic = true` [celsius]"
        ]
    );
}

#[test]
fn values_of_changed_scenes_are_written_briefly() {
    let text = edited(&plate(ALUMINA), "conductivity = 10.0", "conductivity = 1e-9");
    let mut scene = parse(&text, "scene.toml").unwrap();
    scene.stop_time *= 2.0;
    let place = "the scene with its parameters as set: body.plate.material.conductivity = 1e-9: ";
    let found = of_changed(&scene);
    assert!(found.iter().any(|one| one.starts_with(place)), "{found:?}");
}

#[test]
fn sizes_loads_and_forgotten_parts_are_warned_of() {
    let plate_edits = [
        ("box = [2e-3, 2e-3,", "box = [2.0, 2e-3,", "shape.box[0] = 2.0", "0.002 (2 mm)"),
        ("heat_flux = 1e5", "heat_flux = 1e15", "load[0].start.heat_flux = 1e15", "plausible"),
        ("heat_flux = 1e5", "heat_flux = 1e12", "load[0].start.heat_flux = 1e12", "would heat"),
        ("heat_flux = 1e5", "heat_flux = -1e10", "heat_flux = -1e10", "below absolute zero"),
        ("heat_flux = 1e5", "pressure = 1e12", "start.pressure = 1e12", "plausible"),
        (
            "disc = { radius = 30e-6 }",
            "gaussian = { radius = 8e-6 }",
            "gaussian.radius = 8e-6",
            "nodes",
        ),
        ("spacing = 5e-6", "spacing = 42e-6", "footprint.disc.radius = 30e-6", "nodes"),
        ("ambient = 293.15", "ambient = 25.0", "convection.ambient = 25.0", "298.15 (25 °C)"),
        (
            "stop_time = 1e-5\nstep = 1e-6",
            "stop_time = 1e9\nstep = 1e3",
            "stop_time = 1e9",
            "plausible",
        ),
        (
            "box = [2e-3, 2e-3,",
            "box = [2.0, 2e-3,",
            "shape.box[0]",
            "the extent of a solid is plausible from",
        ),
    ];
    for (from, to, key, says) in plate_edits {
        let found = warnings(&edited(&plate(ALUMINA), from, to));
        assert!(found.iter().any(|w| w.contains(key) && w.contains(says)), "{to}: {found:?}");
    }
    let drop_edits = [
        ("diameter = 1e-3", "diameter = 0.1", "body.drop.diameter = 0.1", "1e-4 (0.1 mm)"),
        (
            "impact_velocity = 2.0",
            "impact_velocity = 50000.0",
            "impact_velocity",
            "50 (50000 mm/s)",
        ),
        ("surface_tension = 0.059", "surface_tension = 59.0", "surface_tension = 59.0", "59 mN/m"),
        ("viscosity = 0.00028", "viscosity = 0.28", "viscosity = 0.28", "2.8e-4 (0.28 mPa s)"),
        (
            "viscosity = 0.00028",
            "viscosity = { law = \"carreau_yasuda\", zero_shear = 2.8e-4, infinite_shear = 2.8e-4, time = 1e6, \
             exponent = 0.5 }",
            "viscosity.time = 1e6",
            "1e6 µs",
        ),
        ("{ temperature = 373.0 }", "{ temperature = 20.0 }", "start.temperature = 20.0", "293.15"),
        ("spacing = 5e-5\n", "spacing = 5e-5\ngravity = 9810.0\n", "gravity = 9810.0", "9.81"),
    ];
    for (from, to, key, says) in drop_edits {
        // As many particles across as before.
        let coarse = to.starts_with("diameter");
        let text = edited(&drop(WATER), from, to);
        let text = if coarse { text.replace("spacing = 5e-5", "spacing = 5e-3") } else { text };
        let found = warnings(&text);
        assert!(found.iter().any(|w| w.contains(key) && w.contains(says)), "{to}: {found:?}");
    }
}

#[test]
fn layers_are_warned_of_as_single_materials_are_and_named_ones_once() {
    let row = |(_, density, specific_heat, conductivity, young, poisson, expansion): SolidRow| {
        format!(
            "model = \"thermoelastic\"\ndensity = {density:?}\nspecific_heat = {specific_heat:?}\n\
             conductivity = {conductivity:?}\nyoung = {young:?}\npoisson = {poisson:?}\nexpansion = {expansion:?}\n"
        )
    };
    let text = |film: SolidRow, thickness: f64, contact: f64| {
        let whole = plate(ALUMINA);
        let whole = edited(&whole, "0.26e-3] }", &format!("{:?}] }}", 2.0 * thickness + 0.2e-3));
        let (start, rest) = whole.split_once("material = ").unwrap();
        let (_, rest) = rest.split_once('\n').unwrap();
        format!(
            "{start}layers = [{{ material = \"film\", thickness = {thickness:?} }}, {{ material = \"base\", \
             thickness = 0.2e-3, contact_resistance = {contact:?} }}, {{ material = \"film\", thickness = {thickness:?} }}]\n\
             {rest}[material.film]\n{}[material.base]\n{}",
            row(film),
            row(ALUMINA)
        )
    };
    for film in SOLIDS {
        assert_eq!(warnings(&text(film, 30e-6, 1e-6)), [""; 0], "{}", film.0);
    }
    let (name, _, heat, k, young, poisson, expansion) = ALUMINA;
    let grams = warnings(&text((name, 3.95, heat, k, young, poisson, expansion), 30e-6, 1e-6));
    assert_eq!(grams.len(), 1, "{grams:?}");
    assert!(grams[0].contains("material.film.density = 3.95"), "{grams:?}");
    let contact = warnings(&text(ALUMINA, 30e-6, 30.0));
    assert!(
        contact.len() == 1 && contact[0].contains("layers[1].contact_resistance"),
        "{contact:?}"
    );
}

#[test]
fn particles_farther_apart_than_heat_goes_are_warned_of() {
    let text = edited(&plate(ALUMINA), "kind = \"solid\"", "kind = \"solid\"\nheat = \"sph\"");
    let told = |text: &str| warnings(text).iter().any(|w| w.contains("√(at)"));
    let apart = |spacing: &str| edited(&text, "spacing = 5e-6", &format!("spacing = {spacing}"));
    // √(at) = 5.3 µm.
    assert!(told(&apart("1e-5")) && !told(&apart("5e-6")));
    let elements = edited(&plate(ALUMINA), "spacing = 5e-6", "spacing = 1e-5");
    assert!(!told(&elements), "finite elements have estimates");
}

#[test]
fn a_load_that_an_input_moves_off_the_fine_mesh_is_warned_of() {
    let told = |text: &str, x: f64| {
        let scene = parse(text, "scene.toml").unwrap_or_else(|e| panic!("{e}"));
        implausible_place(&scene, "spot.x", x).map(|warning| warning.to_string())
    };
    let text = edited(&plate(ALUMINA), "disc = { radius = 30e-6 }", "disc = { radius = 10e-6 }");
    let text = edited(&text, "spacing = 5e-6", "spacing = 2e-6");
    for near in [0.0, 1e-5, -2e-5] {
        assert_eq!(told(&text, near), None, "{near}");
    }
    let message = told(&text, -5e-4).unwrap();
    assert!(
        message.contains("spot.x = -5e-4") && message.contains("range = { x = […] }"),
        "{message}"
    );
    let wide = edited(&text, "start = { heat", "range = { x = [-6e-4, 6e-4] }\nstart = { heat");
    assert_eq!(told(&wide, -5e-4), None);
    let even = edited(&text, "spacing = 2e-6", "growth = 1.0, spacing = 2e-6");
    assert_eq!(told(&even, -5e-4), None);
}

/// A spot of a welder that an input makes smaller than the mesh sees was 10 % to 50 % off.
#[test]
fn a_load_that_an_input_makes_too_small_is_warned_of() {
    let text =
        edited(&plate(ALUMINA), "disc = { radius = 30e-6 }", "gaussian = { radius = 30e-6 }");
    let told = |text: &str, radius: f64| {
        let scene = parse(text, "scene.toml").unwrap_or_else(|e| panic!("{e}"));
        implausible_place(&scene, "spot.radius", radius).map(|warning| warning.to_string())
    };
    for seen in [60e-6, 30e-6, 10e-6] {
        assert_eq!(told(&text, seen), None, "{seen}");
    }
    let message = told(&text, 4e-6).unwrap();
    for words in
        ["spot.radius = 4e-6", "about 5.0e-6 m apart", "range = { radius = […] }", "2e-6 m"]
    {
        assert!(message.contains(words), "{words} is not in {message}");
    }
}

#[test]
fn plates_too_slender_to_bend_are_warned_of() {
    let read = "\n[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"displacement\"]\n";
    let wide = edited(&plate(ALUMINA), "box = [2e-3, 2e-3,", "box = [2.0, 2e-3,");
    let told = |text: &str| warnings(text).iter().any(|w| w.contains("times as wide as thick"));
    assert!(told(&format!("{wide}{read}")));
    assert!(!told(&wide), "nothing asks for a displacement");
    assert!(!told(&format!("{}{read}", plate(ALUMINA))));
    let flat = edited(&wide, "bottom = {", "bottom = { roller = true,");
    assert!(!told(&format!("{flat}{read}")), "it does not bend");
}

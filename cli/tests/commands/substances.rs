//! `impinge substances`, and scenes with names and units.

use std::fs;

use super::Workplace;

#[test]
fn solids_and_fluids_are_listed_with_their_range() {
    let text = Workplace::new().call(&["substances"]).succeeds().stdout();
    assert!(text.contains("200 to    1200 K  Copper, pure"), "{text}");
    assert!(text.contains("273.16 to  373.12 K  Water"), "{text}");
}

#[test]
fn names_show_constants_of_solid_and_melt() {
    let text = Workplace::new().call(&["substances", "tin"]).succeeds().stdout();
    for part in ["# tin (solid)", "# molten-tin (fluid)", "sources = [", "freezes_at = 505.08"] {
        assert!(text.contains(part), "no {part} in\n{text}");
    }
}

#[test]
fn misspelt_names_are_corrected() {
    Workplace::new().call(&["substances", "coper"]).fails(1, &["did you mean `copper`?"]);
}

/// A page of units and names is checked without a warning.
#[test]
fn scenes_in_customary_units_raise_no_warning() {
    let place = Workplace::new();
    let scene = r#"
name = "Sheet"
stop_time = "200 ms"
step = "10 ms"
[body.sheet]
kind = "solid"
shape = { disc = { radius = "8 mm", thickness = "2 mm" } }
material = { substance = "steel-304", at = "100 °C" }
initial_temperature = "20 °C"
faces.bottom = { temperature = "20 °C", roller = true }
[[load]]
name = "burner"
on = "sheet.top"
footprint = { gaussian = { radius = "2 mm" } }
carries = ["heat_flux"]
start = { heat_flux = "3 W/mm²" }
"#;
    fs::write(place.path("units.toml"), scene).unwrap();
    let called = place.call(&["check", "units.toml"]).succeeds();
    assert_eq!(called.stderr(), "");
}

/// Constants are those of the temperature in the scene; 20 °C warmer water is a third thinner.
#[test]
fn drops_of_another_temperature_than_their_constants_are_warned_of() {
    let place = Workplace::new();
    let drop = crate::DROP
        .replace("initial_temperature = 350.0", "initial_temperature = 293.15")
        .replace(
            "fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }",
            "fluid = \"water\"",
        );
    fs::write(place.path("scene.toml"), drop).unwrap();
    let set = |options: &[&str]| {
        let options = [&["--overwrite", "--until", "1e-7"], options].concat();
        place.run(&options).succeeds().stderr()
    };
    assert!(!set(&[]).contains("were taken at"));
    let said = set(&["--set", "drop.initial_temperature=40 °C"]);
    for words in ["constants of `water` were taken at 293.15 K", "viscosity = 6.53e-4 instead of"] {
        assert!(said.contains(words), "`{words}` is missing in: {said}");
    }
    let viscosity = ["--set", "drop.initial_temperature=40 °C", "--set", "drop.viscosity=6.5e-4"];
    assert!(!set(&viscosity).contains("viscosity = "));
}

#[test]
fn solids_hotter_than_their_substance_is_known_are_warned_of() {
    let place = Workplace::new();
    let scene = r#"
name = "Sheet"
stop_time = "1 ms"
step = "100 µs"
[body.sheet]
kind = "solid"
shape.disc = { radius = "8 mm", thickness = "2 mm" }
material = { substance = "steel-304", at = "300 K" }
initial_temperature = "300 K"
mesh = { spacing = "0.5 mm", depth_spacing = "20 µm" }
[[load]]
name = "spot"
on = "sheet.top"
footprint.disc.radius = "1 mm"
carries = ["heat_flux"]
start.heat_flux = "1 GW/m²"
"#;
    fs::write(place.path("scene.toml"), scene).unwrap();
    let said = place.run(&[]).succeeds().stderr();
    let words = "constants of `steel-304` hold, and above the";
    assert!(said.contains(words) && said.contains("the model keeps it solid"), "{said}");
    let gentle = ["--overwrite", "--set", "spot.heat_flux=1 MW/m2"];
    assert!(!place.run(&gentle).succeeds().stderr().contains("steel-304"));
}

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

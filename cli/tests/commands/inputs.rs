//! Inputs over time from a table.

use std::fs;

use super::{Called, SCENE, Workplace};

/// A run of the scene with a table of inputs.
fn run_with(place: &Workplace, table: &str, options: &[&str]) -> Called {
    fs::write(place.path("table.csv"), table).unwrap();
    place.run(&[&["--inputs", "table.csv", "--fields-every", "0"], options].concat())
}

/// Column of a name in a run's table.
fn column(place: &Workplace, folder: &str, title: &str) -> Vec<f64> {
    let (header, rows) = place.table(folder);
    // Titles with two indices are quoted.
    let titles = header.split('"').enumerate().flat_map(|(i, part)| match i % 2 {
        0 => part.split(',').filter(|title| !title.is_empty()).collect(),
        _ => vec![part],
    });
    let at = titles.into_iter().position(|name| name == title).unwrap();
    rows.iter().map(|row| row[at]).collect()
}

const HEAT_IN: &str = "plate.heat_in [J]";
const FLUX: &str = "spot.heat_flux [W/m2]";

#[test]
fn linear_inputs_bring_the_integral_of_their_table() {
    let place = Workplace::new();
    // Corners within steps, a jump, constant before the first row and after the last.
    let table = "time [s],spot.heat_flux [W/m2]\n1.5e-7,2e7\n4.2e-7,8e7\n4.2e-7,1e7\n7e-7,5e7\n";
    run_with(&place, table, &[]).succeeds();
    let flux = [2e7 * 1.5e-7, 0.5 * (2e7 + 8e7) * 2.7e-7, 0.5 * (1e7 + 5e7) * 2.8e-7, 5e7 * 3e-7];
    let heat = flux.iter().sum::<f64>() * std::f64::consts::PI * 60e-6 * 60e-6;
    let found = column(&place, "out/HotSpot", HEAT_IN);
    assert!((found[10] / heat - 1.0).abs() < 1e-12, "{} {heat}", found[10]);
    let inputs = column(&place, "out/HotSpot", FLUX);
    assert_eq!([inputs[0], inputs[1], inputs[10]], [2e7, 2e7, 5e7]);
    let middle = 2e7 + 6e7 * (3e-7 - 1.5e-7) / 2.7e-7;
    assert!((inputs[3] / middle - 1.0).abs() < 1e-12, "{}", inputs[3]);
}

#[test]
fn held_inputs_keep_the_value_of_the_row_before() {
    let place = Workplace::new();
    let table = "time,spot.heat_flux\n0,2e7\n3.3e-7,8e7\n";
    run_with(&place, table, &["--between", "held"]).succeeds();
    let heat = (2e7 * 3.3e-7 + 8e7 * 6.7e-7) * std::f64::consts::PI * 60e-6 * 60e-6;
    let found = column(&place, "out/HotSpot", HEAT_IN);
    assert!((found[10] / heat - 1.0).abs() < 1e-12, "{} {heat}", found[10]);
}

#[test]
fn table_of_the_scenes_own_values_changes_nothing() {
    let place = Workplace::new();
    place.run(&["--out", "plain", "--fields-every", "0"]).succeeds();
    run_with(&place, "time,spot.heat_flux\n0,5e7\n1e-6,5e7\n", &["--out", "table"]).succeeds();
    assert_eq!(place.table("plain"), place.table("table"));
}

#[test]
fn rows_are_written_as_often_as_asked() {
    let place = Workplace::new();
    place.run(&["--rows-every", "4", "--fields-every", "0"]).succeeds();
    let times: Vec<f64> = place.table("out/HotSpot").1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 4.0 * 1e-7, 8.0 * 1e-7, 1e-6]);
}

#[test]
fn table_errors_name_line_and_column() {
    let place = Workplace::new();
    for (table, words) in [
        ("", &["table.csv", "no first column `time`"] as &[&str]),
        ("when,spot.heat_flux\n0,1\n", &["no first column `time`", "allowed: `time`"]),
        ("time,spot.heat_flux\n", &["no rows"]),
        ("time,spot.heat_flix\n0,1\n", &["column `spot.heat_flix`", "did you mean spot.heat_flux"]),
        ("time,centre.temperature\n0,1\n", &["column `centre.temperature`", "it is an output"]),
        ("time,plate.conductivity\n0,1\n", &["plate.conductivity is a fixed parameter"]),
        ("time,spot.heat_flux [MW/m2]\n0,1\n", &["is measured in W/m2"]),
        ("time,spot.heat_flux,spot.heat_flux\n0,1,1\n", &["has a column already"]),
        (
            "time,spot.heat_flux\n0,1\n1e-7,much\n",
            &["table.csv:3", "column `spot.heat_flux`", "much"],
        ),
        ("time,spot.heat_flux\n0,1\n1e-7,NaN\n", &["table.csv:3", "NaN"]),
        ("time,spot.heat_flux\r\n0,1\r\n\r\n\n1e-7,NaN\r\n", &["table.csv:5", "NaN"]),
        ("time,spot.radius\n0,-1\n", &["table.csv:2", "spot.radius", "1e-12 to 1e6"]),
        ("time,spot.heat_flux\n1,1\n0,1\n", &["table.csv:3", "column `time`", "ascend"]),
        ("time,spot.heat_flux\n0,1\n0,1\n0,1\n", &["table.csv:4", "third row"]),
        ("time,spot.heat_flux\n0,1\n1\n", &["table.csv:3", "1 cells", "allowed: 2"]),
    ] {
        run_with(&place, table, &[]).fails(1, words);
    }
    let set = ["--set", "spot.heat_flux=1"];
    run_with(&place, "time,spot.heat_flux\n0,1\n", &set).fails(1, &["spot.heat_flux is set"]);
    fs::write(place.path("latin.csv"), b"time,spot.heat_flux\n0,\xe9\n").unwrap();
    place.run(&["--inputs", "latin.csv"]).fails(1, &["latin.csv:2", "UTF-8"]);
    place.run(&["--inputs", "nowhere.csv"]).fails(1, &["nowhere.csv"]);
    place.run(&["--between", "held"]).fails(2, &["--inputs"]);
    place.run(&["--rows-every", "0"]).fails(2, &["rows-every"]);
    assert!(!place.path("out").exists());
}

#[test]
fn run_notes_values_kept_before_and_after_its_table() {
    let place = Workplace::new();
    for (rows, words) in [
        (
            "1,5e7\n",
            "before the first row at 1 s, whose values hold throughout; check that the times",
        ),
        ("0,5e7\n2e-7,6e7\n", "the values of the last row hold from 2e-7 s to 1e-6 s"),
    ] {
        let table = format!("time,spot.heat_flux\n{rows}");
        let said = run_with(&place, &table, &["--overwrite"]).succeeds().stderr();
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn short_pulses_warn_and_balance() {
    let place = Workplace::new();
    let said = |rows: &str| {
        let table = format!("time,spot.heat_flux\n{rows}");
        let options = ["--overwrite", "--until", "1e-7", "--between", "held"];
        run_with(&place, &table, &options).succeeds().stderr()
    };
    let pulse = said("0,5e7\n1e-11,0\n");
    let named =
        "warning: table.csv, row at 0 s and at 1e-11 s: plate: a step of 1.0e-11 s is shorter than";
    assert!(pulse.contains(named), "{pulse}");
    let late = said("0,5e7\n9.999e-8,0\n");
    let named = "warning: table.csv, row at 9.999e-8 s: plate: a step of 1.0e-11 s is shorter than";
    assert!(late.contains(named), "{late}");
    let flipping = said("0,5e7\n5e-8,-5e7\n");
    assert!(!flipping.contains("heat in differs"), "{flipping}");
}

#[test]
fn a_run_never_writes_over_its_table() {
    let place = Workplace::new();
    fs::create_dir(place.path("w")).unwrap();
    fs::write(place.path("w/outputs.csv"), "time,spot.heat_flux\n0,1\n").unwrap();
    place
        .run(&["--inputs", "w/outputs.csv", "--out", "w", "--overwrite"])
        .fails(1, &["outputs.csv could be one of the files of the run"]);
    let kept = fs::read_to_string(place.path("w/outputs.csv")).unwrap();
    assert_eq!(kept, "time,spot.heat_flux\n0,1\n");
}

#[test]
fn balance_is_relative_to_the_largest_heat_so_far() {
    let place = Workplace::new();
    let scene = SCENE.replace("bottom = { temperature = 293.15 }\n", "");
    fs::write(place.path("scene.toml"), scene).unwrap();
    let table = "time,spot.heat_flux\n0,1e8\n5e-7,1e8\n5e-7,-1e8\n1e-6,-1e8\n";
    let run = run_with(&place, table, &[]).succeeds();
    let said = run.stderr();
    let mut others = said
        .lines()
        .filter(|line| line.starts_with("warning") && !line.contains(": the error of "));
    assert_eq!(others.next(), None);
}

#[test]
fn values_beyond_bounds_and_in_celsius_are_refused_or_warned_of() {
    let place = Workplace::new();
    let table = |value: &str| format!("time,plate.bottom.temperature\n0,300\n5e-7,{value}\n");
    for value in ["1e12", "-20", "0", "NaN"] {
        let words = ["table.csv:3", "plate.bottom.temperature", "above 0 and at most 1e9"];
        run_with(&place, &table(value), &[]).fails(1, &words);
    }
    assert!(!place.path("out").exists(), "a refused run writes nothing");
    let said = run_with(&place, &table("90"), &[]).succeeds().stderr();
    assert!(said.contains("plate.bottom.temperature = 90: "), "{said}");
    assert!(said.contains("90 K is −183.15 °C; did you mean 363.15 (90 °C)?"), "{said}");
    fs::write(place.path("scene.toml"), format!("cryogenic = true\n{SCENE}")).unwrap();
    let said = run_with(&place, &table("90"), &["--overwrite"]).succeeds().stderr();
    assert!(!said.contains("°C"), "{said}");
}

#[test]
fn a_run_warns_once_as_its_fluid_would_boil() {
    let place = Workplace::new();
    let text = super::DROP.replace("conductivity = 0.6", "conductivity = 0.6, boils_at = 373.15");
    fs::write(place.path("scene.toml"), text).unwrap();
    let said = place
        .run(&["--fields-every", "0", "--set", "drop.initial_temperature=380"])
        .succeeds()
        .stderr();
    assert_eq!(said.matches("above the 373.15 K at which it boils").count(), 1, "{said}");
    assert!(said.contains("warning: drop: at "), "{said}");
    let said = place.run(&["--overwrite", "--fields-every", "0"]).succeeds().stderr();
    assert!(!said.contains("boils"), "{said}");
}

/// Two rows lie in fine parts of the mesh, one through a mirror image; the path between them crosses a coarse part.
#[test]
fn positions_between_rows_are_sampled() {
    let place = Workplace::new();
    let scene = SCENE
        .replace("box = [4e-4, 4e-4, 1e-4]", "box = [8e-3, 4e-3, 1e-4]")
        .replace(
            "mesh = { spacing = 4e-5, order = 1 }",
            "mesh = { spacing = 4e-5, order = 1, growth = 1.5 }",
        )
        .replace("start = { heat_flux = 5e7 }", "start = { heat_flux = 5e7, x = -3e-3 }")
        .replace(", \"stress\"", "");
    fs::write(place.path("scene.toml"), scene).unwrap();
    let table = "time,spot.x\n0,-3e-3\n1e-6,3e-3\n";
    let said = |between: &str| {
        run_with(&place, table, &["--between", between, "--overwrite"]).succeeds().stderr()
    };
    let words = "the mesh does not resolve a load this small here";
    assert!(said("linear").contains(words));
    assert!(!said("held").contains(words));
}

#[test]
fn a_first_row_after_time_zero_is_noted() {
    let place = Workplace::new();
    let run = run_with(&place, "time,spot.heat_flux\n5e-7,2e7\n1e-6,2e7\n", &[]).succeeds();
    assert!(run.stderr().contains("the values of the first row, at 5e-7 s, hold from the start"));
}

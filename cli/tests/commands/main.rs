//! The commands as a user calls them: exit status, messages, files.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use tempfile::TempDir;

mod check;
mod descriptions;
mod inputs;
mod limits;
mod named_materials;
mod new;
mod passing;
mod report;
mod run_files;
mod settings;
mod stored;
mod substances;

const SCENE: &str = r#"
name = "HotSpot"
description = "A small plate under a hot spot"
stop_time = 1e-6
step = 1e-7

[body.plate]
kind = "solid"
shape = { box = [4e-4, 4e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 4e-5, order = 1 }
[body.plate.faces]
bottom = { temperature = 293.15 }
sides = { clamped = true }

[[load]]
name = "spot"
on = "plate.top"
footprint = { disc = { radius = 60e-6 } }
carries = ["heat_flux", "pressure"]
start = { heat_flux = 5e7 }

[[probe]]
name = "centre"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature", "stress"]

[[field]]
name = "surface"
on = "plate.top"
grid = [2, 3]
gives = ["temperature"]
"#;

const DROP: &str = r#"
name = "Drop"
stop_time = 3e-7
step = 1e-7

[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }

[[wall]]
name = "wall"
under = "drop"
footprint = { tiles = { count = [2, 2], size = [2e-4, 2e-4] } }
"#;

/// A scene in a folder of its own, which is removed when the test ends.
struct Workplace(TempDir);

impl Workplace {
    fn new() -> Self {
        let folder = TempDir::with_prefix("impinge-cli-").unwrap();
        fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The names of the files in a folder.
    fn files(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn call(&self, arguments: &[&str]) -> Called {
        let output = Command::new(env!("CARGO_BIN_EXE_impinge"))
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .unwrap();
        Called(output)
    }

    fn run(&self, options: &[&str]) -> Called {
        self.call(&[&["run", "scene.toml"], options].concat())
    }

    /// Header and rows of a run's table.
    fn table(&self, folder: &str) -> (String, Vec<Vec<f64>>) {
        let text = fs::read_to_string(self.path(folder).join("outputs.csv")).unwrap();
        let (header, body) = text.split_once('\n').unwrap();
        let row = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
        (header.to_owned(), body.lines().map(row).collect())
    }

    /// Times of a run's fields; asserts that every listed file exists.
    fn field_times(&self, folder: &str) -> Vec<f64> {
        let folder = self.path(folder);
        let list = fs::read_to_string(folder.join("plate.pvd")).unwrap();
        let entries = list.lines().filter(|line| line.contains("<DataSet"));
        entries
            .map(|entry| {
                assert!(folder.join(attribute(entry, "file")).is_file(), "{entry}");
                attribute(entry, "timestep").parse().unwrap()
            })
            .collect()
    }
}

fn attribute<'a>(element: &'a str, key: &str) -> &'a str {
    let (_, rest) = element.split_once(&format!("{key}=\"")).unwrap();
    rest.split_once('"').unwrap().0
}

struct Called(Output);

impl Called {
    fn stdout(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    fn stderr(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }

    #[track_caller]
    fn succeeds(self) -> Self {
        assert_eq!(self.0.status.code(), Some(0), "{}", self.stderr());
        self
    }

    /// Asserts exit with `status`, all of `words` on standard error and nothing on standard output.
    #[track_caller]
    fn fails(self, status: i32, words: &[&str]) -> Self {
        let stderr = self.stderr();
        assert_eq!(self.0.status.code(), Some(status), "{stderr}");
        assert_eq!(self.stdout(), "");
        for word in words {
            assert!(stderr.contains(word), "`{word}` is missing in: {stderr}");
        }
        self
    }
}

#[test]
fn run_without_any_load_prints_a_note() {
    let place = Workplace::new();
    let said = place.run(&[]).succeeds().stderr();
    assert!(!said.contains("note: nothing acts"), "{said}");
    let said = place.run(&["--overwrite", "--set", "spot.heat_flux=0"]).succeeds().stderr();
    for words in ["note: nothing acts", "spot.heat_flux, spot.pressure", "--set "] {
        assert!(said.contains(words), "`{words}` is missing in: {said}");
    }
    let settings =
        ["--overwrite", "--set", "spot.heat_flux=0", "--set", "plate.bottom.temperature=310"];
    let said = place.run(&settings).succeeds().stderr();
    assert!(!said.contains("note: nothing acts"), "{said}");
}

/// Three steps of 333.33 ns leave 10 ps of a microsecond.
#[test]
fn rounding_remainder_is_not_a_short_step() {
    let place = Workplace::new();
    let said = place.run(&["--step", "3.3333e-7"]).succeeds().stderr();
    assert!(!said.contains("is shorter than"), "{said}");
    let rows = fs::read_to_string(place.path("out/HotSpot/outputs.csv")).unwrap();
    assert_eq!(rows.lines().count(), 6);
    assert!(rows.lines().last().unwrap().starts_with("1e-6,"), "{rows}");
}

/// A face of `bed2` at the temperature of `bed` is not at rest.
#[test]
fn bodies_with_a_common_prefix_are_distinguished() {
    let solid = |name: &str, temperature: f64| {
        format!(
            r#"[body.{name}]
kind = "solid"
shape = {{ box = [1e-3, 1e-3, 1e-4] }}
material = {{ model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }}
initial_temperature = {temperature:?}
mesh = {{ spacing = 1e-4, order = 1 }}
[body.{name}.faces]
bottom = {{ temperature = 300.0 }}
"#
        )
    };
    let head = "name = \"Beds\"\nstop_time = 1e-6\nstep = 1e-6\n";
    let place = Workplace::new();
    for (temperature, is_idle) in [(350.0, false), (300.0, true)] {
        let scene = format!("{head}{}{}", solid("bed", 300.0), solid("bed2", temperature));
        fs::write(place.path("scene.toml"), scene).unwrap();
        let said = place.run(&["--overwrite"]).succeeds().stderr();
        assert_eq!(said.contains("nothing acts"), is_idle, "{temperature}: {said}");
    }
}

#[test]
fn a_run_to_below_absolute_zero_fails_with_time_and_reason() {
    let place = Workplace::new();
    let words = ["in the step from t = 0 s", "plate would cool to -", "below absolute zero"];
    place.run(&["--set", "spot.heat_flux=-1e12"]).fails(1, &words);
}

#[test]
fn wrong_usage_has_its_own_status() {
    let place = Workplace::new();
    place.call(&[]).fails(2, &["Usage"]);
    place.call(&["check"]).fails(2, &["SCENE"]);
    place.run(&["--until", "-1"]).fails(2, &["positive"]);
    place.run(&["--step", "soon"]).fails(2, &["positive"]);
    place.run(&["--set", "plate.young"]).fails(2, &["NAME=VALUE"]);
}

#[cfg(target_os = "linux")]
#[test]
fn unprintable_output_ends_without_a_panic() {
    let place = Workplace::new();
    let program = env!("CARGO_BIN_EXE_impinge");
    let shell = |line: &str| {
        let line = format!("{program} {line}");
        Called(Command::new("sh").args(["-c", &line]).current_dir(place.0.path()).output().unwrap())
    };
    shell("check scene.toml >/dev/full").fails(1, &["cannot print"]);
    assert_eq!(shell("check nothing.toml 2>/dev/full").0.status.code(), Some(1));
    let cold = "run scene.toml --until 1e-7 --set plate.initial_temperature=25 2>/dev/full";
    shell(cold).succeeds();
    let bed = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/heated_bed/scene.toml");
    for (folder, doubted) in [("idle", ""), ("hot", "--set heater.heat_flux=1e16")] {
        shell(&format!("run {bed} --until 2 --out {folder} {doubted} 2>/dev/full")).succeeds();
    }
    let piped = shell("check scene.toml | true; echo done").succeeds();
    let said = piped.stderr();
    let mut others = said.lines().filter(|line| !line.contains(": the error of "));
    assert_eq!((piped.stdout().as_str(), others.next()), ("done\n", None));
}

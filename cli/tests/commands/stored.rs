//! Assessments of scenes are stored, and nothing but time depends on that.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::{Called, SCENE, Workplace};

const VARIABLE: &str = "IMPINGE_CACHE";

/// The scene of heat alone, without a mesh and with an open level: both are chosen.
fn open_scene() -> String {
    let text = SCENE.replace("mesh = { spacing = 4e-5, order = 1 }\n", "");
    format!(
        "fidelity.level = \"auto\"\n{}",
        text.replace("\"temperature\", \"stress\"", "\"temperature\"")
    )
}

impl Workplace {
    fn command(&self, cache: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_impinge"));
        command.args(arguments).current_dir(self.path("")).env(VARIABLE, cache);
        command
    }

    fn call_with(&self, cache: &str, arguments: &[&str]) -> Called {
        Called(self.command(cache, arguments).output().unwrap()).succeeds()
    }

    /// Files of the assessments in a folder.
    fn stored(&self, cache: &str) -> Vec<PathBuf> {
        let Ok(entries) = fs::read_dir(self.path(cache).join("assessments")) else {
            return Vec::new();
        };
        entries.map(|entry| entry.unwrap().path()).collect()
    }
}

/// A report without the measured cost and the remark on the store.
fn steady(called: &Called) -> (String, String) {
    let is_steady = |line: &&str| !line.starts_with("  takes") && !line.contains("--fresh");
    let report = called.stdout();
    let lines: Vec<&str> = report.trim_end().lines().filter(is_steady).collect();
    (lines.join("\n").trim_end().to_owned(), called.stderr())
}

#[test]
fn reports_are_the_same_with_and_without_the_store() {
    let place = Workplace::new();
    for scene in [SCENE.to_owned(), open_scene()] {
        fs::write(place.path("scene.toml"), scene).unwrap();
        let check = ["check", "scene.toml", "--verbose"];
        let without = place.call_with("", &check);
        let first = place.call_with("cache", &check);
        let again = place.call_with("cache", &check);
        let fresh = place.call_with("cache", &[&check[..], &["--fresh"]].concat());
        for other in [&first, &again, &fresh] {
            assert_eq!(steady(other), steady(&without));
        }
        let remarks =
            [&without, &first, &again, &fresh].map(|one| one.stdout().contains("--fresh"));
        assert_eq!(remarks, [false, false, true, false]);
        // The cost is that of the first time.
        let cost = |called: &Called| {
            let report = called.stdout();
            report.lines().find(|line| line.starts_with("  takes")).unwrap().to_owned()
        };
        let processor = |cost: String| cost.rsplit_once(", ").unwrap().0.to_owned();
        assert_eq!(processor(cost(&again)), processor(cost(&first)));
    }
    assert_eq!(place.stored("cache").len(), 3, "meshes of both scenes and the level of one");
    assert!(place.stored("").is_empty());
}

#[test]
fn outputs_of_runs_are_the_same_with_and_without_the_store() {
    let place = Workplace::new();
    fs::write(place.path("scene.toml"), open_scene()).unwrap();
    let run = |cache: &str, out: &str| {
        place.call_with(cache, &["run", "scene.toml", "--out", out, "--fields-every", "5"]).stderr()
    };
    run("", "without");
    place.call_with("cache", &["check", "scene.toml"]);
    let known = place.stored("cache").len();
    run("cache", "with");
    assert_eq!(place.stored("cache").len(), known, "a run finds what a check has stored");
    for name in place.files("without").into_iter().filter(|name| name != "run.json") {
        let of = |folder: &str| fs::read(place.path(folder).join(&name)).unwrap();
        assert!(of("with") == of("without"), "{name}");
    }
}

#[test]
fn changed_scenes_are_assessed_anew() {
    let place = Workplace::new();
    // An input is no part of the scene.
    let settings: [(&[&str], usize); 4] = [
        (&[], 1),
        (&["--set", "plate.conductivity=20"], 2),
        (&["--set", "spot.heat_flux=6e7"], 2),
        (&["--until", "5e-7"], 3),
    ];
    for (setting, known) in settings {
        let run = ["run", "scene.toml", "--overwrite", "--fields-every", "0"];
        place.call_with("cache", &[&run[..], setting].concat());
        assert_eq!(place.stored("cache").len(), known, "{setting:?}");
    }
}

#[test]
fn damaged_and_unwritable_stores_are_ignored() {
    let place = Workplace::new();
    let check = ["check", "scene.toml", "--verbose"];
    let without = steady(&place.call_with("", &check));
    place.call_with("cache", &check);
    let [file] = &place.stored("cache")[..] else { panic!("{:?}", place.stored("cache")) };
    let whole = fs::read(file).unwrap();
    let mut changed = whole.clone();
    *changed.last_mut().unwrap() ^= 1;
    for damaged in [&whole[..whole.len() / 2], &changed, b"", b"\xff\x00", b"another program's"] {
        fs::write(file, damaged).unwrap();
        for is_stored in [false, true] {
            let called = place.call_with("cache", &check);
            assert_eq!(steady(&called), without);
            assert_eq!(called.stdout().contains("--fresh"), is_stored, "it is replaced");
        }
    }
    fs::remove_file(file).unwrap();
    fs::create_dir(file).unwrap();
    assert_eq!(steady(&place.call_with("cache", &check)), without);
    fs::write(place.path("taken"), "a file").unwrap();
    for cache in ["taken", "/dev/null", "/proc/nowhere"] {
        assert_eq!(steady(&place.call_with(cache, &check)), without, "{cache}");
    }
}

#[test]
fn processes_at_once_have_the_same_report() {
    let place = Workplace::new();
    let check = ["check", "scene.toml"];
    let without = steady(&place.call_with("", &check));
    let start = |_| {
        let mut command = place.command("cache", &check);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let started: Vec<_> = (0..6).map(start).collect();
    for process in started {
        let called = Called(process.wait_with_output().unwrap()).succeeds();
        assert_eq!(steady(&called), without);
    }
    assert_eq!(place.stored("cache").len(), 1, "no unfinished file stays");
}

/// Trials that find too little address space end early.
#[cfg(target_os = "linux")]
#[test]
fn processes_of_limited_address_space_store_nothing() {
    let place = Workplace::new();
    let script = format!("ulimit -v 4000000; {} check scene.toml", env!("CARGO_BIN_EXE_impinge"));
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).current_dir(place.path("")).env(VARIABLE, "cache");
    Called(shell.output().unwrap()).succeeds();
    assert!(place.stored("cache").is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn default_folder_is_that_of_the_user() {
    let place = Workplace::new();
    for (variable, value, folder) in [
        ("XDG_CACHE_HOME", place.path("caches"), "caches/impinge"),
        ("XDG_CACHE_HOME", PathBuf::from("relative"), "home/.cache/impinge"),
        ("LANG", PathBuf::from("C"), "home/.cache/impinge"),
    ] {
        let mut command = place.command("", &["check", "scene.toml"]);
        command.env_remove(VARIABLE).env_remove("XDG_CACHE_HOME").env("HOME", place.path("home"));
        Called(command.env(variable, value).output().unwrap()).succeeds();
        assert_eq!(place.stored(folder).len(), 1, "{folder}");
        fs::remove_dir_all(place.path(folder)).unwrap();
    }
}

//! The files that a run writes, and those that it does not touch.

use std::fs;
use std::process::Command;

use super::{Called, DROP, SCENE, Workplace, attribute};

#[test]
fn a_run_writes_a_row_a_step_and_fields() {
    let place = Workplace::new();
    let report = place.run(&[]).succeeds().stdout();
    for words in ["HotSpot", "10 steps", "heat in", "residual", "plate.max_temperature"] {
        assert!(report.contains(words), "`{words}` is missing in: {report}");
    }
    let (header, rows) = place.table("out/HotSpot");
    assert!(header.starts_with("time [s],spot.heat_flux [W/m2],spot.pressure [Pa]"), "{header}");
    assert!(header.contains(",\"surface.temperature[1,2] [K]\","), "{header}");
    assert_eq!(rows.len(), 11);
    for (i, row) in rows.iter().enumerate() {
        let time = if i == 10 { 1e-6 } else { i as f64 * 1e-7 };
        assert_eq!(row[..2], [time, 5e7]);
    }
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(place.field_times("out/HotSpot"), times);
}

#[test]
fn run_reports_running_maxima_with_times_and_positions() {
    let place = Workplace::new();
    let peaks = "peaks = [\"temperature\", \"von_mises\"]\nmesh = {";
    fs::write(place.path("scene.toml"), SCENE.replacen("mesh = {", peaks, 1)).unwrap();
    let report = place.run(&["--fields-every", "0"]).succeeds().stdout();
    for words in ["highest so far", "plate.peak_temperature", "plate.peak_von_mises"] {
        assert!(report.contains(words), "`{words}` is missing in: {report}");
    }
    let (header, rows) = place.table("out/HotSpot");
    let column = |name: &str| {
        let before =
            &header[..header.find(name).unwrap_or_else(|| panic!("no {name} in {header}"))];
        // Quoted names have a comma each.
        before.matches(',').count() - before.matches('"').count() / 2
    };
    let mut highest = f64::NEG_INFINITY;
    for row in &rows {
        highest = highest.max(row[column("plate.max_temperature")]);
        assert_eq!(row[column("plate.peak_temperature [K]")], highest);
        assert_eq!(row[column("plate.peak_temperature_time [s]")], row[0], "ever hotter");
        assert_eq!(row[column("plate.peak_temperature_z [m]")], 0.0);
    }
    let notes = place.call(&["check", "scene.toml", "-v"]).succeeds().stdout();
    assert!(notes.contains("stress is solved at every communication point"), "{notes}");
}

#[test]
fn a_stop_time_between_steps_is_hit_exactly() {
    let place = Workplace::new();
    let options = ["--until", "3.5e-7", "--out", "short", "--fields-every", "2"];
    place.run(&options).succeeds();
    let times: Vec<f64> = place.table("short").1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 1e-7, 2.0 * 1e-7, 3.0 * 1e-7, 3.5e-7]);
    assert_eq!(place.field_times("short"), [0.0, 2.0 * 1e-7, 3.5e-7]);
}

#[test]
fn a_run_writes_the_particles_of_a_droplet() {
    let place = Workplace::new();
    fs::write(place.path("drop.toml"), DROP).unwrap();
    let options = ["run", "drop.toml", "--set", "wall.temperature=300", "--out", "files"];
    let report = place.call(&options).succeeds().stdout();
    for words in ["3 steps", "drop.height", "drop.mass                5.2360e-10 kg"] {
        assert!(report.contains(words), "`{words}` is missing in: {report}");
    }
    let text = fs::read_to_string(place.path("files/outputs.csv")).unwrap();
    assert!(text.contains(",drop.force [N],\"wall.heat_flux[1,1] [W/m2]\","), "{text}");
    assert_eq!(text.lines().count(), 5);
    let list = fs::read_to_string(place.path("files/drop.pvd")).unwrap();
    let entries: Vec<&str> = list.lines().filter(|line| line.contains("<DataSet")).collect();
    assert_eq!(entries.len(), 4);
    let last = fs::read(place.path("files").join(attribute(entries[3], "file"))).unwrap();
    let head = String::from_utf8_lossy(&last[..500]);
    assert!(head.contains("type=\"PolyData\"") && head.contains("NumberOfVerts"), "{head}");
}

#[test]
fn the_files_of_an_earlier_run_are_replaced_only_if_asked() {
    let place = Workplace::new();
    place.run(&["--until", "3e-7", "--fields-every", "1"]).succeeds();
    let before = fs::read(place.path("out/HotSpot/outputs.csv")).unwrap();
    place.run(&[]).fails(1, &["out/HotSpot holds the files of an earlier run", "--overwrite"]);
    assert_eq!(fs::read(place.path("out/HotSpot/outputs.csv")).unwrap(), before);
    place.run(&["--until", "1e-7", "--fields-every", "1", "--overwrite"]).succeeds();
    assert_eq!(place.field_times("out/HotSpot"), [0.0, 1e-7]);
    let files = fs::read_dir(place.path("out/HotSpot")).unwrap();
    let words = "two grids, their list, the table and the record; none of the longer run";
    assert_eq!(files.count(), 5, "{words}");
    // Fields alone also count as an earlier run.
    fs::remove_file(place.path("out/HotSpot/outputs.csv")).unwrap();
    place.run(&["--fields-every", "0"]).fails(1, &["earlier run"]);
    // A run without fields leaves none that could be mistaken for its own.
    fs::write(place.path("out/HotSpot/mine.pvd"), "").unwrap();
    place.run(&["--until", "1e-7", "--fields-every", "0", "--overwrite"]).succeeds();
    assert_eq!(place.files("out/HotSpot"), ["mine.pvd", "outputs.csv", "run.json"]);
}

/// Files that no run wrote, under names that a run would write or remove.
#[test]
fn foreign_files_of_the_names_of_a_series_are_replaced_only_if_asked() {
    for name in ["all-bodies.pvd", "plate.pvd", "plate_000003.vtr", "plate_000003.vts"] {
        for fields in ["1", "0"] {
            let place = Workplace::new();
            fs::create_dir(place.path("files")).unwrap();
            fs::write(place.path("files").join(name), "mine").unwrap();
            let run = ["--out", "files", "--until", "4e-7", "--fields-every", fields];
            place.run(&run).fails(1, &["files holds", &format!("files/{name}"), "--overwrite"]);
            assert_eq!(place.files("files"), [name]);
            assert_eq!(fs::read(place.path("files").join(name)).unwrap(), b"mine");
            place.run(&[&run[..], &["--overwrite"]].concat()).succeeds();
            let left = fs::read(place.path("files").join(name)).unwrap_or_default();
            assert_ne!(left, b"mine", "{name}");
        }
    }
}

#[test]
fn files_of_other_names_are_left_alone() {
    let place = Workplace::new();
    fs::create_dir(place.path("files")).unwrap();
    let names = ["plate2_000003.vtr", "plate_03.vtr", "plate_000003.vtu", "notes.txt"];
    names.iter().for_each(|name| fs::write(place.path("files").join(name), "mine").unwrap());
    place.run(&["--out", "files", "--until", "4e-7", "--fields-every", "1"]).succeeds();
    for name in names {
        assert_eq!(fs::read(place.path("files").join(name)).unwrap(), b"mine", "{name}");
    }
}

#[test]
fn killed_run_counts_as_earlier_run() {
    let place = Workplace::new();
    for fields in ["1", "0"] {
        let mut running = Command::new(env!("CARGO_BIN_EXE_impinge"))
            .args(["run", "scene.toml", "--until", "1e-2", "--fields-every", "1", "--overwrite"])
            .current_dir(place.0.path())
            .stderr(std::process::Stdio::null())
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        while !place.path("out/HotSpot/plate_000003.vtr").exists() {
            assert_eq!(running.try_wait().unwrap(), None);
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        running.kill().unwrap();
        running.wait().unwrap();
        // Depending on when the run ended, a file may be unfinished.
        fs::write(place.path("out/HotSpot/plate_000009.vtr.part1_2"), "").unwrap();
        place.run(&["--until", "1e-7"]).fails(1, &["holds the files of an earlier run"]);
        let settings = ["--until", "1e-7", "--overwrite", "--fields-every", fields];
        place.run(&settings).succeeds();
        let table = fs::read_to_string(place.path("out/HotSpot/outputs.csv")).unwrap();
        assert_eq!(table.lines().count(), 3);
        let alone = ["outputs.csv", "run.json"];
        let fields_too = ["plate.pvd", "plate_000000.vtr", "plate_000001.vtr"];
        let mut wanted = alone.to_vec();
        wanted.extend(fields_too.into_iter().filter(|_| fields == "1"));
        wanted.sort_unstable();
        assert_eq!(place.files("out/HotSpot"), wanted);
    }
}

/// A modulus that relaxes to nothing within the first step bears no load: the step fails.
#[test]
fn failed_runs_leave_the_files_of_former_ones() {
    let pad = |fraction: &str| {
        format!(
            r#"
name = "Pad"
stop_time = 2.0
step = 1.0
[body.pad]
kind = "solid"
shape = {{ disc = {{ radius = 1e-3, thickness = 0.5e-3 }} }}
initial_temperature = 300.0
mesh = {{ spacing = 0.25e-3, depth_spacing = 0.1e-3 }}
material = {{ model = "viscoelastic", density = 1190.0, specific_heat = 1470.0, conductivity = 0.19, young = 3.3e9, poisson = 0.37, expansion = 7e-5, shear_relaxation = [{{ fraction = {fraction}, time = 1e-12 }}] }}
faces.bottom = {{ roller = true }}
[[load]]
name = "press"
on = "pad.top"
footprint = {{ disc = {{ radius = 0.6e-3 }} }}
carries = ["pressure"]
start = {{ pressure = 1e6 }}
[[probe]]
name = "top"
in = "pad"
at = [0.0, 0.0, 0.0]
gives = ["displacement"]
"#
        )
    };
    let place = Workplace::new();
    fs::write(place.path("scene.toml"), pad("0.5")).unwrap();
    place.run(&["--out", "o"]).succeeds();
    let (files, (_, rows)) = (place.files("o"), place.table("o"));
    fs::write(place.path("scene.toml"), pad("1.0")).unwrap();
    place.run(&["--out", "o", "--overwrite"]).fails(1, &["pad"]);
    assert_eq!(place.files("o"), files);
    assert_eq!(place.table("o").1, rows);
}

#[test]
fn a_folder_that_another_run_is_writing_to_is_left_alone() {
    let place = Workplace::new();
    fs::create_dir_all(place.path("out/HotSpot")).unwrap();
    let folder = fs::File::open(place.path("out/HotSpot")).unwrap();
    folder.try_lock().unwrap();
    place.run(&["--overwrite"]).fails(1, &["another run is writing to out/HotSpot"]);
    assert_eq!(fs::read_dir(place.path("out/HotSpot")).unwrap().count(), 0);
    drop(folder);
    place.run(&["--until", "1e-7"]).succeeds();
}

/// A reader of a pipe without writer blocks for ever.
#[test]
fn pipes_and_devices_as_scenes_and_tables_are_refused_at_once() {
    let place = Workplace::new();
    assert!(Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    for path in ["pipe", "/dev/zero"] {
        let words = ["a pipe, socket or device (allowed: a regular file)"];
        place.call(&["check", path]).fails(1, &words);
        place.call(&["run", path]).fails(1, &words);
        place.run(&["--inputs", path]).fails(1, &words);
    }
}

#[test]
fn files_that_vanish_while_a_run_goes_on_are_noticed() {
    let place = Workplace::new();
    let table = place.path("out/HotSpot/outputs.csv");
    let running = Command::new(env!("CARGO_BIN_EXE_impinge"))
        .args(["run", "scene.toml", "--until", "1e-4", "--step", "1e-7", "--fields-every", "0"])
        .current_dir(place.0.path())
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    while fs::remove_file(&table).is_err() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Called(running.wait_with_output().unwrap()).fails(1, &["outputs.csv was removed"]);
}

#[test]
fn a_run_never_writes_over_its_scene_nor_through_links() {
    let place = Workplace::new();
    fs::create_dir(place.path("folder")).unwrap();
    for name in ["outputs.csv", "plate.pvd"] {
        let scene = format!("folder/{name}");
        fs::write(place.path(&scene), SCENE).unwrap();
        let called = place.call(&["run", &scene, "--out", "folder", "--overwrite"]);
        called.fails(1, &["could be one of the files of the run"]);
        assert_eq!(fs::read_to_string(place.path(&scene)).unwrap(), SCENE);
        fs::remove_file(place.path(&scene)).unwrap();
    }
    fs::write(place.path("notes"), "kept").unwrap();
    std::os::unix::fs::symlink("../notes", place.path("folder/outputs.csv")).unwrap();
    place.run(&["--out", "folder", "--overwrite"]).succeeds();
    assert_eq!(fs::read_to_string(place.path("notes")).unwrap(), "kept");
    assert!(place.table("folder").1.len() > 1);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let place = Workplace::new();
    fs::write(place.path("taken"), "a file").unwrap();
    place.run(&["--out", "taken/here"]).fails(1, &["cannot create the folder", "taken"]);
}

/// The run reports the error and ends, as on a full disk.
#[cfg(unix)]
#[test]
fn file_size_limit_is_reported() {
    let place = Workplace::new();
    let command = format!("ulimit -f 1; exec {} run scene.toml", env!("CARGO_BIN_EXE_impinge"));
    let output =
        Command::new("sh").args(["-c", &command]).current_dir(place.0.path()).output().unwrap();
    Called(output).fails(1, &["cannot write", "too large"]);
}

/// Neither is written through, nor waited for.
#[cfg(unix)]
#[test]
fn hard_links_and_pipes_among_the_files_of_a_run_are_replaced() {
    let place = Workplace::new();
    fs::create_dir_all(place.path("out/HotSpot")).unwrap();
    fs::write(place.path("notes"), "kept").unwrap();
    fs::hard_link(place.path("notes"), place.path("out/HotSpot/run.json")).unwrap();
    let pipe = place.path("out/HotSpot/outputs.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    place.run(&["--overwrite", "--until", "1e-7"]).succeeds();
    assert_eq!(fs::read_to_string(place.path("notes")).unwrap(), "kept");
    assert!(place.table("out/HotSpot").1.len() > 1);
    assert!(fs::read_to_string(place.path("out/HotSpot/run.json")).unwrap().contains("\"steps\""));
}

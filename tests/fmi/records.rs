//! Recorded drops among a unit's resources: found, refused where they are damaged, and computed where they do not fit.

use std::ffi::CString;
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use impinge::fmi::guid;
use impinge::model::records;
use impinge::scene;
use impinge::variables::Registry;

use crate::master::{Arguments, Folder, Messages, OK, Unit, free};

const DROPS: &str = r#"
name = "Recorded"
stop_time = 2e-5
step = 1e-6
[body.drop]
kind = "droplet"
method = "record"
diameter = 1.25e-4
impact_velocity = 19.0
initial_temperature = 350.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = 4e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.05 }
release = "input"
most = 3
[[wall]]
name = "wall"
under = "drop"
footprint = { tiles = { count = [2, 2], size = [4e-4, 4e-4] } }
start = { temperature = 300.0 }
"#;

/// Whether a unit is made with these bytes as its record, and what is said.
fn made_with(bytes: &[u8]) -> (bool, String) {
    made_in("records", |records| fs::write(records.join("drop.record"), bytes).unwrap())
}

/// The same of a folder of resources that is filled otherwise.
fn made_in(name: &str, fill: impl FnOnce(&Path)) -> (bool, String) {
    let folder = Folder::with_scene("records", DROPS);
    let records = folder.0.join(name);
    fs::create_dir(&records).unwrap();
    fill(&records);
    let messages = Box::<Messages>::default();
    let registry = Registry::of(&scene::parse(DROPS, "scene.toml").unwrap());
    let guid = Some(CString::new(guid::guid(DROPS, &registry)).unwrap());
    let handle = Arguments { guid, ..Arguments::good(&folder) }.instantiate(&messages);
    let said = messages.take().into_iter().map(|message| message.text).collect();
    let is_made = !handle.is_null();
    if is_made {
        free(handle);
    }
    (is_made, said)
}

#[test]
fn damaged_records_are_refused() {
    let [(name, bytes)] = &records(&scene::parse(DROPS, "scene.toml").unwrap(), 1).unwrap()[..]
    else {
        panic!("one body, one record")
    };
    assert_eq!(name, "drop");
    assert_eq!(made_with(bytes), (true, String::new()));
    let mut damaged = bytes.clone();
    damaged[bytes.len() / 2] ^= 1;
    let (is_made, said) = made_with(&damaged);
    assert!(!is_made && said.contains("drop.record: the record is damaged"), "{said}");
    let (is_made, said) = made_with(&bytes[..bytes.len() - 9]);
    assert!(!is_made && said.contains("drop.record"), "{said}");
}

/// Not even the size of a file says how much is to be read of it.
#[cfg(unix)]
#[test]
fn resources_that_are_no_files_of_the_unit_are_refused_at_once() {
    use std::os::unix::fs::symlink;
    for folder in ["records", "reduced"] {
        let refused = |fill: &dyn Fn(&Path), words: &str| {
            let (is_made, said) = made_in(folder, |place| fill(&place.join("z.bytes")));
            assert!(!is_made && said.contains("z.bytes: ") && said.contains(words), "{said}");
        };
        refused(&|path| symlink("/dev/zero", path).unwrap(), "leads to /dev/zero");
        refused(&|path| symlink("nowhere", path).unwrap(), "No such file");
        refused(&|path| symlink("/etc/passwd", path).unwrap(), "leads to /etc/passwd");
        refused(&|path| fs::create_dir(path).unwrap(), "it is a folder");
        let pipe = |path: &Path| {
            assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
        };
        refused(&pipe, "a pipe, socket or device");
        // It takes no room on the disc.
        let large = |path: &Path| File::create(path).unwrap().set_len(300_000_000).unwrap();
        refused(&large, "too large (allowed: at most 256000000 bytes)");
    }
    let scene = Folder::with_scene("pipe", DROPS);
    fs::remove_file(scene.0.join("scene.toml")).unwrap();
    assert!(Command::new("mkfifo").arg(scene.0.join("scene.toml")).status().unwrap().success());
    let messages = Box::<Messages>::default();
    assert!(Arguments::good(&scene).instantiate(&messages).is_null());
    let said = messages.take();
    assert!(said[0].text.contains("a pipe, socket or device"), "{said:?}");
}

#[test]
fn a_unit_runs_without_its_record_and_with_other_parameters() {
    let unit = Unit::of_scene(DROPS);
    assert_eq!((unit.setup(0.0, None), unit.enter()), (OK, OK));
    assert_eq!(unit.set("drop.viscosity", 5e-3), OK);
    let start = Instant::now();
    assert_eq!(unit.exit(), OK);
    assert!(start.elapsed().as_secs() < 100);
    assert_eq!(unit.set("drop.release", 1.0), OK);
    for n in 0..10 {
        assert_eq!(unit.step(1e-6 * f64::from(n), 1e-6), OK);
    }
    let heat = unit.get("drop.heat");
    assert!(heat > 0.0 && heat < 1e-3);
    // A saved state goes on to the bit.
    let mut saved = unit.save();
    assert_eq!(unit.step(1e-5, 1e-6), OK);
    let later = unit.get("drop.heat");
    assert_eq!(unit.restore(saved), OK);
    assert_eq!(unit.step(1e-5, 1e-6), OK);
    assert_eq!(unit.get("drop.heat").to_bits(), later.to_bits());
    assert_eq!(unit.free_state(&mut saved), OK);
}

//! The C header, and a program in C that drives a unit through it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use impinge::scene;
use impinge::variables::ArrayRegistry;

use crate::master::{Folder, SCENE, library, own_guid, registry};

/// The types of an interface, and the files that export functions, in the standard's order.
const FMI2: [&str; 7] = [
    "types.rs",
    "common.rs",
    "variables.rs",
    "states.rs",
    "derivatives.rs",
    "step.rs",
    "model_exchange.rs",
];
const FMI3: [&str; 9] = [
    "three/types.rs",
    "three/common.rs",
    "three/variables.rs",
    "three/absent.rs",
    "three/dependencies.rs",
    "three/states.rs",
    "three/derivatives.rs",
    "three/step.rs",
    "three/other_modes.rs",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_checked_in_headers_are_what_cbindgen_makes() {
    check_header("impinge.h", "cbindgen.toml", &FMI2);
    check_header("impinge_fmi3.h", "cbindgen-fmi3.toml", &FMI3);
}

fn check_header(name: &str, settings: &str, files: &[&str]) {
    let settings = cbindgen::Config::from_file(root().join(settings)).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(settings);
    for file in files {
        builder = builder.with_src(root().join("src/fmi").join(file));
    }
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&fresh, &text).unwrap();
    let kept = root().join("include").join(name);
    let found = fs::read(&kept).unwrap_or_default();
    assert!(found == text, "out of date; run: cp {} {}", fresh.display(), kept.display());
}

#[test]
fn a_program_in_c_drives_a_unit() {
    let folder = Folder::with_scene("c", SCENE);
    let names = ["spot.pressure", "centre.stress_zz", "plate.heat_in"];
    let references = names.map(|name| registry().find(name).unwrap());
    drive("drive.c", &folder, &folder.uri(), references);
}

#[test]
fn a_program_in_c_drives_a_unit_of_fmi_3() {
    let folder = Folder::with_scene("c", SCENE);
    let arrays = ArrayRegistry::of(&scene::parse(SCENE, "scene.toml").unwrap());
    let names = ["patch.pressure", "centre.stress_zz", "plate.heat_in"];
    let references = names.map(|name| arrays.find(name).unwrap());
    drive("drive3.c", &folder, &format!("{}/", folder.0.display()), references);
}

/// Compiles a program against the headers and the library, and runs it on the unit in a folder.
fn drive(source: &str, folder: &Folder, resources: &str, references: [usize; 3]) {
    library();
    let test = env::current_exe().unwrap();
    let libraries = test.parent().unwrap();
    let program: PathBuf = folder.0.join("drive");
    let compiled = Command::new("cc")
        .args(["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
        .arg(format!("-I{}", root().join("include").display()))
        .arg(root().join("tests/fmi/c").join(source))
        .arg("-o")
        .arg(&program)
        .arg(format!("-L{}", libraries.display()))
        .arg(format!("-Wl,-rpath,{}", libraries.display()))
        .args(["-limpinge", "-lm"])
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    // Cargo names folders there that may hold an older library.
    let ran = Command::new(&program)
        .env_remove("LD_LIBRARY_PATH")
        .args([resources, &own_guid()])
        .args(references.map(|reference| reference.to_string()))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{said}");
    assert_eq!((ran.stdout.len(), &*said), (0, ""), "the unit prints nothing");
}

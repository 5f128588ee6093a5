//! The C header, and a program in C that drives a unit through it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::master::{Folder, SCENE, library, own_guid, registry};

/// The types of the interface, and the files that export functions, in the standard's order.
const EXPORTING: [&str; 7] = [
    "types.rs",
    "common.rs",
    "variables.rs",
    "states.rs",
    "derivatives.rs",
    "step.rs",
    "model_exchange.rs",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_checked_in_header_is_what_cbindgen_makes() {
    let settings = cbindgen::Config::from_file(root().join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(settings);
    for file in EXPORTING {
        builder = builder.with_src(root().join("src/fmi").join(file));
    }
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join("impinge.h");
    fs::write(&fresh, &text).unwrap();
    let kept = root().join("include/impinge.h");
    let found = fs::read(&kept).unwrap_or_default();
    assert!(found == text, "out of date; run: cp {} {}", fresh.display(), kept.display());
}

#[test]
fn a_program_in_c_drives_a_unit() {
    library();
    let test = env::current_exe().unwrap();
    let libraries = test.parent().unwrap();
    let folder = Folder::with_scene("c", SCENE);
    let program: PathBuf = folder.0.join("drive");
    let compiled = Command::new("cc")
        .args(["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
        .arg(format!("-I{}", root().join("include").display()))
        .arg(root().join("tests/fmi/c/drive.c"))
        .arg("-o")
        .arg(&program)
        .arg(format!("-L{}", libraries.display()))
        .arg(format!("-Wl,-rpath,{}", libraries.display()))
        .args(["-limpinge", "-lm"])
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let names = ["spot.pressure", "centre.stress_zz", "plate.heat_in"];
    let references = names.map(|name| registry().find(name).unwrap().to_string());
    let ran =
        Command::new(&program).args([folder.uri(), own_guid()]).args(references).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{said}");
    assert_eq!((ran.stdout.len(), &*said), (0, ""), "the unit prints nothing");
}

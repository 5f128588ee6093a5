//! The C header, and a program in C that drives a unit through it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use impinge::scene;
use impinge::variables::ArrayRegistry;

use crate::master::{Folder, SCENE, library, own_guid, registry};

/// A version's folder, its name of an instance, and what its header is made of, in the standard's order: types and
/// functions of files, and those that its table exports.
struct Interface {
    folder: &'static str,
    instance: &'static str,
    parts: &'static [Part],
}

#[derive(Clone, Copy)]
enum Part {
    File(&'static str),
    /// Rows of the table in groups of this kind.
    Rows(&'static str),
}
use Part::{File, Rows};

const FMI2: Interface = Interface {
    folder: "two",
    instance: "component",
    parts: &[
        File("types.rs"),
        File("life_cycle.rs"),
        File("variables.rs"),
        File("states.rs"),
        File("derivatives.rs"),
        File("step.rs"),
        Rows("refused"),
    ],
};
const FMI3: Interface = Interface {
    folder: "three",
    instance: "instance",
    parts: &[
        File("types.rs"),
        File("life_cycle.rs"),
        File("events.rs"),
        File("variables.rs"),
        Rows("absent"),
        File("dependencies.rs"),
        File("states.rs"),
        File("derivatives.rs"),
        File("step.rs"),
        Rows("refused"),
    ],
};

impl Interface {
    /// A file that cbindgen can read.
    fn file(&self, part: Part) -> PathBuf {
        let folder = root().join("src/fmi").join(self.folder);
        match part {
            File(name) => folder.join(name),
            Rows(group) => {
                let table = fs::read_to_string(folder.join("table.rs")).unwrap();
                let name = format!("{}_{group}.rs", self.folder);
                let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
                fs::write(&path, self.exported(&table, group)).unwrap();
                path
            }
        }
    }

    /// The functions that a table exports, as its macro does: the instance is the first argument, a status the answer.
    fn exported(&self, table: &str, group: &str) -> String {
        let start = format!("#[{group}(");
        let rows = table.split(&start).skip(1).flat_map(|group| {
            let rows = group.split_once("{\n").unwrap().1.split_once("\n    }").unwrap().0;
            rows.split_terminator(';')
        });
        let function = |row: &str| {
            let (name, arguments) = row.split_once('(').unwrap();
            let arguments = format!("{}: Handle, {arguments}", self.instance);
            format!(
                "#[unsafe(no_mangle)] pub unsafe extern \"C\" {}({arguments} -> Status {{}}\n",
                name.trim()
            )
        };
        rows.map(function).collect()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_checked_in_headers_are_what_cbindgen_makes() {
    check_header("impinge.h", "cbindgen.toml", &FMI2);
    check_header("impinge_fmi3.h", "cbindgen-fmi3.toml", &FMI3);
}

fn check_header(name: &str, settings: &str, interface: &Interface) {
    let settings = cbindgen::Config::from_file(root().join(settings)).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(settings);
    for part in interface.parts {
        builder = builder.with_src(interface.file(*part));
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

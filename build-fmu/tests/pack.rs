//! `build-fmu` replaces files atomically, and checks its inputs.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_build-fmu");
const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

fn library() -> PathBuf {
    std::env::current_exe().unwrap().with_file_name("libimpinge.so")
}

/// A folder with a scene, in which the program is called.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        fs::copy(library(), folder.path().join("lib.so")).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn shell(&self, arguments: &str) -> Output {
        Command::new("sh")
            .current_dir(self.0.path())
            .args(["-c", &format!("{PROGRAM} {arguments}")])
            .output()
            .unwrap()
    }

    #[track_caller]
    fn refused(&self, arguments: &str, words: &str) {
        let called = self.shell(arguments);
        let said = String::from_utf8_lossy(&called.stderr);
        assert_eq!(called.status.code(), Some(1), "{arguments}: {said}");
        assert!(said.contains(words) && !said.contains("panicked"), "{arguments}: {said}");
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

#[test]
fn failed_write_leaves_the_file_unchanged() {
    let place = Place::new();
    fs::write(place.path("unit.fmu"), "PK earlier").unwrap();
    let shell = Command::new("sh")
        .current_dir(place.0.path())
        .args([
            "-c",
            &format!(
                "ulimit -f 1; trap '' XFSZ; {PROGRAM} scene.toml -o unit.fmu --library lib.so"
            ),
        ])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&shell.stderr);
    assert!(!shell.status.success() && said.contains("cannot write"), "{said}");
    assert_eq!(fs::read(place.path("unit.fmu")).unwrap(), b"PK earlier");
    assert_eq!(place.names(), ["lib.so", "scene.toml", "unit.fmu"]);
    assert!(place.shell("scene.toml -o unit.fmu --library lib.so").status.success());
    assert!(fs::read(place.path("unit.fmu")).unwrap().starts_with(b"PK"));
    assert_eq!(place.names(), ["lib.so", "scene.toml", "unit.fmu"]);
}

#[test]
fn nothing_is_written_where_something_is_read() {
    let place = Place::new();
    std::os::unix::fs::symlink("scene.toml", place.path("link.fmu")).unwrap();
    fs::hard_link(place.path("lib.so"), place.path("hard.fmu")).unwrap();
    for output in ["scene.toml", "./scene.toml", "link.fmu", "lib.so", "hard.fmu"] {
        place.refused(&format!("scene.toml -o {output} --library lib.so"), "which is an input");
    }
    place.refused("scene.toml --xml scene.toml", "which is an input");
    assert_eq!(fs::read_to_string(place.path("scene.toml")).unwrap(), SCENE);
    assert_eq!(fs::read(place.path("lib.so")).unwrap(), fs::read(library()).unwrap());
}

#[test]
fn files_that_are_no_units_are_not_replaced() {
    let place = Place::new();
    for (name, target) in
        [("other.toml", "-o other.toml --library lib.so"), ("notes.txt", "--xml notes.txt")]
    {
        fs::write(place.path(name), "mine").unwrap();
        place.refused(&format!("scene.toml {target}"), "was not made by this program");
        assert_eq!(fs::read_to_string(place.path(name)).unwrap(), "mine");
    }
    fs::write(place.path("empty.fmu"), "").unwrap();
    assert!(place.shell("scene.toml -o empty.fmu --library lib.so").status.success());
    assert!(place.shell("scene.toml -o empty.fmu --library lib.so").status.success());
}

#[test]
fn a_library_of_another_build_is_not_packed() {
    let place = Place::new();
    let mut bytes = fs::read(library()).unwrap();
    let mark = b" (sources ";
    let found = bytes.windows(mark.len()).position(|window| window == mark).unwrap();
    bytes[found + mark.len()] = b'x';
    fs::write(place.path("old.so"), bytes).unwrap();
    place.refused("scene.toml --library old.so", "its sources differ from those of this program");
}

/// A library of Windows without functions: headers alone.
fn empty_dll() -> Vec<u8> {
    let mut bytes = vec![0; 328];
    let parts: [(usize, &[u8]); 7] = [
        (0, b"MZ"),
        (60, &[64]),
        (64, b"PE\0\0"),
        (68, &[0x64, 0x86]),
        (84, &[240, 0, 0x22, 0x20]),
        (88, &[0x0b, 2]),
        (196, &[16]),
    ];
    for (place, part) in parts {
        bytes[place..place + part.len()].copy_from_slice(part);
    }
    bytes
}

#[test]
fn libraries_are_those_of_their_platforms() {
    let place = Place::new();
    fs::write(place.path("empty.dll"), empty_dll()).unwrap();
    for (arguments, words) in [
        ("--library win64=lib.so", "is no shared library for win64"),
        ("--library empty.dll", "is no shared library for linux64"),
        ("--library win64=empty.dll", "does not export fmi2"),
        ("--fmi 3 --library x86_64-windows=empty.dll", "does not export fmi3"),
        ("--library lib.so --library linux64=lib.so", "two libraries are for linux64"),
        ("--platform win64 --library win64=nothing.dll", "cannot read the library nothing.dll"),
    ] {
        place.refused(&format!("scene.toml {arguments}"), words);
    }
    assert_eq!(place.shell("scene.toml --platform win32").status.code(), Some(2));
    assert_eq!(place.names(), ["empty.dll", "lib.so", "scene.toml"]);
}

/// Copies the program into the layout of an installation.
fn install(place: &Place) -> PathBuf {
    let program = place.path("bin/build-fmu");
    fs::create_dir(place.path("bin")).unwrap();
    fs::copy(PROGRAM, &program).unwrap();
    program
}

#[test]
fn installed_programs_pack_shared_libraries() {
    let place = Place::new();
    let program = install(&place);
    let pack = |arguments: &str| {
        Command::new(&program)
            .current_dir(place.0.path())
            .args(arguments.split(' '))
            .output()
            .unwrap()
    };
    let missing = pack("scene.toml");
    let said = String::from_utf8_lossy(&missing.stderr);
    assert!(!missing.status.success() && said.contains("no library for linux64 at "), "{said}");
    let shared = place.path("share/impinge");
    for platform in ["linux64", "win64"] {
        fs::create_dir_all(shared.join(platform)).unwrap();
    }
    fs::copy(library(), shared.join("linux64/libimpinge.so")).unwrap();
    fs::write(shared.join("win64/impinge.dll"), empty_dll()).unwrap();

    let packed = pack("scene.toml -o unit.fmu");
    let said = String::from_utf8_lossy(&packed.stderr);
    assert!(packed.status.success() && said.contains("the unit cannot run on win64"), "{said}");
    let files = texts(&place.path("unit.fmu"));
    let libraries: Vec<_> = files.keys().filter(|name| name.starts_with("binaries/")).collect();
    assert_eq!(libraries, ["binaries/linux64/SmallPlate.so"]);

    let required = pack("scene.toml --platform linux64 --platform win64");
    let said = String::from_utf8_lossy(&required.stderr);
    assert!(!required.status.success() && said.contains("does not export"), "{said}");
    let alone = pack("scene.toml -o alone.fmu --platform linux64");
    assert!(!String::from_utf8_lossy(&alone.stderr).contains("win64"));
    assert_eq!(
        fs::read(place.path("alone.fmu")).unwrap(),
        fs::read(place.path("unit.fmu")).unwrap()
    );
}

#[test]
fn shells_and_man_are_given_every_option() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = place.shell(&format!("--completions {shell}"));
        let script = String::from_utf8_lossy(&script.stdout).into_owned();
        assert!(script.contains("platform") && script.contains("build-fmu"), "{script}");
    }
    assert!(place.shell("--man pages").status.success());
    let page = fs::read_to_string(place.path("pages/build-fmu.1")).unwrap();
    assert!(page.starts_with(".ie") && page.contains("platform"), "{page}");
}

#[test]
fn only_a_library_of_this_program_is_packed() {
    let place = Place::new();
    fs::write(place.path("notlib.txt"), "fmi2DoStep fmi3DoStep impinge").unwrap();
    for other in ["notlib.txt", "scene.toml", PROGRAM] {
        place.refused(&format!("scene.toml --library {other}"), "is no library of impinge");
    }
    place.refused("scene.toml --library /dev/null", "a pipe, socket or device");
    assert!(!Path::new(&place.path("SmallPlate.fmu")).exists());
}

#[test]
fn what_cannot_be_printed_ends_without_a_panic() {
    let place = Place::new();
    place.refused("--lint --rules >/dev/full", "cannot print");
    place.refused("scene.toml --library lib.so >/dev/full", "cannot print");
    for quiet in ["nothing.toml 2>/dev/full", "scene.toml -o lib.so --library lib.so 2>/dev/full"] {
        assert_eq!(place.shell(quiet).status.code(), Some(1), "{quiet}");
    }
    let piped = place.shell("--lint --rules | true; echo done");
    assert_eq!((&piped.stdout[..], &piped.stderr[..]), (&b"done\n"[..], &b""[..]));
}

#[test]
fn endless_scenes_are_refused() {
    let place = Place::new();
    place.refused("/dev/zero --library lib.so", "a pipe, socket or device");
}

/// A plate below a spot, at a level.
fn leveled(constants: &str, level: &str) -> String {
    format!(
        "name = \"Leveled\"\nstop_time = 1e-3\nstep = 1e-5\n\
         fidelity = {{ level = \"{level}\", tolerance = 1e-4 }}\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ box = [2e-3, 1.6e-3, 0.4e-3] }}\n\
         material = {{ model = \"thermoelastic\", {constants} }}\ninitial_temperature = 300.0\n\
         mesh = {{ spacing = 1e-4, depth_spacing = 3e-5, growth = 1.5 }}\n\
         [body.plate.faces]\nbottom = {{ temperature = 300.0 }}\n\
         [[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\"]\n\
         footprint = {{ gaussian = {{ radius = 2e-4 }} }}\nstart = {{ heat_flux = 3e7 }}\n\
         [[probe]]\nname = \"a\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"temperature\"]\n\
         [[probe]]\nname = \"b\"\nin = \"plate\"\nat = [1e-4, 5e-5, -5e-5]\ngives = [\"temperature\"]\n"
    )
}

#[test]
fn units_are_the_same_with_and_without_stored_assessments() {
    let place = Place::new();
    let copper = "density = 8960.0, specific_heat = 385.0, conductivity = 400.0";
    let open = leveled(copper, "auto");
    let mesh = open.lines().find(|line| line.starts_with("mesh")).unwrap();
    fs::write(place.path("open.toml"), open.replace(mesh, "")).unwrap();
    let pack = |cache: &str, options: &str| {
        let packed = Command::new("sh")
            .current_dir(place.0.path())
            .env("IMPINGE_CACHE", cache)
            .args(["-c", &format!("{PROGRAM} open.toml -o open.fmu --library lib.so {options}")])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&packed.stderr).into_owned();
        assert!(packed.status.success(), "{said}");
        (said, fs::read(place.path("open.fmu")).unwrap())
    };
    let without = pack("", "");
    assert_eq!(place.names(), ["lib.so", "open.fmu", "open.toml", "scene.toml"]);
    assert!(texts(&place.path("open.fmu"))["resources/scene.toml"].contains("estimated_error"));
    for (what, options) in [("first", ""), ("again", ""), ("fresh", "--fresh")] {
        assert!(pack("cache", options) == without, "{what}");
    }
    let stored = fs::read_dir(place.path("cache/assessments")).unwrap().count();
    assert_eq!(stored, 2, "its level and its mesh");
}

/// The texts of a unit's files by their names.
fn texts(path: &Path) -> BTreeMap<String, String> {
    let mut archive = zip::ZipArchive::new(fs::File::open(path).unwrap()).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let text = |name: String| {
        let mut bytes = Vec::new();
        archive.by_name(&name).unwrap().read_to_end(&mut bytes).unwrap();
        (name, String::from_utf8_lossy(&bytes).into_owned())
    };
    names.into_iter().map(text).collect()
}

#[test]
fn open_level_is_packed_with_its_choice() {
    let place = Place::new();
    let copper = "density = 8960.0, specific_heat = 385.0, conductivity = 400.0";
    let aerogel = "density = 100.0, specific_heat = 1000.0, conductivity = 0.015";
    for (constants, level, reason) in [
        (copper, "reduced", "plate: reduced, which keeps the tolerance"),
        (aerogel, "full", "plate: full, as the bound of the error of temp"),
    ] {
        fs::write(place.path("open.toml"), leveled(constants, "auto")).unwrap();
        let packed = place.shell("open.toml -o open.fmu --library lib.so");
        let said = String::from_utf8_lossy(&packed.stderr);
        assert!(packed.status.success() && said.contains(reason), "{said}");
        let files = texts(&place.path("open.fmu"));
        let resolved = format!("[resolved.plate]\nlevel = \"{level}\"");
        assert!(files["resources/scene.toml"].contains(&resolved));
        let is_reduced = level == "reduced";
        assert_eq!(files.contains_key("resources/reduced/plate.reduced"), is_reduced);
        let description = &files["modelDescription.xml"];
        assert_eq!(description.contains("plate.error_bound_temperature"), is_reduced);
        assert_eq!(files["documentation/index.html"].contains("unknowns"), is_reduced);
        // The description alone equals that of the unit.
        assert!(place.shell("open.toml --xml open.xml").status.success());
        assert_eq!(&fs::read_to_string(place.path("open.xml")).unwrap(), description);
    }
    fs::write(place.path("tight.toml"), leveled(aerogel, "reduced")).unwrap();
    let packed = place.shell("tight.toml -o tight.fmu --library lib.so");
    let said = String::from_utf8_lossy(&packed.stderr);
    assert!(packed.status.success(), "{said}");
    assert!(said.contains("warning: plate: the bound of the error of temperatures"), "{said}");
}

//! `build-fmu --lint` finds all planted defects and nothing else; our own units are clean.
//!
//! The units carry a library of this platform, whose name occurs in paths below.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::collections::BTreeSet;
use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

#[path = "lint/hostile.rs"]
mod hostile;

const PROGRAM: &str = env!("CARGO_BIN_EXE_build-fmu");
const XML: &str = "modelDescription.xml";
const LIBRARY: &str = "binaries/linux64/SmallPlate.so";
const PAGE: &str = "documentation/index.html";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// Paths and contents of a unit, in their order; a path may come twice.
type Entries = Vec<(String, Vec<u8>)>;

fn pack(scene: &Path, folder: &TempDir) -> PathBuf {
    let library = std::env::current_exe().unwrap().with_file_name("libimpinge.so");
    let unit = folder.path().join("unit.fmu");
    let packed = Command::new(PROGRAM)
        .args([scene, Path::new("-o"), &unit, Path::new("--library"), &library])
        .output()
        .unwrap();
    assert!(packed.status.success(), "{}", String::from_utf8_lossy(&packed.stderr));
    unit
}

/// The unit of the scene that the tests of the C ABI use.
fn good() -> Entries {
    static GOOD: OnceLock<Entries> = OnceLock::new();
    let make = || {
        let folder = TempDir::new().unwrap();
        let bytes = fs::read(pack(&root().join("tests/fmi/scene.toml"), &folder)).unwrap();
        let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
        let count = archive.len();
        let entry = |at| {
            let mut file = archive.by_index(at).unwrap();
            let mut content = Vec::new();
            file.read_to_end(&mut content).unwrap();
            (file.name().unwrap().into_owned(), content)
        };
        (0..count).map(entry).collect()
    };
    GOOD.get_or_init(make).clone()
}

/// Writes a zip file with fast compression.
fn write_zip(entries: &Entries, file: &Path) {
    let mut zip = ZipWriter::new(fs::File::create(file).unwrap());
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (path, content) in entries {
        zip.start_file(path, stored).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
}

/// Exit code and text of the linter for these entries.
fn lint(entries: &Entries) -> (i32, String) {
    let folder = TempDir::new().unwrap();
    let unit = folder.path().join("unit.fmu");
    write_zip(entries, &unit);
    lint_file(&unit, &[])
}

fn lint_file(unit: &Path, more: &[&str]) -> (i32, String) {
    let said = Command::new(PROGRAM).arg("--lint").arg(unit).args(more).output().unwrap();
    assert!(said.stderr.is_empty(), "{}", String::from_utf8_lossy(&said.stderr));
    (said.status.code().unwrap(), String::from_utf8(said.stdout).unwrap())
}

/// Severity and rule of every finding.
fn rules(text: &str) -> BTreeSet<(String, String)> {
    let mut severity = "";
    let mut found = BTreeSet::new();
    for line in text.lines() {
        if let Some((word @ ("error" | "warning"), _)) = line.split_once(": ") {
            severity = word;
        }
        if let Some((_, rule)) = line.rsplit_once(" [").filter(|_| line.starts_with("  allowed")) {
            found.insert((severity.into(), rule.split(',').next().unwrap().into()));
        }
    }
    found
}

fn change_xml(entries: &mut Entries, change: impl FnOnce(&str) -> String) {
    let (_, content) = entries.iter_mut().find(|(path, _)| path == XML).unwrap();
    *content = change(std::str::from_utf8(content).unwrap()).into_bytes();
}

/// Sets an attribute that stands at or behind the text `at`.
fn set(entries: &mut Entries, at: &str, attribute: &str, value: &str) {
    change_xml(entries, |xml| {
        let (before, rest) = xml.split_at(xml.find(at).unwrap_or_else(|| panic!("no {at}")));
        let key = format!(" {attribute}=\"");
        let (middle, rest) = rest.split_once(&key).unwrap_or_else(|| panic!("no {attribute}"));
        let (_, rest) = rest.split_once('"').unwrap();
        format!("{before}{middle}{key}{value}\"{rest}")
    });
}

/// Replaces the first occurrence of a text behind another one.
fn replace(entries: &mut Entries, at: &str, old: &str, new: &str) {
    change_xml(entries, |xml| {
        let (before, rest) = xml.split_at(xml.find(at).unwrap_or_else(|| panic!("no {at}")));
        assert!(rest.contains(old), "no {old} behind {at}");
        format!("{before}{}", rest.replacen(old, new, 1))
    });
}

/// Removes the range from one text to the end of another, and returns it.
fn cut(entries: &mut Entries, from: &str, to: &str) -> String {
    let mut removed = String::new();
    change_xml(entries, |xml| {
        let start = xml.find(from).unwrap_or_else(|| panic!("no {from}"));
        let end = start + xml[start..].find(to).unwrap_or_else(|| panic!("no {to}")) + to.len();
        removed = xml[start..end].to_owned();
        format!("{}{}", &xml[..start], &xml[end..])
    });
    removed
}

/// The start tag of a variable up to its name.
fn variable(name: &str) -> String {
    format!("<ScalarVariable name=\"{name}\"")
}

fn reference_of(entries: &Entries, name: &str) -> String {
    let (_, xml) = entries.iter().find(|(path, _)| path == XML).unwrap();
    let rest = std::str::from_utf8(xml).unwrap().split_once(&variable(name)).unwrap().1;
    rest.split_once("valueReference=\"").unwrap().1.split('"').next().unwrap().to_owned()
}

type Change = fn(&mut Entries);

/// A defect: its change, the rules that must find it and part of their message.
const DEFECTS: [(&str, Change, &[&str], &str); 15] = [
    (
        "duplicate value reference",
        |unit| {
            let taken = reference_of(unit, "spot.heat_flux");
            set(unit, &variable("spot.pressure"), "valueReference", &taken);
        },
        &["value-references"],
        "ScalarVariable \"spot.pressure\": shares the value reference with \"spot.heat_flux\"",
    ),
    (
        "duplicate name",
        |unit| set(unit, &variable("spot.pressure"), "name", "spot.heat_flux"),
        &["unique-names"],
        "name \"spot.heat_flux\" is also that of ScalarVariable \"spot.heat_flux\" in line",
    ),
    (
        "start outside min and max",
        |unit| set(unit, &variable("plate.poisson"), "start", "0.7"),
        &["range"],
        "ScalarVariable \"plate.poisson\": start 0.7 is above max 0.5",
    ),
    (
        "input without start",
        |unit| replace(unit, &variable("spot.heat_flux"), " start=\"50000000.0\"", ""),
        &["start"],
        "ScalarVariable \"spot.heat_flux\": the start value is missing: the variable is an input",
    ),
    (
        "causality and variability that do not go together",
        |unit| set(unit, &variable("centre.temperature"), "variability", "fixed"),
        &["combinations"],
        "causality output with variability fixed",
    ),
    (
        "output absent from ModelStructure",
        |unit| drop(cut(unit, "<Unknown ", "/>")),
        &["outputs"],
        "is not listed",
    ),
    (
        "bad dependency index",
        |unit| set(unit, "<Outputs>", "dependencies", "99999"),
        &["dependencies"],
        "dependency 99999: there is no such variable",
    ),
    (
        "bad derivative index",
        |unit| {
            replace(unit, &variable("centre.temperature"), "<Real", "<Real derivative=\"99999\"")
        },
        &["derivative"],
        "ScalarVariable \"centre.temperature\": derivative 99999: there is no variable 99999",
    ),
    (
        "unknown unit",
        |unit| replace(unit, &variable("centre.temperature"), "<Real", "<Real unit=\"furlong\""),
        &["units"],
        "unit \"furlong\" is not defined",
    ),
    (
        "wrong GUID",
        |unit| set(unit, "<fmiModelDescription", "guid", "{1234}"),
        &["guid"],
        "modelDescription.xml:2 fmiModelDescription: guid \"{1234}\" is not that of",
    ),
    (
        "wrong modelIdentifier",
        |unit| set(unit, "<CoSimulation", "modelIdentifier", "Other"),
        &["model-identifier"],
        "binaries/linux64/ CoSimulation: modelIdentifier is \"Other\", but the folder holds \
         SmallPlate.so",
    ),
    (
        "stop before start",
        |unit| set(unit, "<DefaultExperiment", "stopTime", "-1.0"),
        &["default-experiment"],
        "DefaultExperiment: stopTime -1.0 is not after startTime 0.0",
    ),
    (
        "backslash in a path of the zip file",
        |unit| {
            let page = unit.iter_mut().find(|(path, _)| path == PAGE).unwrap();
            page.0 = PAGE.replace('/', "\\");
        },
        &["zip-paths"],
        "documentation\\index.html: the path has a backslash",
    ),
    (
        "missing binary",
        |unit| unit.retain(|(path, _)| path != LIBRARY),
        &["platforms"],
        "neither a library nor source files",
    ),
    (
        "order of elements",
        |unit| {
            let experiment = cut(unit, "<DefaultExperiment", "/>");
            replace(unit, "", "<LogCategories>", &format!("{experiment}<LogCategories>"));
        },
        &["elements"],
        "LogCategories: LogCategories stands after DefaultExperiment",
    ),
];

/// With `KEEP_DEFECTS=FOLDER` the units are kept there, for other programs.
#[test]
fn every_planted_defect_is_found_and_nothing_else() {
    let keep = std::env::var_os("KEEP_DEFECTS").map(PathBuf::from);
    for (name, change, expected, fragment) in DEFECTS {
        let mut unit = good();
        change(&mut unit);
        if let Some(folder) = &keep {
            write_zip(&unit, &folder.join(format!("{name}.fmu")));
        }
        let (code, text) = lint(&unit);
        let expected = expected.iter().map(|rule| ("error".to_owned(), (*rule).to_owned()));
        assert_eq!(rules(&text), expected.collect(), "{name}: {text}");
        assert!(text.contains(fragment), "{name}: no {fragment:?} in {text}");
        assert_eq!(code, 1, "{name}: {text}");
    }
}

#[test]
fn our_own_units_are_clean() {
    let folders = ["examples", "tests"].map(|folder| root().join(folder));
    let mut scenes = Vec::new();
    for folder in fs::read_dir(&folders[0]).unwrap() {
        scenes.push(folder.unwrap().path().join("scene.toml"));
    }
    for scene in fs::read_dir(folders[1].join("fmpy/scenes")).unwrap() {
        scenes.push(scene.unwrap().path());
    }
    scenes.retain(|scene| scene.exists());
    assert!(scenes.len() >= 8, "{scenes:?}");
    for scene in scenes {
        let folder = TempDir::new().unwrap();
        let (code, text) = lint_file(&pack(&scene, &folder), &[]);
        assert!(
            code == 0 && text.ends_with("unit.fmu: no findings\n"),
            "{}: {text}",
            scene.display()
        );
    }
}

/// Asserts the findings of a change with more specific messages than the table above.
#[track_caller]
fn finds(change: impl FnOnce(&mut Entries), expected: (&str, &str), fragments: &[&str]) {
    let mut unit = good();
    change(&mut unit);
    let (code, text) = lint(&unit);
    let (severity, rule) = expected;
    assert!(rules(&text).contains(&(severity.into(), rule.into())), "{text}");
    assert_eq!(code, i32::from(severity == "error"), "{text}");
    for fragment in fragments {
        assert!(text.contains(fragment), "no {fragment:?} in {text}");
    }
}

/// Without the mark of this program the GUID can only be checked with the library.
#[test]
fn the_library_itself_says_that_a_guid_is_wrong() {
    let change = |unit: &mut Entries| {
        set(unit, "<fmiModelDescription", "generationTool", "another tool");
        set(unit, "<fmiModelDescription", "guid", "{1234}");
    };
    let fragments =
        ["refuses to be instantiated with guid \"{1234}\"", "the master's GUID {1234} is"];
    finds(change, ("error", "guid"), &fragments);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_at_once() {
    let folder = TempDir::new().unwrap();
    let pipe = folder.path().join("pipe.fmu");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for path in [pipe.as_path(), Path::new("/dev/zero")] {
        let ran = Command::new(PROGRAM).args(["--lint", "--no-run"]).arg(path).output().unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(!ran.status.success() && said.contains("a pipe, socket or device"), "{said}");
    }
}

#[test]
fn a_library_is_left_alone_where_it_must_not_run() {
    let mut unit = good();
    set(&mut unit, "<fmiModelDescription", "generationTool", "another tool");
    set(&mut unit, "<fmiModelDescription", "guid", "{1234}");
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("unit.fmu");
    write_zip(&unit, &file);
    assert_eq!(lint_file(&file, &["--no-run"]).0, 0);
}

#[test]
fn a_library_without_the_functions_is_found() {
    let change = |unit: &mut Entries| {
        let (_, library) = unit.iter_mut().find(|(path, _)| path == LIBRARY).unwrap();
        *library = fs::read(PROGRAM).unwrap();
    };
    finds(change, ("error", "exports"), &["does not export fmi2GetTypesPlatform, fmi2GetVersion"]);
}

#[test]
fn a_library_of_another_platform_is_found() {
    let change = |unit: &mut Entries| {
        let library = unit.iter().find(|(path, _)| path == LIBRARY).unwrap().1.clone();
        unit.push(("binaries/win64/SmallPlate.dll".into(), library));
    };
    finds(change, ("error", "exports"), &["a library of Elf for X86_64", "allowed: Pe for X86_64"]);
}

#[test]
fn aliases_that_the_standard_permits_are_a_warning() {
    let change = |unit: &mut Entries| {
        let taken = reference_of(unit, "centre.stress_xx");
        set(unit, &variable("centre.stress_yy"), "valueReference", &taken);
    };
    finds(
        change,
        ("warning", "value-references"),
        &["right only if both always have the same value"],
    );
}

#[test]
fn aliases_of_different_units_are_an_error() {
    let change = |unit: &mut Entries| {
        let taken = reference_of(unit, "centre.stress_xx");
        set(unit, &variable("centre.temperature"), "valueReference", &taken);
    };
    finds(change, ("error", "value-references"), &["their units differ: K and Pa"]);
}

#[test]
fn units_of_other_versions_are_recognised() {
    let version = |version: &'static str| {
        move |unit: &mut Entries| set(unit, "<fmiModelDescription", "fmiVersion", version)
    };
    finds(version("3.0"), ("warning", "fmi-version"), &["a unit of FMI 3.0", "those of FMI 2.0"]);
    finds(version("1.0"), ("warning", "fmi-version"), &["a unit of FMI 1.0"]);
    finds(version("2"), ("error", "fmi-version"), &["fmiVersion is \"2\""]);
}

#[test]
fn broken_xml_is_found_with_its_line() {
    let change = |unit: &mut Entries| replace(unit, "", "</UnitDefinitions>", "</Units>");
    finds(change, ("error", "well-formed"), &["modelDescription.xml:", "Units"]);
    let change = |unit: &mut Entries| unit.retain(|(path, _)| path != XML);
    finds(change, ("error", "well-formed"), &["modelDescription.xml: missing from the unit"]);
}

#[test]
fn words_numbers_and_attributes_beyond_the_schema_are_found() {
    for (attribute, value, fragment) in [
        ("causality", "inout", "causality is \"inout\""),
        ("valueReference", "-1", "valueReference is \"-1\""),
        ("description", "x\" colour=\"red", "ScalarVariable has no attribute colour"),
    ] {
        let change = |unit: &mut Entries| set(unit, &variable("spot.x"), attribute, value);
        finds(change, ("error", "attributes"), &[fragment]);
    }
}

#[test]
fn paths_that_differ_only_by_case_are_a_warning() {
    let change = |unit: &mut Entries| unit.push((PAGE.replace("html", "HTML"), Vec::new()));
    finds(change, ("warning", "zip-duplicates"), &["index.HTML: the path differs from", "by case"]);
}

/// Zip libraries refuse to write a path twice, so it is inserted afterwards.
#[test]
fn duplicate_path_is_found() {
    let mut unit = good();
    unit.push((PAGE.replace("html", "htmX"), Vec::new()));
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("unit.fmu");
    write_zip(&unit, &file);
    let mut bytes = fs::read(&file).unwrap();
    for at in 0..bytes.len() - 4 {
        if bytes[at..].starts_with(b".htmX") {
            bytes[at + 4] = b'l';
        }
    }
    fs::write(&file, bytes).unwrap();
    let (code, text) = lint_file(&file, &[]);
    assert!(code == 1 && text.contains("index.html: the path stands twice"), "{text}");
}

#[test]
fn non_zip_file_is_reported() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("unit.fmu");
    fs::write(&file, "no unit").unwrap();
    let (code, text) = lint_file(&file, &[]);
    assert!(code == 1 && text.contains("error: unit: no zip file"), "{text}");
}

#[test]
fn the_rules_are_listed_with_their_sections() {
    let said = Command::new(PROGRAM).args(["--lint", "--rules"]).output().unwrap();
    let text = String::from_utf8(said.stdout).unwrap();
    assert!(said.status.success() && text.lines().count() > 20, "{text}");
    for (_, _, rules, _) in DEFECTS {
        assert!(rules.iter().all(|rule| text.contains(rule)), "{rules:?}: {text}");
    }
}

#[test]
fn an_encoding_other_than_utf_8_is_a_warning() {
    let change =
        |unit: &mut Entries| replace(unit, "", "encoding=\"UTF-8\"", "encoding=\"latin-1\"");
    finds(change, ("warning", "well-formed"), &["modelDescription.xml:1: the encoding", "latin-1"]);
}

#[test]
fn a_dependency_that_is_no_input_is_found() {
    let change = |unit: &mut Entries| set(unit, "<Outputs>", "dependencies", "1");
    finds(change, ("warning", "dependencies"), &["is a parameter"]);
    let change = |unit: &mut Entries| {
        let (_, xml) = unit.iter().find(|(path, _)| path == XML).unwrap();
        let xml = std::str::from_utf8(xml).unwrap();
        let output =
            xml.split_once("<Unknown index=\"").unwrap().1.split('"').next().unwrap().to_owned();
        set(unit, "<Outputs>", "dependencies", &output);
    };
    finds(change, ("error", "dependencies"), &["is no known"]);
    let kinds = "dependencies=\"\" dependenciesKind=\"dependent\"";
    let change = |unit: &mut Entries| replace(unit, "<Outputs>", "dependencies=\"\"", kinds);
    finds(change, ("error", "dependencies"), &["1 kinds for 0 dependencies"]);
}

#[test]
fn impossible_cells_are_found() {
    let change = |unit: &mut Entries| {
        let (_, cells) = unit.iter_mut().find(|(path, _)| path == "resources/cells.json").unwrap();
        *cells = br#"{"families": {"spot": {"footprint": "disc", "count": [-3]}}}"#.to_vec();
    };
    let words = "resources/cells.json spot: count is [-3], none of [], [n] and [n, m]";
    finds(change, ("error", "cells"), &[words]);
}

#[test]
fn source_files_that_are_not_there_are_found() {
    let list =
        "><SourceFiles><File name=\"./a.c\"/><File name=\"b.c\"/></SourceFiles></CoSimulation>";
    let change = |unit: &mut Entries| replace(unit, "<CoSimulation", "/>", list);
    finds(change, ("warning", "sources"), &["2 source files, but no folder sources"]);
    let change = |unit: &mut Entries| {
        replace(unit, "<CoSimulation", "/>", list);
        unit.push(("sources/a.c".into(), Vec::new()));
    };
    finds(change, ("error", "sources"), &["sources/b.c is not in the unit"]);
}

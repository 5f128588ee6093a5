//! Malicious units: bombs, endless lists, misleading names.

use std::fs;
use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::process::Command;

use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::{Entries, PROGRAM, XML, change_xml, good, lint, lint_file, pack, root, write_zip};

/// Asserts that the text occurs once in the findings, which include an error.
#[track_caller]
fn refused_for(entries: &Entries, words: &str) {
    let (code, text) = lint(entries);
    assert_eq!((code, text.matches(words).count()), (1, 1), "{text}");
}

#[test]
fn a_description_that_would_fill_the_memory_is_not_unpacked() {
    let folder = TempDir::new().unwrap();
    let unit = folder.path().join("bomb.fmu");
    let mut zip = ZipWriter::new(fs::File::create(&unit).unwrap());
    let packed = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    zip.start_file(XML, packed.compression_level(Some(1))).unwrap();
    let blanks = vec![b' '; 1 << 24];
    (0..33).for_each(|_| zip.write_all(&blanks).unwrap());
    zip.finish().unwrap();
    assert!(fs::metadata(&unit).unwrap().len() < 1 << 23);
    let (code, text) = lint_file(&unit, &[]);
    assert_eq!(code, 1);
    assert!(text.contains("more than 536870912 bytes when unpacked"), "{text}");
}

#[test]
fn elements_too_wide_and_too_deep_are_refused_with_their_line() {
    let mut wide = good();
    let attributes: String = (0..300_000).map(|i| format!(" q{i}=\"1\"")).collect();
    change_xml(&mut wide, |xml| {
        xml.replacen("<fmiModelDescription", &format!("<fmiModelDescription{attributes}"), 1)
    });
    refused_for(&wide, "modelDescription.xml:2: an element has more than 1000 attributes");
    let mut deep = good();
    let nest = format!("{}{}", "<a>".repeat(1_000_000), "</a>".repeat(1_000_000));
    change_xml(&mut deep, |xml| {
        xml.replacen("<ModelVariables>", &format!("{nest}<ModelVariables>"), 1)
    });
    refused_for(&deep, "elements are nested more than 1000 levels deep");
}

#[test]
fn dependencies_without_end_are_one_finding() {
    let mut entries = good();
    let list = "1 ".repeat(2_000_000);
    let unknown = format!("<Outputs><Unknown index=\"1\" dependencies=\"{list}\"/>");
    change_xml(&mut entries, |xml| xml.replacen("<Outputs>", &unknown, 1));
    refused_for(&entries, "2000000 dependencies of ");
}

#[test]
fn at_most_a_thousand_faults_of_a_kind_are_listed() {
    let mut entries = good();
    let variables: String = (0..20_000)
        .map(|i| {
            format!(
                "<ScalarVariable name=\"a b{i}\" valueReference=\"{}\"><Real/></ScalarVariable>\n",
                100_000 + i
            )
        })
        .collect();
    change_xml(&mut entries, |xml| {
        xml.replacen("</ModelVariables>", &format!("{variables}</ModelVariables>"), 1)
    });
    let (code, text) = lint(&entries);
    assert_eq!(code, 1);
    assert_eq!(text.matches("is no structured name").count(), 1000);
    assert_eq!(text.matches("and more like this, which are not listed").count(), 1, "{text}");
}

#[test]
fn many_entries_are_checked_and_too_many_refused() {
    let mut entries = good();
    entries.extend((0..60_000).map(|i| (format!("resources/f{i}"), Vec::new())));
    let (code, text) = lint(&entries);
    assert_eq!(code, 0, "{text}");
    entries.extend((60_000..200_000).map(|i| (format!("extra/f{i}"), Vec::new())));
    refused_for(&entries, "entries; at most 200000 are checked");
}

#[test]
fn no_folder_remains_even_after_a_killed_call() {
    let (folder, place) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let unit = folder.path().join("unit.fmu");
    write_zip(&good(), &unit);
    // Process numbers are smaller than this.
    let left = place.path().join("impinge-lint-999999999-x");
    let (running, foreign) = (
        place.path().join(format!("impinge-lint-{}-x", std::process::id())),
        place.path().join("impinge-lint-x"),
    );
    for folder in [&left, &running, &foreign] {
        fs::create_dir_all(folder.join("resources")).unwrap();
    }
    let said = Command::new(PROGRAM).arg("--lint").arg(&unit).env("TMPDIR", place.path()).output();
    assert!(said.unwrap().status.success());
    let mut names: Vec<PathBuf> =
        fs::read_dir(place.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    assert_eq!(names, [running, foreign]);
}

/// Flips one bit in the middle of an entry's data.
#[test]
fn every_entry_is_read() {
    let folder = TempDir::new().unwrap();
    let unit = pack(&root().join("tests/fmi/scene.toml"), &folder);
    let bytes = fs::read(&unit).unwrap();
    let mut archive = ZipArchive::new(Cursor::new(bytes.clone())).unwrap();
    for at in 0..archive.len() {
        let file = archive.by_index(at).unwrap();
        let (name, start) = (file.name().unwrap().into_owned(), file.data_start().unwrap());
        let middle = (start + file.compressed_size() / 2) as usize;
        drop(file);
        let mut bytes = bytes.clone();
        bytes[middle] ^= 0x10;
        fs::write(&unit, bytes).unwrap();
        for extra in [&[][..], &["--no-run"]] {
            let called =
                Command::new(PROGRAM).arg("--lint").arg(&unit).args(extra).output().unwrap();
            let said = String::from_utf8_lossy(&called.stdout);
            assert_eq!(called.status.code(), Some(1), "{name}: {said}");
            assert!(said.contains(&name) && said.contains("unreadable"), "{name}: {said}");
        }
    }
}

/// The bytes of a unit with a change to the entry of a path in its directory (APPNOTE.TXT of PKWARE, section 4.3.12).
fn with_directory(path: &str, change: impl Fn(&mut [u8])) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let unit = folder.path().join("unit.fmu");
    write_zip(&good(), &unit);
    let mut bytes = fs::read(&unit).unwrap();
    let mut at = bytes.windows(4).position(|four| four == b"PK\x01\x02").unwrap();
    loop {
        assert!(bytes[at..].starts_with(b"PK\x01\x02"), "{path} is not there");
        let length = |k: usize| usize::from(u16::from_le_bytes([bytes[at + k], bytes[at + k + 1]]));
        let (name, rest) = (length(28), length(30) + length(32));
        if &bytes[at + 46..at + 46 + name] == path.as_bytes() {
            change(&mut bytes[at..at + 46]);
            return bytes;
        }
        at += 46 + name + rest;
    }
}

fn lint_bytes(bytes: &[u8]) -> (i32, String) {
    let folder = TempDir::new().unwrap();
    let unit = folder.path().join("unit.fmu");
    fs::write(&unit, bytes).unwrap();
    lint_file(&unit, &["--no-run"])
}

#[test]
fn links_and_pipes_among_the_entries_are_found() {
    for path in ["resources/scene.toml", "resources/cells.json", XML] {
        for (mode, words) in [
            (0o120_777_u32, "the entry is a link"),
            (0o010_644, "the entry is neither a file nor a folder"),
        ] {
            let bytes = with_directory(path, |entry| {
                entry[40..42].copy_from_slice(&(mode as u16).to_le_bytes());
            });
            let (code, text) = lint_bytes(&bytes);
            let found = format!("error: {path}: {words}");
            assert!(code == 1 && text.contains(&found) && text.contains("[zip-links,"), "{text}");
        }
    }
}

#[test]
fn sizes_that_the_directory_invents_are_found() {
    for (said, words, rule) in [
        (3_u32, "unreadable: File is larger than its declared uncompressed size", "zip-readable"),
        (0xFFFF_FFF0, "the directory states 4294967280 bytes, but the entry has", "zip-sizes"),
    ] {
        let bytes = with_directory("resources/scene.toml", |entry| {
            entry[24..28].copy_from_slice(&said.to_le_bytes());
        });
        let (code, text) = lint_bytes(&bytes);
        let words = format!("resources/scene.toml: {words}");
        assert!(code == 1 && text.contains(&words) && text.contains(rule), "{text}");
    }
}

#[test]
fn an_entry_that_unpacks_to_a_hundred_times_its_size_is_found() {
    let folder = TempDir::new().unwrap();
    let unit = folder.path().join("bomb.fmu");
    let mut zip = ZipWriter::new(fs::File::create(&unit).unwrap());
    let packed = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (path, content) in good() {
        zip.start_file(path, packed.compression_level(Some(1))).unwrap();
        zip.write_all(&content).unwrap();
    }
    zip.start_file("resources/zeros", packed.compression_level(Some(1))).unwrap();
    let zeros = vec![0; 1 << 24];
    (0..5).for_each(|_| zip.write_all(&zeros).unwrap());
    zip.finish().unwrap();
    let (code, text) = lint_file(&unit, &["--no-run"]);
    let words = "resources/zeros: 83886080 bytes are packed in";
    assert!(code == 1 && text.contains(words) && text.contains("[zip-sizes,"), "{text}");
}

/// Other tools may keep cells of their own under that name.
#[test]
fn cells_of_other_tools_are_a_warning() {
    let mut unit = good();
    super::set(&mut unit, "<fmiModelDescription", "generationTool", "another tool");
    let (_, cells) = unit.iter_mut().find(|(path, _)| path == "resources/cells.json").unwrap();
    *cells = b"[1, 2]".to_vec();
    let (code, text) = lint(&unit);
    let words = "warning: resources/cells.json: no table families";
    assert!(code == 0 && text.contains(words), "{text}");
}

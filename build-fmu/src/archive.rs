//! The zip file of a unit: identical bytes for identical content.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Content by path; the order of paths is the order in the file.
pub type Entries = BTreeMap<String, Vec<u8>>;

/// Packs the entries. All carry the earliest time that a zip file can represent.
pub fn zip(entries: &Entries) -> Result<Vec<u8>, String> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, content) in entries {
        zip.start_file(path, options)
            .map_err(|error| error.to_string())
            .and_then(|()| zip.write_all(content).map_err(|error| error.to_string()))
            .map_err(|error| format!("cannot pack {path}: {error}"))?;
    }
    zip.finish().map(Cursor::into_inner).map_err(|error| format!("cannot pack the unit: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use zip::ZipArchive;

    #[test]
    fn entries_come_back_sorted_with_a_fixed_time() {
        let entries: Entries =
            [("b/c".into(), b"two".to_vec()), ("a".into(), b"one".to_vec())].into();
        let mut archive = ZipArchive::new(Cursor::new(zip(&entries).unwrap())).unwrap();
        let names: Vec<_> = archive.file_names().map(|name| name.unwrap()).collect();
        assert_eq!(names, ["a", "b/c"]);
        drop(names);
        let mut file = archive.by_name("b/c").unwrap();
        assert_eq!(file.last_modified(), Some(DateTime::default()));
        let mut text = String::new();
        file.read_to_string(&mut text).unwrap();
        assert_eq!(text, "two");
    }
}

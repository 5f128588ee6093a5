//! Reading of the fields that a run has written: lists of files (`.pvd`) and their arrays.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use impinge::scene::open_file;

use super::error::ReportError;

/// Largest list of files, and largest head of a field file [B].
const MOST_HEAD: u64 = 64_000_000;
/// Largest array of a field file [B].
const LARGEST_ARRAY: u64 = 1_000_000_000;
/// Begin of the numbers of a field file.
const MARKER: &[u8] = b"<AppendedData encoding=\"raw\">_";

/// A body's files over time.
pub struct Frames {
    /// Time [s] and file.
    pub files: Vec<(f64, PathBuf)>,
}

impl Frames {
    /// Reads the list of a body in a folder; `None` if there is none, or none of a time.
    pub fn read(folder: &Path, body: &str) -> Result<Option<Self>, ReportError> {
        let path = folder.join(format!("{body}.pvd"));
        if !path.is_file() {
            return Ok(None);
        }
        let mut text = String::new();
        let file = open_file(&path).map_err(ReportError::read(&path))?;
        file.take(MOST_HEAD).read_to_string(&mut text).map_err(ReportError::read(&path))?;
        let mut files = Vec::new();
        for start in elements(&text, &path)? {
            if start.name != "DataSet" {
                continue;
            }
            let time =
                start.number("timestep").ok_or_else(|| damaged(&path, "a time is missing"))?;
            let file = start.text("file").ok_or_else(|| damaged(&path, "a file is missing"))?;
            if Path::new(file).components().any(|part| !matches!(part, Component::Normal(_))) {
                return Err(damaged(&path, "a file is not in its folder"));
            }
            files.push((time, folder.join(file)));
        }
        Ok((!files.is_empty()).then_some(Self { files }))
    }

    /// At most so many of the times, evenly, with the first and the last.
    pub fn thinned(&self, most: usize) -> Vec<&(f64, PathBuf)> {
        thinned(self.files.len(), most).into_iter().map(|place| &self.files[place]).collect()
    }
}

/// At most so many of `count` places, evenly, with the first and the last.
pub fn thinned(count: usize, most: usize) -> Vec<usize> {
    if count <= most.max(2) {
        return (0..count).collect();
    }
    let most = most.max(2);
    (0..most).map(|i| i * (count - 1) / (most - 1)).collect()
}

/// A field file, whose arrays are read when they are asked for.
pub struct FieldFile {
    path: PathBuf,
    file: File,
    /// Begin of the numbers.
    begin: u64,
    arrays: BTreeMap<String, Place>,
}

/// Place of an array.
struct Place {
    offset: u64,
    components: usize,
}

/// An element without content.
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
}

impl Element {
    fn of(start: &BytesStart) -> Option<Self> {
        let mut attributes = BTreeMap::new();
        for attribute in start.attributes() {
            let attribute = attribute.ok()?;
            let key = attribute.key.as_ref().to_owned();
            let value = attribute.normalized_value(quick_xml::XmlVersion::Implicit1_0).ok()?;
            attributes.insert(key, value.into_owned());
        }
        Some(Self { name: start.name().as_ref().to_owned(), attributes })
    }

    fn text(&self, key: &str) -> Option<&str> {
        self.attributes.get(key).map(String::as_str)
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.text(key)?.parse().ok()
    }
}

/// All elements of an XML text.
fn elements(text: &str, path: &Path) -> Result<Vec<Element>, ReportError> {
    let mut reader = Reader::from_str(text);
    reader.config_mut().check_end_names = false;
    let mut found = Vec::new();
    loop {
        match reader.read_event() {
            Ok(Event::Start(start) | Event::Empty(start)) => {
                found.push(Element::of(&start).ok_or_else(|| damaged(path, "an attribute"))?);
            }
            Ok(Event::Eof) => return Ok(found),
            Ok(_) => {}
            Err(error) => return Err(damaged(path, &error.to_string())),
        }
    }
}

fn damaged(path: &Path, what: &str) -> ReportError {
    ReportError::Damaged { path: path.to_owned(), what: what.to_owned() }
}

impl FieldFile {
    /// Reads the head of a file.
    pub fn open(path: &Path) -> Result<Self, ReportError> {
        let mut file = open_file(path).map_err(ReportError::read(path))?;
        let (mut head, mut at) = (Vec::new(), None);
        let mut part = [0; 1 << 14];
        while at.is_none() {
            let count = file.read(&mut part).map_err(ReportError::read(path))?;
            if count == 0 || head.len() as u64 > MOST_HEAD {
                return Err(damaged(path, "no numbers follow its head"));
            }
            let from = head.len().saturating_sub(MARKER.len());
            head.extend_from_slice(&part[..count]);
            at = head[from..]
                .windows(MARKER.len())
                .position(|word| word == MARKER)
                .map(|i| from + i);
        }
        let at = at.unwrap_or_default();
        let text = str::from_utf8(&head[..at]).map_err(|_| damaged(path, "its head is no text"))?;
        let mut arrays = BTreeMap::new();
        for element in elements(text, path)?.iter().filter(|one| one.name == "DataArray") {
            let (Some(name), Some(offset)) = (element.text("Name"), element.number("offset"))
            else {
                continue;
            };
            let components = element.number("NumberOfComponents").unwrap_or(1.0) as usize;
            let place = Place { offset: offset as u64, components: components.max(1) };
            arrays.insert(name.to_owned(), place);
        }
        Ok(Self { path: path.to_owned(), file, begin: (at + MARKER.len()) as u64, arrays })
    }

    /// Number of components of an array, if there is one of the name.
    pub fn components(&self, name: &str) -> Option<usize> {
        self.arrays.get(name).map(|place| place.components)
    }

    /// Number of tuples of an array, if the file has it.
    pub fn length(&mut self, name: &str) -> Option<usize> {
        let at = self.begin.saturating_add(self.arrays.get(name)?.offset);
        let mut size = [0; 8];
        self.file.seek(SeekFrom::Start(at)).and_then(|_| self.file.read_exact(&mut size)).ok()?;
        Some(u64::from_le_bytes(size) as usize / 8 / self.components(name)?)
    }

    /// All numbers of an array.
    pub fn read(&mut self, name: &str) -> Result<Vec<f64>, ReportError> {
        let missing = || damaged(&self.path, &format!("there is no array `{name}`"));
        let at = self.begin.saturating_add(self.arrays.get(name).ok_or_else(missing)?.offset);
        let whole = fs::metadata(&self.path).map_err(ReportError::read(&self.path))?.len();
        let mut size = [0; 8];
        let read = |file: &mut File, at: u64, into: &mut [u8]| {
            file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(into))
        };
        read(&mut self.file, at, &mut size).map_err(ReportError::read(&self.path))?;
        let size = u64::from_le_bytes(size);
        if at.saturating_add(8).saturating_add(size) > whole {
            return Err(damaged(&self.path, &format!("the array `{name}` is cut short")));
        }
        if size > LARGEST_ARRAY {
            return Err(damaged(&self.path, &format!("the array `{name}` has {size} bytes")));
        }
        let mut bytes = vec![0; size as usize];
        read(&mut self.file, at + 8, &mut bytes).map_err(ReportError::read(&self.path))?;
        let words = bytes.chunks_exact(8);
        Ok(words.map(|word| f64::from_le_bytes(word.try_into().unwrap_or_default())).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_places_keep_both_ends() {
        assert_eq!(thinned(5, 9), [0, 1, 2, 3, 4]);
        assert_eq!(thinned(101, 5), [0, 25, 50, 75, 100]);
        assert_eq!(thinned(0, 5), [0; 0]);
        assert_eq!(thinned(7, 1), [0, 6]);
    }

    #[test]
    fn arrays_that_are_cut_short_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plate_000000.vtr");
        let head = "<VTKFile><DataArray Name=\"temperature\" offset=\"0\"/>";
        let mut bytes = [head.as_bytes(), MARKER].concat();
        bytes.extend(24u64.to_le_bytes());
        bytes.extend(300.0f64.to_le_bytes());
        fs::write(&path, &bytes).unwrap();
        let mut file = FieldFile::open(&path).unwrap();
        let refusal = file.read("temperature").unwrap_err().to_string();
        assert!(refusal.contains("cut short"), "{refusal}");
        let refusal = file.read("stress").unwrap_err().to_string();
        assert!(refusal.contains("no array `stress`"), "{refusal}");
        fs::write(&path, head).unwrap();
        assert!(FieldFile::open(&path).is_err());
    }
}

//! The zip file of a unit.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashSet};
use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use super::finding::{Fault, Place};

/// Largest number of entries of a unit, size of one of them, and total size unpacked for its library.
const MOST_ENTRIES: usize = 200_000;
const LARGEST_ENTRY: u64 = 1 << 29;
const MOST_UNPACKED: u64 = 1 << 31;

type Archive = ZipArchive<Cursor<Vec<u8>>>;

/// An entry as the zip file's directory lists it.
pub struct Entry {
    /// The path as raw bytes.
    pub path: Vec<u8>,
    /// POSIX file mode; 0 if absent.
    pub mode: u32,
}

/// Sizes of an entry in bytes: in the directory, packed, and unpacked.
pub struct Size {
    pub path: String,
    pub said: u64,
    pub packed: u64,
    pub unpacked: u64,
}

pub struct Package {
    /// Every entry; a path may come twice.
    pub entries: Vec<Entry>,
    known: HashSet<String>,
    archive: RefCell<Archive>,
}

impl Package {
    pub fn open(bytes: Vec<u8>) -> Result<Self, Fault> {
        let fault = |error: zip::result::ZipError| {
            Fault::new(Place::unit(), format!("no zip file: {error}"))
        };
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(fault)?;
        let start = usize::try_from(archive.central_directory_start()).unwrap_or(usize::MAX);
        let archive_bytes = archive.into_inner().into_inner();
        let entries = directory(&archive_bytes, start);
        if entries.len() > MOST_ENTRIES {
            let wrong = format!("{} entries; at most {MOST_ENTRIES} are checked", entries.len());
            return Err(Fault::new(Place::unit(), wrong));
        }
        let paths = entries.iter().filter_map(|entry| String::from_utf8(entry.path.clone()).ok());
        let known = paths.collect();
        let archive = ZipArchive::new(Cursor::new(archive_bytes)).map_err(fault)?;
        Ok(Self { entries, known, archive: RefCell::new(archive) })
    }

    /// The paths in valid UTF-8.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().filter_map(|entry| std::str::from_utf8(&entry.path).ok())
    }

    pub fn has(&self, path: &str) -> bool {
        self.known.contains(path)
    }

    /// The names in a folder, `folder` ending in a slash: files, and folders with a slash.
    pub fn names_in(&self, folder: &str) -> BTreeSet<String> {
        let rest = self.paths().filter_map(|path| path.strip_prefix(folder));
        let name = |rest: &str| match rest.split_once('/') {
            Some((name, _)) => format!("{name}/"),
            None => rest.to_owned(),
        };
        rest.filter(|rest| !rest.is_empty()).map(name).collect()
    }

    pub fn bytes(&self, path: &str) -> Result<Vec<u8>, Fault> {
        let fault = |error: String| Fault::new(Place::file(path), format!("unreadable: {error}"));
        if !self.has(path) {
            return Err(Fault::new(Place::file(path), "missing from the unit"));
        }
        let mut archive = self.archive.borrow_mut();
        let file = archive.by_name(path).map_err(|error| fault(error.to_string()))?;
        let mut bytes = Vec::new();
        // The size in the directory may be false.
        let mut file = file.take(LARGEST_ENTRY + 1);
        file.read_to_end(&mut bytes).map_err(|error| fault(error.to_string()))?;
        if bytes.len() as u64 > LARGEST_ENTRY {
            return Err(fault(format!("more than {LARGEST_ENTRY} bytes when unpacked")));
        }
        Ok(bytes)
    }

    /// Reads every entry to its end, which verifies its checksum, within the bounds.
    pub fn read_all(&self) -> (Vec<Size>, Vec<Fault>) {
        let mut archive = self.archive.borrow_mut();
        let (mut read, mut sizes, mut faults) = (0, Vec::new(), Vec::new());
        for at in 0..archive.len() {
            let name = archive.name_for_index(at).and_then(Result::ok);
            let path: String = name.map_or_else(|| format!("entry {at}"), Into::into);
            let fault = |wrong: String| Fault::new(Place::file(&path), wrong);
            let whole = archive.by_index(at).map_err(std::io::Error::other).and_then(|file| {
                let (said, packed) = (file.size(), file.compressed_size());
                // The size in the directory may be false.
                let unpacked =
                    std::io::copy(&mut file.take(LARGEST_ENTRY + 1), &mut std::io::sink())?;
                Ok(Size { path: path.clone(), said, packed, unpacked })
            });
            match whole {
                Ok(size) if size.unpacked > LARGEST_ENTRY => {
                    faults.push(fault(format!("more than {LARGEST_ENTRY} bytes when unpacked")));
                }
                Ok(size) => {
                    read += size.unpacked;
                    sizes.push(size);
                }
                Err(error) => faults.push(fault(format!("unreadable: {error}"))),
            }
            if read > MOST_UNPACKED {
                let wrong =
                    format!("more than {MOST_UNPACKED} bytes when unpacked; no more are read");
                faults.push(Fault::new(Place::unit(), wrong));
                break;
            }
        }
        (sizes, faults)
    }

    pub fn text(&self, path: &str) -> Result<String, Fault> {
        String::from_utf8(self.bytes(path)?)
            .map_err(|error| Fault::new(Place::file(path), format!("not UTF-8: {error}")))
    }

    /// Writes the entries below `prefix` into `folder`; skips those that would land elsewhere.
    pub fn unpack(&self, prefix: &str, folder: &Path) -> Result<(), String> {
        let below: BTreeSet<&str> =
            self.paths().filter(|path| path.starts_with(prefix) && !path.ends_with('/')).collect();
        let mut written = 0;
        for path in below {
            if path.contains('\\') || path.split('/').any(|part| part == "..") {
                continue;
            }
            let target = folder.join(path);
            let write = || {
                std::fs::create_dir_all(target.parent().unwrap_or(folder))?;
                let bytes = self.bytes(path).map_err(|fault| std::io::Error::other(fault.wrong))?;
                std::fs::write(&target, &bytes).map(|()| bytes.len() as u64)
            };
            let unpacked = write();
            written += unpacked.map_err(|error| format!("cannot unpack {path}: {error}"))?;
            if written > MOST_UNPACKED {
                return Err(format!("more than {MOST_UNPACKED} bytes below {prefix}"));
            }
        }
        Ok(())
    }
}

/// Walks the central directory. A `ZipArchive` stores every path once, so it would hide duplicates. Layout: APPNOTE.TXT
/// of PKWARE, section 4.3.12.
fn directory(bytes: &[u8], start: usize) -> Vec<Entry> {
    const HEADER: usize = 46;
    let mut entries = Vec::new();
    let mut rest = bytes.get(start..).unwrap_or_default();
    while rest.len() >= HEADER && rest.starts_with(b"PK\x01\x02") {
        let length = |at: usize| usize::from(u16::from_le_bytes([rest[at], rest[at + 1]]));
        let (path, extra, comment) = (length(28), length(30), length(32));
        let Some(found) = rest.get(HEADER..HEADER + path) else { break };
        let mode = u32::from(u16::from_le_bytes([rest[40], rest[41]]));
        entries.push(Entry { path: found.to_owned(), mode });
        rest = rest.get(HEADER + path + extra + comment..).unwrap_or_default();
    }
    entries
}

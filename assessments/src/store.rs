//! The files of the store: one for each assessment, written at once, the oldest removed beyond a total size.

use std::fs::{self, DirEntry};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use impinge::scene::bytes_of;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::folder;
use super::key::Key;
use super::record::{from_bytes, to_bytes};

/// Largest size of all files together [B].
pub const MOST_BYTES: u64 = 64 << 20;
/// Largest size of a file [B].
const MOST_BYTES_OF_ONE: u64 = 16 << 20;
/// Ends of the names of complete files, and beginnings of those being written.
const COMPLETE: &str = ".assessment";
const UNFINISHED: &str = ".assessment-part-";

/// Assessments of scenes in files; without a folder, nothing is found and nothing kept.
pub struct Store {
    folder: Option<PathBuf>,
    is_read: bool,
    most_bytes: u64,
}

impl Store {
    /// Opens the store of the user. With `fresh`, assessments are made anew and replace those stored.
    pub fn of_user(fresh: bool) -> Self {
        Self { is_read: !fresh, ..Self::in_folder(folder::of_user()) }
    }

    fn in_folder(folder: Option<PathBuf>) -> Self {
        Self { folder, is_read: true, most_bytes: MOST_BYTES }
    }

    pub(super) fn get<T: DeserializeOwned>(&self, key: &Key) -> Option<T> {
        let folder = self.folder.as_ref().filter(|_| self.is_read)?;
        from_bytes(key, &bytes_of(&file(folder, key), MOST_BYTES_OF_ONE).ok()?)
    }

    /// Stores a content unless it is too large or the folder refuses it.
    pub(super) fn put<T: Serialize + DeserializeOwned + PartialEq>(&self, key: &Key, content: &T) {
        let Some(folder) = &self.folder else { return };
        let Some(bytes) = to_bytes(key, content) else { return };
        if bytes.len() as u64 <= MOST_BYTES_OF_ONE && write(folder, key, &bytes).is_ok() {
            remove_oldest(folder, self.most_bytes);
        }
    }
}

fn file(folder: &Path, key: &Key) -> PathBuf {
    folder.join(format!("{}{COMPLETE}", key.0))
}

/// Writes a file under a name of its own first: readers and other writers see it whole or not at all.
fn write(folder: &Path, key: &Key, bytes: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut unfinished = tempfile::Builder::new().prefix(UNFINISHED).tempfile_in(folder)?;
    unfinished.write_all(bytes)?;
    unfinished.persist(file(folder, key))?;
    Ok(())
}

/// Removes the oldest files of the store while all together exceed a size; other files in the folder stay.
fn remove_oldest(folder: &Path, most_bytes: u64) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut files: Vec<_> = entries.flatten().filter_map(|entry| size_and_time(&entry)).collect();
    let mut total: u64 = files.iter().map(|(_, size, _)| size).sum();
    files.sort_by_key(|(time, ..)| *time);
    for (_, size, path) in files {
        if total <= most_bytes {
            break;
        }
        // Another process may have removed it.
        let _ = fs::remove_file(path);
        total -= size;
    }
}

fn size_and_time(entry: &DirEntry) -> Option<(SystemTime, u64, PathBuf)> {
    let name = entry.file_name().into_string().ok()?;
    let data = entry.metadata().ok()?;
    let is_own = data.is_file() && (name.ends_with(COMPLETE) || name.starts_with(UNFINISHED));
    is_own.then_some((data.modified().ok()?, data.len(), entry.path()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
    use std::time::Duration;
    use tempfile::TempDir;

    fn key(number: usize) -> Key {
        Key(format!("{number:04}"))
    }

    fn store(folder: &TempDir) -> Store {
        Store::in_folder(Some(folder.path().join("store")))
    }

    fn names(folder: &TempDir) -> Vec<String> {
        let entries = fs::read_dir(folder.path().join("store")).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn content_is_found_under_its_key_alone_and_not_by_a_fresh_start() {
        let folder = TempDir::new().unwrap();
        let store = store(&folder);
        assert_eq!(store.get::<String>(&key(1)), None);
        store.put(&key(1), &"found".to_owned());
        assert_eq!(store.get(&key(1)), Some("found".to_owned()));
        assert_eq!(store.get::<String>(&key(2)), None);
        let fresh = Store { is_read: false, ..store };
        assert_eq!(fresh.get::<String>(&key(1)), None);
        fresh.put(&key(1), &"anew".to_owned());
        assert_eq!(Store { is_read: true, ..fresh }.get(&key(1)), Some("anew".to_owned()));
        assert_eq!(names(&folder), ["0001.assessment"]);
    }

    #[test]
    fn oldest_files_go_beyond_the_total_size_and_foreign_files_stay() {
        let folder = TempDir::new().unwrap();
        let mut store = store(&folder);
        let content = "x".repeat(1000);
        let place = |name: &str| folder.path().join("store").join(name);
        for number in 0..4 {
            store.put(&key(number), &content);
            let age = Duration::from_secs(100 - number as u64);
            let file =
                File::options().write(true).open(place(&format!("{}.assessment", key(number).0)));
            file.unwrap().set_modified(SystemTime::now() - age).unwrap();
        }
        fs::write(place("letter.txt"), "x".repeat(5000)).unwrap();
        fs::write(place(".assessment-part-killed"), "x".repeat(1000)).unwrap();
        let old = File::options().write(true).open(place(".assessment-part-killed")).unwrap();
        old.set_modified(SystemTime::now() - Duration::from_secs(1000)).unwrap();
        store.most_bytes = 3500;
        store.put(&key(4), &content);
        assert_eq!(
            names(&folder),
            ["0002.assessment", "0003.assessment", "0004.assessment", "letter.txt"]
        );
    }

    #[test]
    fn folder_that_refuses_files_is_ignored() {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("store"), "a file").unwrap();
        let store = store(&folder);
        store.put(&key(1), &1.0);
        assert_eq!(store.get::<f64>(&key(1)), None);
        let nowhere = Store::in_folder(None);
        nowhere.put(&key(1), &1.0);
        assert_eq!(nowhere.get::<f64>(&key(1)), None);
    }

    #[test]
    fn concurrent_writers_and_readers_see_whole_files() {
        let folder = TempDir::new().unwrap();
        let store = store(&folder);
        let content = |writer: usize| vec![writer as f64; 20_000];
        store.put(&key(1), &content(0));
        std::thread::scope(|scope| {
            for writer in 0..4 {
                let store = &store;
                scope.spawn(move || (0..20).for_each(|_| store.put(&key(1), &content(writer))));
            }
            for _ in 0..100 {
                let read: Vec<f64> = store.get(&key(1)).unwrap();
                assert_eq!(read, content(read[0] as usize));
            }
        });
        assert_eq!(names(&folder), ["0001.assessment"]);
    }
}

//! Locks of folders.

use std::fs::{self, File, TryLockError};
use std::path::Path;
use std::process;

use super::OutputError;

/// Exclusive lock of a folder for one writer, of this process or another. It is released when dropped, and by the
/// system when the process ends.
pub struct FolderLock {
    file: Option<File>,
    /// Process that took the lock. A forked child shares the lock and must not release it.
    process: u32,
}

impl FolderLock {
    /// Takes the lock; creates the folder if it is missing. Where the system cannot lock folders, there is no
    /// exclusion.
    pub fn take(folder: &Path) -> Result<Self, OutputError> {
        fs::create_dir_all(folder).map_err(OutputError::at("create the folder", folder))?;
        let locked = |file| Self { file, process: process::id() };
        let Ok(file) = File::open(folder) else { return Ok(locked(None)) };
        match file.try_lock() {
            Ok(()) => Ok(locked(Some(file))),
            Err(TryLockError::WouldBlock) => Err(OutputError::Busy { folder: folder.to_owned() }),
            Err(TryLockError::Error(_)) => Ok(locked(None)),
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // A forked process may also hold the file open.
        if let Some(file) = self.file.as_ref().filter(|_| self.process == process::id()) {
            let _ = file.unlock();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_has_one_writer_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fields");
        let first = FolderLock::take(&path).unwrap();
        let refused = FolderLock::take(&path).err().unwrap().to_string();
        assert!(refused.contains("another run is writing"), "{refused}");
        drop(first);
        FolderLock::take(&path).unwrap();
    }

    #[test]
    fn fork_leaves_the_lock_to_its_parent() {
        let folder = tempfile::tempdir().unwrap();
        let own = FolderLock::take(folder.path()).unwrap();
        let file = own.file.as_ref().map(|file| file.try_clone().unwrap());
        drop(FolderLock { file, process: process::id().wrapping_add(1) });
        assert!(FolderLock::take(folder.path()).is_err());
        drop(own);
        FolderLock::take(folder.path()).unwrap();
    }
}

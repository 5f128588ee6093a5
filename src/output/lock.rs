use std::fs::{self, File, TryLockError};
use std::path::Path;
use std::process;

use super::OutputError;

/// Keeps a folder for one writer, of this process or another; let go when dropped, and by the system when
/// the process ends.
pub struct FolderLock {
    file: Option<File>,
    /// Process that took it. One that was forked from it shares the lock, and must not let it go.
    process: u32,
}

impl FolderLock {
    /// Creates the folder where it is missing. Where the system locks no folders, everybody may write.
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
        // A forked process may have the file open, too.
        if let Some(file) = self.file.as_ref().filter(|_| self.process == process::id()) {
            let _ = file.unlock();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_one_writer_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("fields");
        let first = FolderLock::take(&path).unwrap();
        let refused = FolderLock::take(&path).err().unwrap().to_string();
        assert!(refused.contains("another run is writing"), "{refused}");
        drop(first);
        FolderLock::take(&path).unwrap();
    }

    #[test]
    fn a_forked_process_leaves_the_lock_to_its_parent() {
        let folder = tempfile::tempdir().unwrap();
        let own = FolderLock::take(folder.path()).unwrap();
        let file = own.file.as_ref().map(|file| file.try_clone().unwrap());
        drop(FolderLock { file, process: process::id().wrapping_add(1) });
        assert!(FolderLock::take(folder.path()).is_err());
        drop(own);
        FolderLock::take(folder.path()).unwrap();
    }
}

use std::fs::{self, File, TryLockError};
use std::path::Path;

use super::OutputError;

/// Keeps a folder for one writer, of this process or another; let go when dropped, and by the system when
/// the process ends.
pub struct FolderLock(Option<File>);

impl FolderLock {
    /// Creates the folder where it is missing. Where the system locks no folders, everybody may write.
    pub fn take(folder: &Path) -> Result<Self, OutputError> {
        fs::create_dir_all(folder).map_err(OutputError::at("create the folder", folder))?;
        let Ok(file) = File::open(folder) else { return Ok(Self(None)) };
        match file.try_lock() {
            Ok(()) => Ok(Self(Some(file))),
            Err(TryLockError::WouldBlock) => Err(OutputError::Busy { folder: folder.to_owned() }),
            Err(TryLockError::Error(_)) => Ok(Self(None)),
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // A forked process may have the file open, too.
        if let Some(file) = &self.0 {
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
}

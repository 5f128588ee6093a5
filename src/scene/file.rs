//! Reads external files: regular ones only, up to a maximum size.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// Opens a regular file, or a link to one. Refuses pipes and devices: they may be endless, or block the reader.
pub fn open_file(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // Without this flag, opening a pipe without writer blocks.
        options.custom_flags(libc::O_NONBLOCK);
    }
    let file = options.open(path)?;
    let kind = file.metadata()?.file_type();
    if kind.is_file() {
        return Ok(file);
    }
    let (found, reason) = match kind.is_dir() {
        true => ("a folder", io::ErrorKind::IsADirectory),
        false => ("a pipe, socket or device", io::ErrorKind::InvalidInput),
    };
    Err(io::Error::new(reason, format!("it is {found} (allowed: a regular file)")))
}

/// Reads a regular file of at most `most` bytes.
pub fn bytes_of(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // The reported size need not be true.
    open_file(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("the file is too large (allowed: at most {most} bytes)");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn file_is_read_up_to_the_bound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, b"12345").unwrap();
        assert_eq!(bytes_of(&path, 5).unwrap(), b"12345");
        let refused = bytes_of(&path, 4).unwrap_err().to_string();
        assert!(refused.contains("too large (allowed: at most 4 bytes)"), "{refused}");
    }

    #[cfg(unix)]
    #[test]
    fn pipes_devices_and_folders_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for path in [&pipe, &link] {
            let refused = bytes_of(path, 5).unwrap_err().to_string();
            assert!(refused.contains("a pipe, socket or device"), "{refused}");
        }
        let refused = bytes_of(folder.path(), 5).unwrap_err().to_string();
        assert!(refused.contains("a folder"), "{refused}");
    }
}

//! Files that are either whole or not there.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::OutputError;

/// Writes a temporary file next to `path` and renames it once it is complete; leaves no temporary file. A link is
/// replaced, not written through.
///
/// # Errors
/// If the file cannot be written; the one that was there is then unchanged.
pub fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    // A unique name, in case another series is written to the same folder.
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(format!(".part{}_{count}", process::id()));
    let fill = || {
        let mut out = BufWriter::new(File::create(&unfinished)?);
        write(&mut out)?;
        out.flush()?;
        drop(out);
        fs::rename(&unfinished, path)
    };
    fill().map_err(|reason| {
        let _ = fs::remove_file(&unfinished);
        OutputError::at("write", path)(reason)
    })
}

//! Place of the store.

use std::env;
use std::path::PathBuf;

/// Environment variable with the folder of everything stored for a user; empty for none.
const VARIABLE: &str = "IMPINGE_CACHE";

/// Folder of the assessments; `None` if the user wants none, or if the system names no place.
pub fn of_user() -> Option<PathBuf> {
    let folder = match env::var_os(VARIABLE) {
        Some(own) if own.is_empty() => return None,
        Some(own) => own.into(),
        None => of_system()?,
    };
    Some(folder.join("assessments"))
}

#[cfg(windows)]
fn of_system() -> Option<PathBuf> {
    Some(absolute("LOCALAPPDATA")?.join("impinge").join("cache"))
}

#[cfg(target_vendor = "apple")]
fn of_system() -> Option<PathBuf> {
    Some(absolute("HOME")?.join("Library/Caches/impinge"))
}

/// By the XDG Base Directory Specification 0.8, which has relative paths ignored.
#[cfg(not(any(windows, target_vendor = "apple")))]
fn of_system() -> Option<PathBuf> {
    let caches = absolute("XDG_CACHE_HOME").or_else(|| Some(absolute("HOME")?.join(".cache")));
    Some(caches?.join("impinge"))
}

fn absolute(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute())
}

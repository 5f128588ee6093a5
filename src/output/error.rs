//! Errors of output.

use std::io;
use std::path::{Path, PathBuf};

use crate::model::ModelError;

/// Reasons why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The operating system refused.
    #[error("cannot {action} {}: {reason}", path.display())]
    File { action: &'static str, path: PathBuf, reason: io::Error },
    #[error(
        "another run is writing to {}; allowed: another folder, or to wait for its end",
        folder.display()
    )]
    Busy { folder: PathBuf },
    /// A written file was removed, or replaced by another one.
    #[error("{} was removed or replaced during the run", path.display())]
    Gone { path: PathBuf },
    /// The value to be written could not be computed.
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error("{name}: {reason}")]
    Value { name: String, reason: ModelError },
}

impl OutputError {
    /// Converts the operating system's reason into an error with the attempted action and its path.
    pub(super) fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |reason| Self::File { action, path, reason }
    }
}

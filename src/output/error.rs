use std::io;
use std::path::{Path, PathBuf};

use crate::model::ModelError;

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The operating system refused.
    #[error("cannot {action} {}: {reason}", path.display())]
    File { action: &'static str, path: PathBuf, reason: io::Error },
    /// The value that was to be written could not be computed.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl OutputError {
    /// Turns the operating system's reason into an error that says what was tried, and where.
    pub(super) fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |reason| Self::File { action, path, reason }
    }
}

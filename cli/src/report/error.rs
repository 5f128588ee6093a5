use std::io;
use std::path::{Path, PathBuf};

use impinge::output::OutputError;

/// Reasons why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error("cannot read {}: {reason}", path.display())]
    Read { path: PathBuf, reason: io::Error },
    #[error("cannot write {}: {reason}", path.display())]
    Write { path: PathBuf, reason: io::Error },
    #[error("{}: {what}; allowed: the file as a run has written it", path.display())]
    Damaged { path: PathBuf, what: String },
    #[error(
        "{} is not the folder of a run: it has no run.json; allowed: a scene (.toml), or a folder that `impinge run` of \
         this version has written",
        path.display()
    )]
    NoRun { path: PathBuf },
    #[error("{}: format {found} of a newer or older version; allowed: {allowed}", path.display())]
    Format { path: PathBuf, found: u32, allowed: u32 },
    #[error("{}: {reason}; allowed: a document of format {allowed}", path.display())]
    Document { path: PathBuf, reason: serde_json::Error, allowed: u32 },
    #[error("{} exists; allowed: another name (-o), or --overwrite", path.display())]
    Exists { path: PathBuf },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("cannot write the document: {0}")]
    Json(#[from] serde_json::Error),
}

impl ReportError {
    pub fn read(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |reason| Self::Read { path: path.to_owned(), reason }
    }

    pub fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |reason| Self::Write { path: path.to_owned(), reason }
    }
}

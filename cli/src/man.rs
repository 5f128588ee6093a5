use std::fs;
use std::path::PathBuf;

use clap::{Args, CommandFactory};

use super::{Arguments, CliError};

/// Write manual pages, impinge.1 and one for each command, to a folder; `man -l FOLDER/impinge.1` shows the first
#[derive(Args)]
pub struct Man {
    /// Created if missing
    folder: PathBuf,
}

impl Man {
    pub fn execute(&self) -> Result<String, CliError> {
        let pages = || clap_mangen::generate_to(Arguments::command(), &self.folder);
        let written = fs::create_dir_all(&self.folder).and_then(|()| pages());
        let reason = |reason| CliError::Pages { folder: self.folder.clone(), reason };
        written.map(|()| String::new()).map_err(reason)
    }
}

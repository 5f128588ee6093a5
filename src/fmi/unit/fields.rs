//! Field files that a unit writes during a run.

use std::path::Path;

use super::Unit;
use crate::fmi::gate::answer::Status;
use crate::output::{Discs, FieldSeries, FolderLock};
use crate::runtime::thread::aside;

impl Unit {
    /// Opens the field files if they are requested, and writes the present fields.
    pub fn open_series(&mut self) -> Status {
        let Some(run) = self.run.as_ref().filter(|_| !self.directory.is_empty()) else {
            return Status::Ok;
        };
        // Relative to the host's present directory, which may change later.
        let named = Path::new(&self.directory);
        let directory = std::path::absolute(named).unwrap_or_else(|_| named.to_owned());
        let open = || {
            let lock = FolderLock::take(&directory)?;
            Ok((FieldSeries::create(&directory, &run.model, Discs::Sections)?, lock))
        };
        match aside(open) {
            Ok(series) => {
                self.series = Some(series);
                self.write_fields()
            }
            Err(error) => self.warn_of_output(&error),
        }
    }

    /// Writes the present fields.
    pub fn write_fields(&mut self) -> Status {
        let (Some((series, _)), Some(run)) = (&mut self.series, &mut self.run) else {
            return Status::Ok;
        };
        let state = &self.state;
        match aside(|| series.write(&run.model, state, &mut run.cache)) {
            Ok(()) => Status::Ok,
            Err(error) => self.warn_of_output(&error),
        }
    }
}

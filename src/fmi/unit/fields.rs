//! Files of fields that a unit writes as it goes.

use std::path::Path;

use super::Unit;
use crate::fmi::gate::answer::Status;
use crate::output::{FieldSeries, FolderLock};
use crate::runtime::thread::aside;

impl Unit {
    /// Opens the files of fields if they are wanted, and writes the present ones.
    pub fn open_series(&mut self) -> Status {
        let Some(run) = self.run.as_ref().filter(|_| !self.directory.is_empty()) else {
            return Status::Ok;
        };
        // Where the host is now: it may go elsewhere.
        let named = Path::new(&self.directory);
        let directory = std::path::absolute(named).unwrap_or_else(|_| named.to_owned());
        let open = || {
            let lock = FolderLock::take(&directory)?;
            Ok((FieldSeries::create(&directory, &run.model)?, lock))
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

//! Field files that a unit writes during a run.

use std::path::Path;

use super::Unit;
use crate::fmi::gate::answer::Status;
use crate::output::{Discs, FieldSeries, FolderLock, OutputError};
use crate::runtime::thread::aside;

/// The field files of a run, and the lock of their folder against other writers while the run goes on.
pub struct Series {
    files: FieldSeries,
    lock: Option<FolderLock>,
}

impl Series {
    /// Releases the folder; a restored state may go on with the files.
    pub fn release(&mut self) {
        self.lock = None;
    }

    /// Discards the times after `time` [s], when a state of that time was restored.
    pub fn go_back(&mut self, time: f64) -> Result<(), OutputError> {
        if self.lock.is_none() {
            self.lock = Some(FolderLock::take(self.files.directory())?);
        }
        self.files.go_back(time)
    }
}

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
            let files = FieldSeries::create(&directory, &run.model, Discs::Sections)?;
            Ok(Series { files, lock: Some(lock) })
        };
        match aside(open) {
            Ok(series) => {
                self.series = Some(series);
                self.write_fields()
            }
            Err(error) => self.warn_of_output(&error),
        }
    }

    /// Writes the present fields, unless another writer has taken the folder.
    pub fn write_fields(&mut self) -> Status {
        let held = self.series.as_mut().filter(|series| series.lock.is_some());
        let (Some(series), Some(run)) = (held, &mut self.run) else { return Status::Ok };
        let state = &self.state;
        match aside(|| series.files.write(&run.model, state, &mut run.cache)) {
            Ok(()) => Status::Ok,
            Err(error) => self.warn_of_output(&error),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::ptr::null_mut;

    use super::*;

    /// A run that has ended goes on from a state of its middle: files of earlier times stay as they are.
    #[test]
    fn files_of_earlier_times_outlast_the_end_of_a_run() {
        let folder = tempfile::tempdir().unwrap();
        let mut unit = Unit::for_tests();
        unit.directory = folder.path().display().to_string();
        unit.enter_initialization().unwrap();
        unit.finish_initialization().unwrap();
        unit.step(0.0, 1e-8).unwrap();
        let saved = unit.save(null_mut()).unwrap();
        unit.step(1e-8, 1e-8).unwrap();
        unit.terminate().unwrap();
        let path = |n: usize| folder.path().join(format!("plate_{n:06}.vtr"));
        let before = [0, 1].map(|n| fs::read(path(n)).unwrap());
        assert!(path(2).exists());
        // The folder is free after the end of the run.
        drop(FolderLock::take(folder.path()).unwrap());
        unit.restore(saved).unwrap();
        assert_eq!([0, 1].map(|n| fs::read(path(n)).unwrap()), before);
        assert!(!path(2).exists());
        assert!(FolderLock::take(folder.path()).is_err());
        unit.step(1e-8, 2e-8).unwrap();
        let list = fs::read_to_string(folder.path().join("plate.pvd")).unwrap();
        assert_eq!(list.matches("<DataSet").count(), 3, "{list}");
        assert!(path(2).exists());
    }
}

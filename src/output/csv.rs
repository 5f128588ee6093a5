//! Variables over time as comma-separated values.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::OutputError;
use crate::model::{Cache, Model, State};
use crate::variables::{Registry, Slot, Variable};

/// All inputs and outputs over time as comma-separated values (RFC 4180), one row per time.
///
/// Each row is passed to the operating system at once, so an interrupted run loses at most its last row. Numbers have
/// the shortest form that reads back to the same bits.
pub struct CsvTable {
    path: PathBuf,
    file: File,
    columns: Vec<(String, Slot)>,
    /// Values of the last row.
    values: Vec<f64>,
}

impl CsvTable {
    /// Creates the file (and its folder if missing), and writes the header.
    pub fn create(path: &Path, model: &Model) -> Result<Self, OutputError> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(OutputError::at("create the folder", folder))?;
        }
        // A link is replaced, not written through, and a pipe would wait for its reader.
        if path.symlink_metadata().is_ok() {
            fs::remove_file(path).map_err(OutputError::at("replace", path))?;
        }
        let file = File::create_new(path).map_err(OutputError::at("create", path))?;
        let mut header = vec!["time [s]".to_owned()];
        let mut columns = Vec::new();
        for variable in Registry::of(model.scene()).variables {
            if matches!(variable.slot, Slot::Input(_) | Slot::Output(_)) {
                header.push(quoted(&title(&variable)).into_owned());
                columns.push((variable.name, variable.slot));
            }
        }
        let mut table = Self { path: path.to_owned(), file, columns, values: Vec::new() };
        table.write_row(&header)?;
        Ok(table)
    }

    /// Checks that the file still exists where it was created.
    pub fn check_present(&self) -> Result<(), OutputError> {
        if is_at(&self.file, &self.path) {
            return Ok(());
        }
        Err(OutputError::Gone { path: self.path.clone() })
    }

    /// Appends the row of one state.
    pub fn write(
        &mut self,
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<(), OutputError> {
        let mut reader = model.reader(state, cache)?;
        self.values.clear();
        for (name, column) in &self.columns {
            match column {
                Slot::Input(at) => self.values.push(state.inputs[*at]),
                Slot::Output(output) => {
                    let failed = |reason| OutputError::Value { name: name.clone(), reason };
                    self.values.push(reader.value(output).map_err(failed)?);
                }
                Slot::Parameter(_) | Slot::Threads | Slot::OutputDirectory => {}
            }
        }
        let row: Vec<_> =
            [&state.time].into_iter().chain(&self.values).map(|&x| number(x)).collect();
        self.write_row(&row)
    }

    /// Names of the columns after that of the time, and values of the last row.
    pub fn last_row(&self) -> impl Iterator<Item = (&str, f64)> {
        self.columns.iter().map(|(name, _)| name.as_str()).zip(self.values.iter().copied())
    }

    fn write_row(&mut self, fields: &[String]) -> Result<(), OutputError> {
        let mut line = fields.join(",");
        line.push('\n');
        self.file.write_all(line.as_bytes()).map_err(OutputError::at("write", &self.path))
    }
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |data: fs::Metadata| (data.dev(), data.ino());
    let [own, there] = [file.metadata(), fs::metadata(path)].map(|data| data.map(place).ok());
    own.is_some() && own == there
}

#[cfg(not(unix))]
fn is_at(_file: &File, path: &Path) -> bool {
    path.exists()
}

/// Name and unit of a variable, as the title of its column.
fn title(variable: &Variable) -> String {
    let unit = variable.quantity.map_or("1", |quantity| quantity.unit());
    format!("{} [{unit}]", variable.name)
}

/// The shortest decimal that reads back to the same bits.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Quotes a field whose text would otherwise be split.
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n']) {
        format!("\"{}\"", field.replace('"', "\"\"")).into()
    } else {
        field.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        for value in [0.1 + 0.2, 1e-8, 293.15, -3.0e11, f64::MIN_POSITIVE, f64::MAX, -0.0] {
            let back: f64 = number(value).parse().unwrap();
            assert_eq!(back.to_bits(), value.to_bits(), "{value}");
        }
    }

    #[test]
    fn names_with_commas_stay_one_column() {
        assert_eq!(quoted("surface.temperature[1,2] [K]"), "\"surface.temperature[1,2] [K]\"");
        assert_eq!(quoted("spot.heat_flux [W/m2]"), "spot.heat_flux [W/m2]");
    }
}

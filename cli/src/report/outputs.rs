//! The table of variables over time that a run has written.

use std::collections::HashMap;
use std::path::Path;

use super::error::ReportError;

/// Name of the first column.
const TIME: &str = "time [s]";

/// Columns of a table by the names of their variables.
pub struct Outputs {
    /// [s]
    pub times: Vec<f64>,
    columns: Vec<Vec<f64>>,
    places: HashMap<String, usize>,
}

impl Outputs {
    /// Reads a table. A last row without a line end, as of a run that was killed, is left out.
    pub fn read(path: &Path) -> Result<Self, ReportError> {
        let damaged = |what: String| ReportError::Damaged { path: path.to_owned(), what };
        let text = super::text_of(path)?;
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(whole.as_bytes());
        let head = reader.headers().map_err(|error| damaged(error.to_string()))?.clone();
        if head.get(0) != Some(TIME) {
            return Err(damaged(format!("its first column is not `{TIME}`")));
        }
        let variable =
            |title: &str| title.rsplit_once(" [").map_or(title, |(name, _)| name).to_owned();
        let places = head.iter().skip(1).enumerate().map(|(place, title)| (variable(title), place));
        let places = places.collect();
        let mut table =
            Self { times: Vec::new(), columns: vec![Vec::new(); head.len() - 1], places };
        for record in reader.records() {
            let record = record.map_err(|error| damaged(error.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            if record.len() != head.len() {
                let (found, wanted) = (record.len(), head.len());
                return Err(damaged(format!("line {line}: {found} values for {wanted} columns")));
            }
            let number = |text: &str| {
                text.parse::<f64>()
                    .map_err(|_| damaged(format!("line {line}: {text:?} is no number")))
            };
            table.times.push(number(&record[0])?);
            for (column, text) in table.columns.iter_mut().zip(record.iter().skip(1)) {
                column.push(number(text)?);
            }
        }
        match table.times.is_empty() {
            true => Err(damaged("it has no rows".to_owned())),
            false => Ok(table),
        }
    }

    /// Values of a variable in all rows.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        self.places.get(name).map(|place| self.columns[*place].as_slice())
    }

    /// Its last value.
    pub fn last(&self, name: &str) -> Option<f64> {
        self.values(name)?.last().copied()
    }

    /// Its first value.
    pub fn first(&self, name: &str) -> Option<f64> {
        self.values(name)?.first().copied()
    }
}

/// Smallest and largest finite value; `None` without any.
pub fn extent(values: &[f64]) -> Option<[f64; 2]> {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    finite.fold(None, |ends: Option<[f64; 2]>, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn table(text: &str) -> Result<Outputs, ReportError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("outputs.csv");
        fs::write(&path, text).unwrap();
        Outputs::read(&path)
    }

    #[test]
    fn variables_go_by_their_names_without_units() {
        let text = "time [s],a.b [K],\"f.t[1,2] [W/m2]\"\n0.0,1.0,2.0\n1e-7,3.0,4.0\n";
        let table = table(text).unwrap();
        assert_eq!(table.times, [0.0, 1e-7]);
        assert_eq!(table.values("a.b").unwrap(), [1.0, 3.0]);
        assert_eq!(table.last("f.t[1,2]"), Some(4.0));
        assert_eq!(table.values("c"), None);
    }

    #[test]
    fn incomplete_last_rows_are_left_out() {
        for rest in ["1.0", "1.0,2.7", "\"1.0"] {
            let torn = table(&format!("time [s],a [K]\n0.0,1.0\n{rest}")).unwrap();
            assert_eq!(torn.times, [0.0], "{rest}");
        }
        let refusal = table("time [s],a [K]\n0.0\n1.0,2.0\n").err().unwrap().to_string();
        assert!(refusal.contains("line 2: 1 values for 2 columns"), "{refusal}");
        assert!(table("time [s],a [K]\n").is_err());
        assert!(table("t,a\n0,1\n").is_err());
        let refusal = table("time [s],a [K]\n0.0,x\n").err().unwrap().to_string();
        assert!(refusal.contains("line 2") && refusal.contains("\"x\""), "{refusal}");
    }
}

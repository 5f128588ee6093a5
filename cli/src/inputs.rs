//! Inputs over time from a table of comma-separated values.

use std::collections::BTreeSet;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use impinge::limits::number;
use impinge::model::State;
use impinge::runtime::available_memory;
use impinge::scene::{self, Scene};
use impinge::variables::{Quantity, Registry, Slot, Variable};
use impinge::warning;

use super::set::{self, InputValue, SetError};

/// Interpolation of inputs between the rows of a table
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Between {
    /// Linear, except for counts
    #[default]
    Linear,
    /// Constant at the value of the previous row
    Held,
}

/// Fractions of the path between the ends of a position's values at which it is sampled.
const SAMPLES: usize = 64;

/// Columns of inputs over time. Before the first row and after the last the inputs are constant; two rows at one time
/// are a jump.
#[derive(Debug, Clone, PartialEq)]
pub struct InputTable {
    path: PathBuf,
    between: Between,
    /// Indices in a state's inputs of each column: several where a name represents an array.
    columns: Vec<Vec<usize>>,
    /// Columns that are always piecewise constant: counts.
    counted: Vec<bool>,
    /// Times [s], ascending.
    times: Vec<f64>,
    /// Values of the columns, one row per time.
    rows: Vec<Vec<f64>>,
}

/// Errors of a table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable { path: PathBuf, reason: csv::Error },
    #[error("cannot read {}: {reason}", path.display())]
    Unopened { path: PathBuf, reason: io::Error },
    #[error("{}:{line}: this is no text; allowed: UTF-8", path.display())]
    NotText { path: PathBuf, line: usize },
    #[error("{}:{line}: {cells} cells under a header of {titles}; allowed: {titles}", path.display())]
    Cells { path: PathBuf, line: u64, cells: usize, titles: usize },
    #[error("{} has more than {most} bytes; allowed: fewer rows, as inputs change linearly between them", path.display())]
    TooLarge { path: PathBuf, most: u64 },
    #[error("{}: no first column `time`; allowed: `time` or `time [s]`, then names of inputs", path.display())]
    NoTime { path: PathBuf },
    #[error("{}: no rows; allowed: at least one time with values", path.display())]
    Empty { path: PathBuf },
    #[error("{}, column `{column}`: {reason}", path.display())]
    Column { path: PathBuf, column: String, reason: String },
    #[error("{}:{line}, column `{column}`: {reason}", path.display())]
    Value { path: PathBuf, line: u64, column: String, reason: String },
}

impl InputTable {
    /// Reads a table of the inputs of a scene's unit; `set` are names already set elsewhere.
    pub fn read(path: &Path, between: Between, scene: &Scene) -> Result<Self, TableError> {
        let unreadable = |reason| TableError::Unreadable { path: path.to_owned(), reason };
        let text = text_of(path)?;
        check_text(path, &text)?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_slice());
        let header = reader.headers().map_err(unreadable)?.clone();
        let registry = Registry::of(scene);
        let columns = columns(path, &header, &registry)?;
        let mut table = Self {
            path: path.to_owned(),
            between,
            columns: columns.iter().map(|variables| places(variables)).collect(),
            counted: columns.iter().map(|of| of[0].quantity == Some(Quantity::Count)).collect(),
            times: Vec::new(),
            rows: Vec::new(),
        };
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let line = || line_of(&record, &text);
            let (cells, titles) = (record.len(), header.len());
            if cells != titles {
                return Err(TableError::Cells {
                    path: path.to_owned(),
                    line: line(),
                    cells,
                    titles,
                });
            }
            let refuse = |column: usize, reason: String| TableError::Value {
                path: path.to_owned(),
                line: line(),
                column: header.get(column).unwrap_or_default().to_owned(),
                reason,
            };
            let time = table.next_time(&record[0]).map_err(|reason| refuse(0, reason))?;
            let value = |(i, variables): (usize, &Vec<&Variable>)| {
                set::number(variables[0], &record[i + 1])
                    .map_err(|error| refuse(i + 1, error.to_string()))
            };
            let row = columns.iter().enumerate().map(value).collect::<Result<_, _>>()?;
            table.times.push(time);
            table.rows.push(row);
        }
        match table.rows.is_empty() {
            true => Err(TableError::Empty { path: path.to_owned() }),
            false => Ok(table),
        }
    }

    /// Parses and checks the time of a further row.
    fn next_time(&self, text: &str) -> Result<f64, String> {
        let time = text.parse().ok().filter(|time: &f64| time.is_finite());
        let time = time.ok_or_else(|| format!("{text} is no time; allowed: a number [s]"))?;
        let mut before = self.times.iter().rev();
        let [last, second] = [before.next(), before.next()];
        if last.is_some_and(|last| time < *last) {
            return Err(format!("{text} s lies before the row above; allowed: ascending times"));
        }
        if second.is_some_and(|second| time == *second) {
            return Err(format!(
                "{text} s occurs in a third row; allowed: two rows at one time, for a jump"
            ));
        }
        Ok(time)
    }

    /// A warning about rows that a run to `stop` [s] never reaches, or a note about values kept after the last row.
    pub fn remark(&self, path: &Path, stop: f64) -> Option<(&'static str, String)> {
        let (first, last) = (*self.times.first()?, *self.times.last()?);
        let file = path.display();
        if first >= stop {
            let [stop, first] = [stop, first].map(number);
            let warning = warning::run_ends_before_rows(stop, first).at(file.to_string());
            return Some(("warning", warning.to_string()));
        }
        if first > 0.0 {
            let message = format!(
                "{file}: the values of the first row, at {} s, hold from the start: they replace those that the \
                 scene starts with",
                number(first)
            );
            return Some(("note", message));
        }
        let ends_early =
            self.between == Between::Linear && 0.0 < last && last < COVERED_SHARE * stop;
        ends_early.then(|| {
            (
                "note",
                format!(
                    "{file}: the values of the last row hold from {} s to {} s",
                    number(last),
                    number(stop)
                ),
            )
        })
    }

    /// Indices of the inputs in the table.
    pub fn given(&self) -> impl Iterator<Item = usize> + '_ {
        self.columns.iter().flatten().copied()
    }

    /// Number of rows within a run that ends at `stop` [s], each of which may cut a step.
    pub fn rows_until(&self, stop: f64) -> usize {
        self.times.iter().filter(|time| (0.0..stop).contains(*time)).count()
    }

    /// The inputs of each row.
    pub fn rows(&self) -> impl Iterator<Item = Vec<InputValue>> + '_ {
        self.rows.iter().map(|row| {
            let columns = self.columns.iter().zip(row);
            columns.flat_map(|(places, &value)| places.iter().map(move |&at| (at, value))).collect()
        })
    }

    /// The smallest and the largest value of each input.
    pub fn extremes(&self) -> Vec<InputValue> {
        let of_column = |(column, places): (usize, &Vec<usize>)| {
            let values = || self.rows.iter().map(|row| row[column]);
            let ends = [
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            ];
            places.iter().flat_map(move |&place| ends.map(|end| (place, end))).collect::<Vec<_>>()
        };
        self.columns.iter().enumerate().flat_map(of_column).collect()
    }

    /// The smallest and the largest value of each input, and intermediate values of positions. A point in the middle of
    /// a path may be farther from the fine part of a mesh than both of its ends.
    pub fn samples(&self, scene: &Scene) -> Vec<InputValue> {
        let registry = Registry::of(scene);
        let is_length = |place: usize| {
            let mut own = registry.variables.iter().filter(|v| v.slot == Slot::Input(place));
            own.any(|variable| variable.quantity == Some(Quantity::Length))
        };
        let mut samples = self.extremes();
        if self.between == Between::Linear {
            let passed: Vec<InputValue> = samples
                .chunks_exact(2)
                .filter(|ends| is_length(ends[0].0))
                .flat_map(|ends| {
                    let (place, [low, high]) = (ends[0].0, [ends[0].1, ends[1].1]);
                    let at = move |n: usize| low + (high - low) * n as f64 / SAMPLES as f64;
                    (1..SAMPLES).map(move |n| (place, at(n)))
                })
                .collect();
            samples.extend(passed);
        }
        samples
    }

    /// Times of rows between two others, all in seconds.
    pub fn times_within(&self, from: f64, to: f64) -> Vec<f64> {
        let slack = ROUNDING * (to - from);
        let inside = |time: &&f64| **time > from + slack && **time < to - slack;
        let mut times: Vec<f64> = self.times.iter().filter(inside).copied().collect();
        times.dedup();
        times
    }

    /// Names the rows that bound a part of a step between two times [s].
    pub fn rows_at(&self, from: f64, to: f64) -> String {
        let is_row = |time: &f64| self.times.contains(time);
        let times: Vec<String> = [from, to]
            .into_iter()
            .filter(is_row)
            .map(|time| format!("{} s", number(time)))
            .collect();
        format!("{}, row at {}", self.path.display(), times.join(" and at "))
    }

    /// Stores in a state the values and derivatives between two times [s] without a row between them.
    pub fn apply(&self, state: &mut State, from: f64, to: f64) {
        let slack = ROUNDING * (to - from);
        let next = self.times.partition_point(|time| *time <= from + slack);
        let before = next.saturating_sub(1);
        let later = self.rows.get(next).filter(|_| next > 0 && self.between == Between::Linear);
        let mut rates = vec![0.0; state.inputs.len()];
        for (column, places) in self.columns.iter().enumerate() {
            let start = self.rows[before][column];
            let (value, rate) = match later {
                Some(later) if !self.counted[column] => {
                    let rate = (later[column] - start) / (self.times[next] - self.times[before]);
                    (start + rate * (from - self.times[before]), rate)
                }
                _ => (start, 0.0),
            };
            for &place in places {
                (state.inputs[place], rates[place]) = (value, rate);
            }
        }
        state.derivatives = if later.is_some() { vec![rates] } else { Vec::new() };
    }
}

/// Share of a run that a table must cover to avoid a note.
const COVERED_SHARE: f64 = 0.999;

/// Line of a record that was read from a text; the reader's own is where it stood, before empty lines.
fn line_of(record: &csv::StringRecord, text: &[u8]) -> u64 {
    let stood = record.position().map_or(0, csv::Position::byte) as usize;
    let empty = text[stood..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
    let before = text[..stood + empty].iter().filter(|&&byte| byte == b'\n').count();
    1 + before as u64
}

/// Refuses bytes that are not text, and names the line of the first.
fn check_text(path: &Path, text: &[u8]) -> Result<(), TableError> {
    let Err(error) = std::str::from_utf8(text) else { return Ok(()) };
    let breaks = text[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
    Err(TableError::NotText { path: path.to_owned(), line: breaks + 1 })
}

/// Largest size of a table in bytes: some million rows.
const LARGEST: u64 = 100_000_000;
/// Upper bound on the memory of a table over its size.
const SPREAD: u64 = 8;

/// Reads a file, if the machine has enough memory for it.
fn text_of(path: &Path) -> Result<Vec<u8>, TableError> {
    let unopened = |reason| TableError::Unopened { path: path.to_owned(), reason };
    let most = LARGEST.min(available_memory() as u64 / SPREAD);
    let too_large = || TableError::TooLarge { path: path.to_owned(), most };
    scene::bytes_of(path, most).map_err(|reason| match reason.kind() {
        ErrorKind::FileTooLarge => too_large(),
        _ => unopened(reason),
    })
}

/// Tolerance of computed times, as a fraction of a step.
const ROUNDING: f64 = 1e-9;

/// The variables of each column after the first.
fn columns<'a>(
    path: &Path,
    header: &csv::StringRecord,
    registry: &'a Registry,
) -> Result<Vec<Vec<&'a Variable>>, TableError> {
    let mut titles = header.iter();
    if !matches!(titles.next(), Some("time" | "time [s]")) {
        return Err(TableError::NoTime { path: path.to_owned() });
    }
    let mut known = BTreeSet::new();
    let column = |title: &str| {
        let refuse =
            |reason| TableError::Column { path: path.to_owned(), column: title.to_owned(), reason };
        let variables = named(registry, title).map_err(refuse)?;
        let twice = variables.iter().find(|variable| !known.insert(variable.name.clone()));
        match twice {
            Some(variable) => Err(refuse(format!("{} has a column already", variable.name))),
            None => Ok(variables),
        }
    };
    titles.map(column).collect()
}

/// The inputs that a title, `NAME` or `NAME [UNIT]`, denotes.
fn named<'a>(registry: &'a Registry, title: &str) -> Result<Vec<&'a Variable>, String> {
    let (name, unit) = match title.rsplit_once(" [") {
        Some((name, unit)) => (name, unit.strip_suffix(']')),
        None => (title, None),
    };
    let variables = set::targets(registry, name).map_err(|error: SetError| error.to_string())?;
    let Slot::Input(_) = variables[0].slot else {
        return Err(format!(
            "{name} is a fixed parameter; allowed: inputs (or --set {name}=VALUE)"
        ));
    };
    let own = variables[0].quantity.map_or("1", |quantity| quantity.unit());
    match unit {
        Some(unit) if unit != own => Err(format!("{name} is measured in {own}; allowed: [{own}]")),
        _ => Ok(variables),
    }
}

fn places(variables: &[&Variable]) -> Vec<usize> {
    let place = |variable: &&Variable| match variable.slot {
        Slot::Input(place) => Some(place),
        _ => None,
    };
    variables.iter().filter_map(place).collect()
}

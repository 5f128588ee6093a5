//! Lowest and highest values of outputs over a run.

use std::collections::BTreeMap;
use std::fmt::Write;

use impinge::body::Reading;
use impinge::model::Model;
use impinge::scene::Scene;
use impinge::variables::{ArrayRegistry, Quantity, Registry, Slot, Variable};
use impinge::warning::Warning;

use super::summary::shown;
use super::table::table;

/// Most outputs that a report lists.
const MOST: usize = 30;

/// Range of an output over the rows of a run, or of all places of a field.
struct Range {
    name: String,
    /// Number of places.
    places: usize,
    /// Number of its body.
    body: usize,
    quantity: Quantity,
    lowest: f64,
    highest: f64,
    /// Value of the last row; of a field the highest.
    last: f64,
}

/// Ranges of probes, fields, flaws, the extremes of solids, and the totals of lattices and solids of large strain.
pub struct Ranges {
    ranges: Vec<Range>,
    /// Range of each column of a run's table, if it has one.
    columns: Vec<Option<usize>>,
}

impl Ranges {
    pub fn of(scene: &Scene) -> Self {
        let registry = Registry::of(scene);
        let (mut ranges, mut columns) = (Vec::new(), Vec::new());
        for array in ArrayRegistry::of(scene).variables {
            let elements = array.elements(&registry);
            let [first, ..] = elements else { continue };
            if !matches!(first.slot, Slot::Input(_) | Slot::Output(_)) {
                continue;
            }
            let range = followed(scene, first).map(|(body, quantity)| Range {
                name: array.name.clone(),
                places: elements.len(),
                body,
                quantity,
                lowest: f64::INFINITY,
                highest: f64::NEG_INFINITY,
                last: f64::NAN,
            });
            columns.extend(elements.iter().map(|_| range.is_some().then_some(ranges.len())));
            ranges.extend(range);
        }
        Self { ranges, columns }
    }

    /// Takes in a row of the table.
    pub fn update(&mut self, values: impl Iterator<Item = f64>) {
        self.ranges.iter_mut().for_each(|range| range.last = f64::NEG_INFINITY);
        for (place, value) in self.columns.iter().zip(values) {
            let Some(place) = place else { continue };
            let range = &mut self.ranges[*place];
            range.lowest = range.lowest.min(value);
            range.highest = range.highest.max(value);
            range.last = range.last.max(value);
        }
    }

    /// Warns of temperatures at which constants of the library do not hold, once for each body.
    pub fn warnings(&self, model: &Model) -> Vec<Warning> {
        let mut hottest: BTreeMap<usize, f64> = BTreeMap::new();
        for range in self.ranges.iter().filter(|range| range.quantity == Quantity::Temperature) {
            let own = hottest.entry(range.body).or_insert(range.highest);
            *own = own.max(range.highest);
        }
        let warning = |(body, value)| model.warning_on_temperature(body, value);
        hottest.into_iter().filter_map(warning).collect()
    }

    /// Formats the ranges as a table, probes first; empty without any. `is_whole` is set if each step has a row.
    pub fn table(&self, is_whole: bool) -> String {
        let row = |range: &Range| {
            let value = |value| shown(value, range.quantity);
            let name = match range.places {
                1 => range.name.clone(),
                places => format!("{} ({places} places)", range.name),
            };
            let [lowest, highest, last] = [range.lowest, range.highest, range.last].map(value);
            [name, lowest, highest, last]
        };
        let rows: Vec<_> = self.ranges.iter().take(MOST).map(row).collect();
        let when = if is_whole { "over time" } else { "in the rows written" };
        let mut text = table([when, "lowest", "highest", "at the end"], &rows);
        if let Some(further) = self.ranges.len().checked_sub(MOST).filter(|further| *further > 0) {
            let _ = writeln!(text, "  {further} more in outputs.csv");
        }
        text
    }
}

/// The body and the quantity of a variable whose range is followed.
fn followed(scene: &Scene, variable: &Variable) -> Option<(usize, Quantity)> {
    let Slot::Output(output) = &variable.slot else { return None };
    let quantity = variable.quantity?;
    let is_followed = match output.reading {
        Reading::Point { .. } | Reading::Mean { .. } | Reading::Flaw { .. } => true,
        Reading::Total(_) => {
            let body = scene.body.keys().nth(output.body);
            body.is_some_and(|name| match scene.solid(name) {
                Some(_) => matches!(quantity, Quantity::Temperature | Quantity::Stress),
                None => is_loaded(scene, name),
            })
        }
        _ => false,
    };
    is_followed.then_some((output.body, quantity))
}

/// Returns true for bodies whose totals are histories of a test: lattices and solids of large strain.
pub fn is_loaded(scene: &Scene, name: &str) -> bool {
    scene.large_strain(name).is_some() || scene.lattices().any(|(own, _)| own == name)
}

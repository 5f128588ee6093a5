//! Warnings of the moments of a run: what is past again when it ends counts as well.

use std::collections::BTreeMap;

use impinge::model::{Model, State};
use impinge::variables::Output;
use impinge::warning::Warning;

use super::units::engineering;

/// Warnings of a run by their subjects.
pub struct Passing {
    /// Outputs whose values are examined, by their names.
    outputs: BTreeMap<String, Output>,
    found: BTreeMap<String, Passed>,
}

/// Rule that counts at the end alone: every drop is a thin film for a while.
const OF_FILMS: &str = "film_height_unresolved";

/// A warning of a span of a run.
struct Passed {
    warning: Warning,
    /// First and last moment at which there was reason for it [s].
    first: f64,
    last: f64,
}

impl Passing {
    pub fn of(model: &Model) -> Self {
        Self { outputs: model.watched_outputs().collect(), found: BTreeMap::new() }
    }

    /// Takes in the state after a step.
    pub fn see_state(&mut self, model: &Model, state: &State) {
        for warning in model.warnings(state) {
            let subject = warning.subject().to_owned();
            self.see(subject, warning, state.time);
        }
    }

    /// Takes in the values of a row at a time [s].
    pub fn see_values<'a>(
        &mut self,
        model: &Model,
        row: impl Iterator<Item = (&'a str, f64)>,
        time: f64,
    ) {
        for (name, value) in row {
            let output = self.outputs.get(name);
            let warning = output.and_then(|output| model.warning_on_value(output, value));
            if let Some(warning) = warning {
                self.see(name.to_owned(), warning, time);
            }
        }
    }

    fn see(&mut self, subject: String, warning: Warning, time: f64) {
        let now = Passed { warning: warning.clone(), first: time, last: time };
        let passed = self.found.entry(subject).or_insert(now);
        (passed.warning, passed.last) = (warning, time);
    }

    /// All warnings at a time [s] that ends a run; those without reason any more say when there was one.
    pub fn at_end(&self, end: f64) -> Vec<Warning> {
        let at = |(subject, Passed { warning, first, last }): (&String, &Passed)| {
            if *last >= end {
                return warning.clone();
            }
            let [first, until] = [first, last].map(|time| engineering(*time, "s"));
            let span = if first == until { first } else { format!("{first} to {until}") };
            let place = format!("{}, {span}", warning.place());
            warning.finding().clone().at(place).of_subject(subject)
        };
        let counts = |(_, Passed { warning, last, .. }): &(&String, &Passed)| {
            *last >= end || warning.finding().id != OF_FILMS
        };
        self.found.iter().filter(counts).map(at).collect()
    }
}

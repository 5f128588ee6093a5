//! Notes on a reduced solid: its order, its bounds, and whether they keep the tolerance.

use super::ReducedBody;
use super::values::Kind;
use crate::warning::{self, Finding};

/// Kinds of values in words, with their units.
const KINDS: [(Kind, &str, &str); 4] = [
    (Kind::Temperature, "temperatures", "K"),
    (Kind::Stress, "stress components", "Pa"),
    (Kind::Displacement, "displacements", "m"),
    (Kind::Heat, "amounts of heat stored", "J"),
];

impl ReducedBody {
    pub(super) fn own_notes(&self) -> Vec<String> {
        let system = self.system();
        let mut notes = vec![format!(
            "{}: reduced from {} modes to {} unknowns; it has its probes and fields alone, and no extremes of the body",
            self.name,
            self.reduction.modes,
            system.order()
        )];
        for (kind, words, unit) in KINDS.into_iter().filter(|kind| self.kinds.contains(&kind.0)) {
            let places = (0..self.kinds.len()).filter(|&place| self.kinds[place] == kind);
            let of_place = |place: usize| {
                self.drives.largest(&self.start, |j| system.bounds[place * system.inputs + j])
            };
            let bound = places.map(of_place).fold(0.0, f64::max);
            notes.push(if self.start.iter().all(|&size| size == 0.0) {
                let part = self.relative_bound(kind);
                format!(
                    "{}: by the reduction, errors of {words} are at most {part:.1e} of their range under each input alone",
                    self.name
                )
            } else {
                format!(
                    "{}: by the reduction, errors of {words} are at most {bound:.2e} {unit} under inputs no larger than \
                     at the start",
                    self.name
                )
            });
        }
        notes
    }

    /// Warns of the kind of values whose bound exceeds the tolerance most, with a remedy.
    pub(super) fn finding_beyond_tolerance(&self, remedy: &str) -> Option<Finding> {
        let errors = self.kinds.iter().zip(&self.reduction.errors);
        let (kind, error) = errors.max_by(|a, b| a.1.total_cmp(b.1))?;
        // A rounding margin counts as within the tolerance.
        if *error <= self.tolerance * (1.0 + super::ROUNDING) {
            return None;
        }
        let (_, words, _) = KINDS.into_iter().find(|own| own.0 == *kind)?;
        let (error, tolerance) = (format!("{error:.1e}"), format!("{:e}", self.tolerance));
        Some(warning::reduction_beyond_tolerance(words, error, tolerance, remedy))
    }

    /// Largest bound of the values of a kind, over the largest of their responses to the same drive until the end of
    /// the experiment.
    fn relative_bound(&self, kind: Kind) -> f64 {
        let system = self.system();
        let own = || (0..self.kinds.len()).filter(|&place| self.kinds[place] == kind);
        let of_drive = |j: usize| {
            let largest = |values: &[f64]| {
                own().map(|place| values[place * system.inputs + j]).fold(0.0, f64::max)
            };
            let range = largest(&system.ranges);
            let bound = self.drives.spread(j) * largest(&system.bounds);
            if range > 0.0 { bound / range } else { 0.0 }
        };
        (0..system.inputs).map(of_drive).fold(0.0, f64::max)
    }
}

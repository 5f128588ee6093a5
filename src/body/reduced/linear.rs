//! Derivatives of the readings of a reduced solid, exact as its equations are scalar.

use super::totals::{Total, total};
use super::values::Kind;
use super::{Measured, ReducedBody, ReducedMemo, STORED, drives_of, reduced};
use crate::body::{BodyError, Linear, Memo, Reading};

impl ReducedBody {
    /// Rate of a bound as drives change that are larger than ever before.
    fn rate_of_bound(&self, state: &[f64], [drives, changes]: [&[f64]; 2], kind: Kind) -> f64 {
        let [.., first] = self.places();
        let grows = |((size, drive), change): ((&f64, &f64), &f64)| match drive.abs() > *size {
            true => drive.signum() * change,
            false => 0.0,
        };
        let rates: Vec<f64> = state[first..].iter().zip(drives).zip(changes).map(grows).collect();
        let largest = self.bound(&self.sizes(state, drives), kind);
        largest.map_or(0.0, |(place, _)| self.system().bound(&rates, place))
    }
}

impl Linear for ReducedBody {
    fn change(&self, inputs: &[f64], rates: &[f64]) -> Memo {
        let moves_what_is_held = self.drives.fixed.iter().any(|(index, ..)| rates[*index] != 0.0);
        Box::new(ReducedMemo { drives: self.drives.changes(inputs, rates), moves_what_is_held })
    }

    fn rates(&self, state: &[f64], memo: &Memo, change: &Memo) -> Vec<f64> {
        let (drives, changes) = (drives_of(memo), drives_of(change));
        let mut rates = self.system().rates_of(self.unknowns(state), drives);
        rates.push(self.system().at_once(changes, STORED));
        rates.push(self.reduction.brought.iter().zip(drives).map(|(b, u)| b * u).sum());
        // The largest sizes so far stay constant until a step is made.
        rates.resize(self.len(), 0.0);
        rates
    }

    fn read_rate(
        &self,
        (state, memo): (&[f64], &mut Memo),
        (rates, change): (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError> {
        if reduced(change).moves_what_is_held {
            return Err(BodyError::NoRate);
        }
        let (drives, changes) = (drives_of(memo), drives_of(change));
        let system = self.system();
        let rate = |place: usize| system.output(self.unknowns(rates), changes, place);
        Ok(match *reading {
            Reading::Point { quantity, at, .. } => {
                let now = |place: usize| self.output(state, drives, place);
                match self.measure((quantity, at), rate) {
                    Measured::Plain(rate) => rate,
                    Measured::Stress(_, of, rates) => match self.measure((quantity, at), now) {
                        Measured::Stress(_, _, stress) => of(stress, rates),
                        Measured::Plain(_) => unreachable!("a quantity has one measure"),
                    },
                }
            }
            Reading::Mean { field, cell, .. } => rate(self.values.mean(field, cell)),
            Reading::Total(place) => match total(place) {
                Total::Bound(kind) => self.rate_of_bound(state, [drives, changes], kind),
                _ => self.total(rates, drives, place),
            },
            Reading::Peak { .. } | Reading::Flaw { .. } | Reading::Cell { .. } | Reading::Error => {
                // It has neither running maxima nor flaws nor a wall, and its bounds report its error.
                return Err(BodyError::NoSuchReading);
            }
        })
    }
}

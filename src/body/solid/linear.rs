//! Derivatives of readings of a solid, with respect to the inputs at one moment and to time.
//!
//! Between steps a solid is linear in its unknowns and loads, so a change of these passes through the functions of the
//! outputs themselves. Only von Mises and principal stresses and the extremes of a body need the chain rule. There are
//! no finite differences.

use super::memo::SolidMemo;
use super::point::point_quantities;
use super::reader::SolidReader;
use super::{SolidBody, flaw_reading, totals};
use crate::body::{BodyError, Linear, Memo, PeakPart, Reading};

/// A solid and its change.
pub struct SolidChange<'a> {
    pub now: SolidReader<'a>,
    pub change: SolidReader<'a>,
}

impl SolidChange<'_> {
    /// [K/s], or per unit of the quantity that changes.
    pub fn max_temperature_rate(&mut self) -> f64 {
        let Self { now, change } = self;
        let body = now.body;
        let temperatures = now.memo.heat(body, now.state);
        body.solid.max_temperature_rate(temperatures, change.memo.heat(body, change.state))
    }

    /// Rates of the highest von Mises and the largest principal stress.
    pub fn max_stress_rate(&mut self) -> Result<[f64; 2], BodyError> {
        let Self { now, change } = self;
        let body = now.body;
        let fields = now.memo.solve(body, now.state)?;
        Ok(body.solid.max_stress_rate(fields, change.memo.solve(body, change.state)?))
    }

    /// Rate of the risk of failure under the present stress.
    pub fn present_risk_rate(&mut self) -> Result<f64, BodyError> {
        let Self { now, change } = self;
        let body = now.body;
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        let fields = now.memo.solve(body, now.state)?;
        let rates = change.memo.solve(body, change.state)?;
        let rate = body.solid.equivalent_stress_rate(flaws, fields, rates);
        let present = now.memo.equivalent_stress(body, flaws, now.state)?;
        Ok(body.solid.risk_rate(flaws, present, &rate))
    }
}

impl Linear for SolidBody {
    fn change(&self, inputs: &[f64], rates: &[f64]) -> Memo {
        Box::new(SolidMemo::of_change(self.loads.change(inputs, rates, self.meshes())))
    }

    fn rates(&self, state: &[f64], memo: &Memo, change: &Memo) -> Vec<f64> {
        let loads = [memo, change].map(|memo| SolidMemo::of(memo).loads());
        let rates = self.solid.rates(self.heat_of(state), loads[0], loads[1]);
        rates.expect("only bodies of linear heat are told as linear")
    }

    fn read_rate(
        &self,
        (state, memo): (&[f64], &mut Memo),
        (rates, change): (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError> {
        let now = SolidReader { body: self, state, memo: SolidMemo::of_mut(memo) };
        let change = SolidReader { body: self, state: rates, memo: SolidMemo::of_mut(change) };
        let mut both = SolidChange { now, change };
        match *reading {
            Reading::Point { quantity, at, alone } => {
                point_quantities()[quantity].rate(&mut both, at, alone)
            }
            Reading::Mean { quantity, field, cell } => {
                point_quantities()[quantity].mean_rate(&mut both, (field, cell))
            }
            Reading::Total(place) => totals::rate(&mut both, place),
            Reading::Flaw { flaw, quantity } => flaw_reading::rate(&mut both, flaw, quantity),
            // Place and time stay constant until a new maximum is noted.
            Reading::Peak { which, part: PeakPart::Value } => self.highest_rate(&mut both, which),
            Reading::Peak { .. } | Reading::Error => Ok(0.0),
            Reading::Cell { .. } => Err(BodyError::NoSuchReading),
        }
    }
}

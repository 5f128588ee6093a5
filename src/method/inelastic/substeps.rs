//! Creeping bodies: time steps that are cut until the error of each is small.
//!
//! The error of an implicit Euler step is half the change of the flow rate over the step times its length. A step is
//! accepted if that is at most a fraction of the largest elastic strain so far, and it determines the length of the
//! next step. Over the whole increment, temperatures and forces vary linearly.

use super::newton::Progress;
use super::problem::{InelasticError, InelasticProblem};
use crate::laws::PlasticHistory;
use crate::laws::stress::von_mises;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Change of temperatures and forces over a time.
#[derive(Debug, Clone, Copy)]
pub struct Increment<'a> {
    /// Nodal temperatures at the beginning and at the end [K].
    pub temperatures: [&'a [f64]; 2],
    /// Nodal forces at the beginning and at the end [N].
    pub forces: [&'a [f64]; 2],
    /// [s]
    pub duration: f64,
    /// Error tolerance of an inner step, relative to the largest elastic strain.
    pub tolerance: f64,
    pub allowance: &'a Allowance,
}

/// Largest number of inner steps in a step.
const MOST_STEPS: usize = 2_000;
/// Length of the shortest inner step, over the whole.
const LEAST_PART: f64 = 1e-24;
/// Lower bound of the elastic strain to which errors are compared [1], below that of any load.
const LEAST_STRAIN: f64 = 1e-15;
/// Bounds of the ratio of lengths of two steps, and a margin.
const LEAST_RATIO: f64 = 0.1;
const MOST_RATIO: f64 = 4.0;
const MARGIN: f64 = 0.9;

impl InelasticProblem {
    /// Advances a state over an increment: in a single step without creep, and otherwise in as many inner steps as the
    /// tolerance requires.
    pub fn advance_increment(
        &self,
        state: &mut [f64],
        increment: &Increment,
    ) -> Result<(), InelasticError> {
        if increment.duration <= 0.0 || !self.takes_time() {
            let temperatures = [increment.temperatures[1]; 2];
            return self
                .advance_to(state, temperatures, increment.forces[1], 0.0, increment)
                .map(drop);
        }
        if !self.creeps() {
            return self.advance_by_halves(state, increment);
        }
        let mut now = state.to_vec();
        // Changes since the last step are instantaneous.
        let first = [increment.temperatures[0]; 2];
        self.advance_to(&mut now, first, increment.forces[0], 0.0, increment)?;
        let (mut done, mut part) = (0.0, 1.0_f64);
        let mut rates = self.rates(&now, increment.temperatures[0])?;
        let mut strain = rates.strain.max(LEAST_STRAIN);
        let mut before = increment.temperatures[0].to_vec();
        let mut steps = 0;
        while steps < MOST_STEPS {
            steps += 1;
            part = part.min(1.0 - done);
            let end = if part < 1.0 - done { done + part } else { 1.0 };
            let temperatures = between(increment.temperatures, end);
            let forces = between(increment.forces, end);
            let mut next = now.clone();
            let length = part * increment.duration;
            let change = [&before[..], &temperatures[..]];
            match self.advance_to(&mut next, change, &forces, length, increment) {
                Ok(_) => {}
                Err(InelasticError::NoEquilibrium { .. }) if part > LEAST_PART => {
                    part *= LEAST_RATIO;
                    continue;
                }
                Err(error) => return Err(error),
            }
            let ahead = self.rates(&next, &temperatures)?;
            strain = strain.max(ahead.strain);
            let error = self.error([&now, &next], &rates, length) / (increment.tolerance * strain);
            let ratio = if error > 0.0 { MARGIN / error.sqrt() } else { MOST_RATIO };
            // A NaN error results from rates beyond the range of numbers.
            if error.is_nan() || error > 1.0 {
                if part < LEAST_PART {
                    break;
                }
                part *= if ratio.is_nan() { LEAST_RATIO } else { ratio.max(LEAST_RATIO) };
                continue;
            }
            (now, rates, done, before) = (next, ahead, end, temperatures);
            if done >= 1.0 {
                state.copy_from_slice(&now);
                return Ok(());
            }
            part *= ratio.min(MOST_RATIO);
        }
        Err(InelasticError::TooFast { steps, done: done * increment.duration })
    }

    fn advance_to(
        &self,
        state: &mut [f64],
        temperatures: [&[f64]; 2],
        forces: &[f64],
        duration: f64,
        increment: &Increment,
    ) -> Result<Progress, InelasticError> {
        self.advance_within(state, temperatures, forces, duration, increment.allowance)
    }

    /// Returns the flow rates of all points.
    fn rates(&self, state: &[f64], temperatures: &[f64]) -> Result<Rates, InelasticError> {
        let points = self.points(state, temperatures)?;
        let constants = self.constants(temperatures, 1.0, &Team::new(1))?;
        let pairs = || points.iter().zip(&constants);
        let flow = pairs().map(|(point, own)| own.flow_at(&point.stress, &point.history)).collect();
        let strains = pairs().map(|(point, own)| von_mises(point.stress) / (3.0 * own.shear));
        Ok(Rates { flow, strain: strains.fold(0.0, f64::max) })
    }

    /// Largest error of a step's plastic strain.
    fn error(&self, states: [&[f64]; 2], rates: &Rates, length: f64) -> f64 {
        let layout = self.layout();
        let [before, after] =
            states.map(|state| state[layout.history.clone()].chunks_exact(layout.of_point));
        let of_point = |((old, new), rate): ((&[f64], &[f64]), &Option<f64>)| {
            let grown =
                PlasticHistory::read(new).accumulated - PlasticHistory::read(old).accumulated;
            rate.map_or(0.0, |rate| 0.5 * (grown - rate * length).abs())
        };
        before.zip(after).zip(&rates.flow).map(of_point).fold(0.0, f64::max)
    }
}

/// Rates of all points.
struct Rates {
    /// ṗ [1/s]; `None` for rate-independent flow.
    flow: Vec<Option<f64>>,
    /// Largest elastic strain [1].
    strain: f64,
}

pub(super) fn between([start, end]: [&[f64]; 2], part: f64) -> Vec<f64> {
    start.iter().zip(end).map(|(a, b)| a + part * (b - a)).collect()
}

//! Creeping bodies: time steps of second order that are cut until the error of each is small.
//!
//! A step of length h has two stages, implicit Euler steps of γh with `γ = 1 − 1/√2`: one from its beginning, and one to
//! its end, from where the rate of the first leads in `(1 − γ) h` (R. Alexander 1977, doi 10.1137/0714068). So flow of
//! any rate is stable, stress that has relaxed stays relaxed, and accumulated strain never falls behind plastic strain.
//! Points that do not creep pass both stages as two steps.
//!
//! With the rates k at 0, γh and h, the error of flow that relaxes is `h |√2 k₀ − 2 k₁ + (2 − √2) k₂|/3` in leading order;
//! that of flow at a given rate is a seventh of this. A step is accepted if that is at most a fraction of the largest
//! elastic strain so far, and it determines the length of the next step. Over the whole increment, temperatures and
//! forces vary linearly.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use super::problem::{InelasticError, InelasticProblem, Lapse};
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

/// γ, the length of a stage over that of the step.
const STAGE: f64 = 1.0 - FRAC_1_SQRT_2;
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
    /// Advances a state over an increment: in a single step where nothing takes time, and otherwise in as many inner steps
    /// as the tolerance requires.
    pub fn advance_increment(
        &self,
        state: &mut [f64],
        increment: &Increment,
    ) -> Result<(), InelasticError> {
        if increment.duration <= 0.0 || !self.takes_time() {
            return self.advance_stage(state, increment, [1.0; 2], Lapse::of(0.0));
        }
        match self.relaxes() {
            true => self.advance_by_halves(state, increment),
            false => self.advance_creep(state, increment),
        }
    }

    /// Advances a state over an increment in as many steps as creep requires.
    pub(super) fn advance_creep(
        &self,
        state: &mut [f64],
        increment: &Increment,
    ) -> Result<(), InelasticError> {
        let mut now = state.to_vec();
        // Changes since the last step are instantaneous.
        self.advance_stage(&mut now, increment, [0.0; 2], Lapse::of(0.0))?;
        let (mut done, mut part) = (0.0, 1.0_f64);
        let mut rates = self.rates(&now, increment.temperatures[0])?;
        let mut strain = rates.strain.max(LEAST_STRAIN);
        let mut steps = 0;
        while steps < MOST_STEPS {
            steps += 1;
            part = part.min(1.0 - done);
            let end = if part < 1.0 - done { done + part } else { 1.0 };
            let step = match self.advance_stages(&now, increment, [done, end]) {
                Ok(step) => step,
                Err(InelasticError::NoEquilibrium { .. }) if part > LEAST_PART => {
                    part *= LEAST_RATIO;
                    continue;
                }
                Err(error) => return Err(error),
            };
            let mut ahead = self.rates(&step.end, &between(increment.temperatures, end))?;
            strain = strain.max(ahead.strain);
            let length = part * increment.duration;
            let grown = self.grown(&now, &step);
            let error = rates.error(&grown, length) / (increment.tolerance * strain);
            ahead.follow(&grown, STAGE * length);
            let ratio = if error > 0.0 { MARGIN / error.cbrt() } else { MOST_RATIO };
            // A NaN error results from rates beyond the range of numbers.
            if error.is_nan() || error > 1.0 {
                if part < LEAST_PART {
                    break;
                }
                part *= if ratio.is_nan() { LEAST_RATIO } else { ratio.max(LEAST_RATIO) };
                continue;
            }
            (now, rates, done) = (step.end, ahead, end);
            if done >= 1.0 {
                state.copy_from_slice(&now);
                return Ok(());
            }
            part *= ratio.min(MOST_RATIO);
        }
        Err(InelasticError::TooFast { steps, done: done * increment.duration })
    }

    /// Advances by a step between two parts of an increment.
    fn advance_stages(
        &self,
        from: &[f64],
        increment: &Increment,
        [start, end]: [f64; 2],
    ) -> Result<Stages, InelasticError> {
        let length = (end - start) * increment.duration;
        let middle = start + STAGE * (end - start);
        let mut first = from.to_vec();
        self.advance_stage(&mut first, increment, [start, middle], Lapse::of(STAGE * length))?;
        let led = self.led(from, &first);
        let lapse = Lapse { of_creep: STAGE * length, of_others: (1.0 - STAGE) * length };
        let mut last = led.clone();
        self.advance_stage(&mut last, increment, [middle, end], lapse)?;
        Ok(Stages { first, led, end: last })
    }

    /// Returns the state to which the rate of the first stage leads: flow has gone on for `(1 − γ) h` from the beginning
    /// of the step. Displacements are those expected at its end, and points that do not creep stay as they are.
    fn led(&self, from: &[f64], first: &[f64]) -> Vec<f64> {
        let layout = self.layout();
        let mut led = first.to_vec();
        let go_on = |led: &mut [f64], from: &[f64], part: f64| {
            led.iter_mut().zip(from).for_each(|(to, from)| *to = from + part * (*to - from));
        };
        for range in [layout.displacement.clone(), layout.amplitudes.clone()] {
            go_on(&mut led[range.clone()], &from[range], 1.0 / STAGE);
        }
        let of_layer = self.grid.per_layer() * layout.points * layout.of_point;
        let histories = led[layout.history.clone()].chunks_exact_mut(of_layer);
        let layers = histories.zip(from[layout.history].chunks_exact(of_layer));
        for (layer, (led, from)) in
            layers.enumerate().filter(|(layer, _)| self.law(*layer).creeps())
        {
            debug_assert!(self.law(layer).relaxation().is_none());
            go_on(led, from, (1.0 - STAGE) / STAGE);
        }
        led
    }

    /// Advances implicitly between two parts of an increment.
    pub(super) fn advance_stage(
        &self,
        state: &mut [f64],
        increment: &Increment,
        parts: [f64; 2],
        lapse: Lapse,
    ) -> Result<(), InelasticError> {
        let temperatures = parts.map(|part| between(increment.temperatures, part));
        let temperatures = temperatures.each_ref().map(Vec::as_slice);
        let forces = between(increment.forces, parts[1]);
        self.advance_within(state, temperatures, &forces, lapse, increment.allowance).map(drop)
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

    /// Returns by how much the accumulated strain of all points grows in each stage.
    fn grown(&self, from: &[f64], stages: &Stages) -> Vec<[f64; 2]> {
        let layout = self.layout();
        let [from, first, led, end] =
            [from, &stages.first, &stages.led, &stages.end].map(|state| {
                let histories = state[layout.history.clone()].chunks_exact(layout.of_point);
                histories.map(|history| PlasticHistory::read(history).accumulated)
            });
        let first = from.zip(first).map(|(from, first)| first - from);
        let last = led.zip(end).map(|(led, end)| end - led);
        first.zip(last).map(|(first, last)| [first, last]).collect()
    }
}

/// States of a step.
struct Stages {
    first: Vec<f64>,
    /// The beginning of the second stage.
    led: Vec<f64>,
    end: Vec<f64>,
}

/// Rates of all points.
struct Rates {
    /// ṗ [1/s]; `None` for rate-independent flow.
    flow: Vec<Option<f64>>,
    /// Largest elastic strain [1].
    strain: f64,
}

impl Rates {
    /// Largest error of a step's plastic strain.
    fn error(&self, grown: &[[f64; 2]], length: f64) -> f64 {
        let of_point = |([first, last], rate): (&[f64; 2], &Option<f64>)| {
            let of_rate = |rate: f64| SQRT_2 * rate * length - 2.0 / STAGE * first + 2.0 * last;
            rate.map_or(0.0, |rate| of_rate(rate).abs() / 3.0)
        };
        // A NaN has to remain.
        let largest = |most: f64, own: f64| if most.is_nan() || own <= most { most } else { own };
        grown.iter().zip(&self.flow).map(of_point).fold(0.0, largest)
    }

    /// Takes the rates of the last stage [s]. Those of the stresses that are read differ from them where an element
    /// projects its change of volume, which would be an error of first order.
    fn follow(&mut self, grown: &[[f64; 2]], stage: f64) {
        for (rate, [_, last]) in self.flow.iter_mut().zip(grown) {
            *rate = rate.map(|_| last / stage);
        }
    }
}

/// Values at a part of an increment, between those at its ends.
pub fn between([start, end]: [&[f64]; 2], part: f64) -> Vec<f64> {
    start.iter().zip(end).map(|(a, b)| a + part * (b - a)).collect()
}

//! Steps under inputs that are polynomials in time.

use super::{Model, ModelError, State};
use crate::math::allowance::Allowance;
use crate::method::fem::SolidLoads;

/// Highest time derivative of inputs that a step takes into account.
pub const HIGHEST_INPUT_DERIVATIVE: usize = 2;

/// Parts of a footprint's size that it may move or grow by in one part of a step.
const PARTS_OF_A_FOOTPRINT: f64 = 8.0;

/// Inputs over a step: `u(s) = u₀ + u₁ s + u₂ s²/2`.
pub(super) struct InputPath {
    /// `u₀`, `u₁`, … of all inputs.
    derivatives: Vec<Vec<f64>>,
}

impl InputPath {
    pub fn of(state: &State) -> Self {
        let higher = &state.derivatives;
        let last = higher.iter().rposition(|list| list.iter().any(|&v| v != 0.0));
        let higher = &higher[..last.map_or(0, |last| last + 1)];
        Self { derivatives: [std::slice::from_ref(&state.inputs), higher].concat() }
    }

    pub fn is_held(&self) -> bool {
        self.derivatives.len() == 1
    }

    /// Derivatives of this order at `s` [s] into the step, the inputs themselves for 0.
    pub fn at(&self, order: usize, s: f64) -> Vec<f64> {
        let from = &self.derivatives[order.min(self.derivatives.len())..];
        let mut sum = from.first().cloned().unwrap_or_default();
        let mut weight = 1.0;
        for (k, list) in from.iter().enumerate().skip(1) {
            weight *= s / k as f64;
            for (value, derivative) in sum.iter_mut().zip(list) {
                *value += weight * derivative;
            }
        }
        sum
    }

    /// The inputs and their derivatives at `s` [s] into the step.
    pub fn end(&self, s: f64) -> (Vec<f64>, Vec<Vec<f64>>) {
        let higher = (1..self.derivatives.len()).map(|order| self.at(order, s)).collect();
        (self.at(0, s), higher)
    }

    /// Times in a step of length `dt` at which some input is at an extreme.
    fn turns(&self, dt: f64) -> Vec<f64> {
        let [_, slopes, bends] = &self.derivatives[..] else { return Vec::new() };
        let turn = |(slope, bend): (&f64, &f64)| -slope / bend;
        let times = slopes.iter().zip(bends).map(turn);
        let mut times: Vec<f64> = times.filter(|&s| s > 0.0 && s < dt).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

impl Model {
    /// Advances the unknowns of all bodies by `dt` [s] under inputs that follow a path.
    ///
    /// Over each part of the step, loads are the quadratics in time that meet them at its beginning,
    /// middle and end, and heat is solved exactly under these. So amounts and face values make no
    /// time error, the step is then one part. Footprints that move or grow make one of the fourth
    /// order; they go by at most an eighth of their radius (a ring's width, a tile's smaller side) in
    /// a part. For alumina under footprints of 50 µm at 1 m/s that is 3e-5 of the rise for a
    /// Gaussian, and for a disc or tiles 2e-5 below them and 5e-4 at the edge that goes ahead.
    pub(super) fn advance_along(
        &self,
        path: &InputPath,
        bodies: &mut [Vec<f64>],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        for s in path.turns(dt).into_iter().chain([dt]) {
            self.check_underway(&path.at(0, s), s)?;
        }
        let travel =
            |body: &super::BodyModel| body.loads.travel(&self.scene, &path.derivatives, dt);
        let travel = self.bodies.iter().map(travel).fold(0.0, f64::max);
        let parts = (PARTS_OF_A_FOOTPRINT * travel).ceil().max(1.0);
        for body in &self.bodies {
            let halted = |halt| ModelError::Halted { body: body.name.clone(), halt };
            let size = body.solid.state_len();
            allowance.foresee(parts, "samples of moving footprints", size).map_err(halted)?;
        }
        let h = dt / parts;
        let mut first = self.loads_at(&path.at(0, 0.0));
        for part in 0..parts as usize {
            let at = |share: f64| (part as f64 + share) * h;
            let [middle, last] = [at(0.5), at(1.0)].map(|s| (path.at(0, s), s));
            self.check_underway(&middle.0, middle.1)?;
            self.check_underway(&last.0, last.1)?;
            let (middle, last) = (self.loads_at(&middle.0), self.loads_at(&last.0));
            for (index, body) in self.bodies.iter().enumerate() {
                let loads = quadratic([&first[index], &middle[index], &last[index]], h);
                let advanced = body.solid.advance(&mut bodies[index], &loads, h, allowance);
                advanced.map_err(|halt| ModelError::Halted { body: body.name.clone(), halt })?;
            }
            first = last;
        }
        Ok(())
    }

    pub(super) fn check_underway(&self, inputs: &[f64], after: f64) -> Result<(), ModelError> {
        self.check_inputs(inputs).map_err(|error| match error {
            ModelError::Input { index, message } => ModelError::Underway { index, message, after },
            other => other,
        })
    }

    fn loads_at(&self, inputs: &[f64]) -> Vec<SolidLoads> {
        let loads =
            |body: &super::BodyModel| body.loads.assemble(&self.scene, inputs, body.solid.mesh());
        self.bodies.iter().map(loads).collect()
    }
}

/// Value and derivatives, at the beginning, of the quadratics through heat and face values at the
/// beginning, the middle and the end of a time `h`.
fn quadratic(samples: [&SolidLoads; 3], h: f64) -> [SolidLoads; 3] {
    let weights =
        [[1.0, 0.0, 0.0], [-3.0 / h, 4.0 / h, -1.0 / h], [4.0, -8.0, 4.0].map(|w| w / (h * h))];
    weights.map(|weights| {
        let sum = |pick: &dyn Fn(&SolidLoads) -> &Vec<f64>| {
            let mut sum: Vec<f64> = Vec::new();
            for (weight, list) in weights.iter().zip(samples.map(pick)) {
                sum.resize(sum.len().max(list.len()), 0.0);
                sum.iter_mut().zip(list).for_each(|(s, value)| *s += weight * value);
            }
            sum
        };
        let classes = 0..samples[0].faces.len();
        SolidLoads {
            heat: classes.clone().map(|c| [0, 1].map(|side| sum(&|l| &l.heat[c][side]))).collect(),
            faces: classes.map(|c| sum(&|l| &l.faces[c])).collect(),
            force: Vec::new(),
        }
    })
}

//! Steps under inputs that are polynomials in time.

use super::memo::SolidMemo;
use super::{Sampling, SolidBody};
use crate::body::{Acts, BodyError};
use crate::inputs::InputPath;
use crate::method::fem::SolidLoads;
use crate::runtime::allowance::Allowance;

impl SolidBody {
    /// Advances a state; `memo` is that of the inputs at the beginning, unless these change.
    pub(super) fn advance_here(
        &self,
        state: &mut [f64],
        memo: &SolidMemo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        if !acts.path.is_held() {
            return self.advance_along(state, acts, allowance);
        }
        let outside = std::slice::from_ref(memo.outside());
        let loads = self.with_received(outside, acts, 0.0);
        let loads = loads.as_deref().unwrap_or(outside);
        let advanced = self.solid.advance(state, loads, acts.duration, allowance);
        advanced.map_err(|failure| self.error(failure))
    }

    /// Advances under inputs that follow a path.
    ///
    /// Over each part of the step, loads are the quadratics in time that match them at its beginning, middle and end.
    /// Heat is solved exactly under these. Amounts and face values have no time error, so such a step is one part.
    /// Footprints that move or grow have a fourth-order error; they move by at most an eighth of their least radius (a
    /// ring's width, a tile's smaller side) in a part. For alumina under footprints of 50 µm at 1 m/s the error is 3e-5
    /// of the rise for a Gaussian. For a disc or tiles it is 2e-5 below them and 5e-4 at the leading edge.
    fn advance_along(
        &self,
        state: &mut [f64],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let Acts { path, duration, .. } = acts;
        let sampling = Sampling::of(&self.loads, path, *duration);
        let foreseen =
            allowance.foresee(sampling.count(), "samples of moving footprints", state.len());
        foreseen.map_err(|halt| self.error(halt.into()))?;
        let mut first = self.loads_at(path, 0.0)?;
        for part in sampling.parts() {
            let [middle, last] =
                [self.loads_at(path, part.middle)?, self.loads_at(path, part.end)?];
            let loads = quadratic([&first, &middle, &last], part.duration);
            let received = self.with_received(&loads, acts, part.begin);
            let loads = received.unwrap_or_else(|| loads.to_vec());
            let advanced = self.solid.advance(state, &loads, part.duration, allowance);
            advanced.map_err(|failure| self.error(failure))?;
            first = last;
        }
        Ok(())
    }

    fn loads_at(&self, path: &InputPath, s: f64) -> Result<SolidLoads, BodyError> {
        let inputs = path.at(0, s);
        self.loads.check(&inputs).map_err(|error| error.underway(s))?;
        Ok(self.loads.assemble(&inputs, self.meshes()))
    }

    /// Returns the loads and their derivatives at a time [s] after the beginning, with the transfers through ports;
    /// `None` without transfers.
    fn with_received(
        &self,
        loads: &[SolidLoads],
        acts: &Acts,
        after: f64,
    ) -> Option<Vec<SolidLoads>> {
        if acts.received.is_empty() {
            return None;
        }
        let mut all = loads.to_vec();
        if all.len() < 2 {
            all.push(all[0].zero());
        }
        for received in acts.received {
            self.port(received.face).add_over_step(&mut all, received.given, after);
        }
        Some(all)
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

//! Steps that are taken in parts, so that a host can follow their progress.

use super::{Cache, Model, ModelError, State};
use crate::runtime::allowance::{Allowance, PART_UPDATES};

impl Model {
    /// Number of parts into which a step of `dt` [s] is cut for a host that follows its progress. Bodies that take any
    /// step at the same cost do not count.
    pub fn parts(&self, dt: f64) -> f64 {
        let updates: f64 = self.bodies.iter().map(|body| body.updates(dt)).sum();
        (updates / PART_UPDATES).ceil().max(1.0)
    }

    /// Refuses a step of `dt` [s] that would exceed the allowed work.
    pub fn foresee(&self, state: &State, dt: f64, allowance: &Allowance) -> Result<(), ModelError> {
        let mut bodies = self.bodies.iter().zip(&state.bodies);
        Ok(bodies.try_for_each(|(body, unknowns)| body.foresee(unknowns, dt, allowance))?)
    }

    /// Advances by `dt` [s] as a further part of the last step, whose rest is `ahead` [s]: means over the last step
    /// then cover all its parts.
    pub fn step_on(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        (dt, ahead): (f64, f64),
    ) -> Result<(), ModelError> {
        let before = state.bodies.clone();
        self.step_within(allowance, state, cache, (dt, ahead))?;
        for ((body, before), state) in self.bodies.iter().zip(&before).zip(&mut state.bodies) {
            body.join_steps(before, state);
        }
        Ok(())
    }
}

//! Steps that are taken in parts, so that a host can be told how far they have come.

use super::droplets::Below;
use super::{Cache, Model, ModelError, State};
use crate::math::allowance::{Allowance, PART_UPDATES};
use crate::method::sph::WallExchange;

impl Model {
    /// Into how many parts a step of `dt` [s] is cut for a host that wants to be told of it on its way. Solids
    /// take any step in one.
    pub fn parts(&self, dt: f64) -> f64 {
        let updates: f64 = self.droplets.iter().map(|body| body.updates(dt)).sum();
        (updates / PART_UPDATES).ceil().max(1.0)
    }

    /// Ends a step of `dt` [s] that is known to take the droplets too many time steps.
    pub fn foresee(&self, state: &State, dt: f64, allowance: &Allowance) -> Result<(), ModelError> {
        let mut droplets = self.droplets.iter().zip(&state.bodies[self.bodies.len()..]);
        droplets.try_for_each(|(body, unknowns)| body.foresee(unknowns, dt, allowance))
    }

    /// Advances by `dt` [s] as a further part of the step before: means over the last step are those over
    /// all its parts.
    pub fn step_on(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        dt: f64,
    ) -> Result<(), ModelError> {
        let before = self.given(state);
        self.step_within(allowance, state, cache, dt)?;
        let solids = self.bodies.len();
        for (index, given) in before.into_iter().enumerate() {
            if let Some(given) = given {
                self.droplets[index]
                    .droplet
                    .add_exchange(&mut state.bodies[solids + index], &given);
            }
        }
        Ok(())
    }

    /// What droplets gave to walls during the last step. What solids got is told of the last exchange, however
    /// long the step.
    fn given(&self, state: &State) -> Vec<Option<WallExchange>> {
        let droplets = self.droplets.iter().zip(&state.bodies[self.bodies.len()..]);
        let given = droplets.map(|(body, unknowns)| match body.below {
            Below::Solid(_) => None,
            Below::Nothing | Below::Wall(_) => Some(body.droplet.exchange(unknowns)),
        });
        given.collect()
    }
}

//! Steps in which stress relaxes, which are cut until the error of strains is small.
//!
//! A step takes the elastic strains of points as linear in time. Under loads that last they creep, and the error of a
//! step grows with its length. So a step is compared with two halves of it, whose error is a third of the difference,
//! and halved until that is within the tolerance.
//!
//! Most steps need no halves: with the largest change D of an elastic strain over a step of x relaxation times, strains
//! deviate from a straight line by `D min(x, 1)/8` at most, as a parabola does.

use super::faces::Prescribed;
use super::resting::{Resting, RestingBody, temperatures};
use super::warming::Temperatures;
use crate::method::large_strain::Failure;
use crate::runtime::allowance::Allowance;

/// Halvings of a step: the shortest relaxation times within the longest step.
const MOST_HALVINGS: u32 = 40;
/// Error of two halves of second order over their difference from the whole.
const OF_DIFFERENCE: f64 = 1.0 / 3.0;
/// Deviation of a parabola from its chord over its rise.
const OF_RISE: f64 = 1.0 / 8.0;
/// Elastic strain below which errors do not count.
const LEAST: f64 = 1e-9;

impl RestingBody {
    /// Finds the equilibrium after a time [s] in which stress relaxes, in as many parts as the tolerance requires.
    pub(super) fn relax(
        &self,
        state: &mut Resting,
        to: &Prescribed,
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        self.relax_in_parts(state, to, (dt, MOST_HALVINGS), allowance)
    }

    fn relax_in_parts(
        &self,
        state: &mut Resting,
        to: &Prescribed,
        (dt, halvings): (f64, u32),
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let whole = self.settled(state, to, dt, allowance)?;
        self.refine(state, whole, to, (dt, halvings), allowance)
    }

    /// Accepts the end of a step, or takes halves of it.
    fn refine(
        &self,
        state: &mut Resting,
        whole: Resting,
        to: &Prescribed,
        (dt, halvings): (f64, u32),
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        if halvings == 0 || self.is_straight(state, &whole, to, dt)? {
            *state = whole;
            return Ok(());
        }
        let middle = self.held(state).middle(to);
        let half = self.settled(state, &middle, 0.5 * dt, allowance)?;
        let end = self.settled(&half, to, 0.5 * dt, allowance)?;
        let [off, size] = self.apart(&whole, &end);
        if OF_DIFFERENCE * off <= self.tolerance * size.max(LEAST) {
            *state = end;
            return Ok(());
        }
        self.refine(state, half, &middle, (0.5 * dt, halvings - 1), allowance)?;
        self.relax_in_parts(state, to, (0.5 * dt, halvings - 1), allowance)
    }

    /// The state after one step.
    fn settled(
        &self,
        from: &Resting,
        to: &Prescribed,
        dt: f64,
        allowance: &Allowance,
    ) -> Result<Resting, Failure> {
        let mut state = from.clone();
        self.settle(&mut state, to, dt, self.halvings, allowance)?;
        Ok(state)
    }

    /// Returns true if strains change too little over a step to deviate from straight lines.
    fn is_straight(
        &self,
        from: &Resting,
        end: &Resting,
        to: &Prescribed,
        dt: f64,
    ) -> Result<bool, Failure> {
        let [change, size] = self.apart(from, end);
        let ends = [temperatures(from), Temperatures { base: to.temperature, rise: &to.rise }];
        let lasts = self.equilibrium.body.relaxation_over(&self.course(ends, dt)?);
        Ok(OF_RISE * change * lasts.min(1.0) <= self.tolerance * size.max(LEAST))
    }

    /// Largest difference of the elastic strains of two states, and the largest of either.
    fn apart(&self, one: &Resting, other: &Resting) -> [f64; 2] {
        self.equilibrium.body.relaxing_strains(&one.rest.history, &other.rest.history)
    }
}

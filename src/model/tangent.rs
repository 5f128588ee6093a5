//! Derivatives of outputs, with respect to the inputs at one moment and to time.

use super::schedule::Exchange;
use super::{BodyError, Cache, Model, ModelError, State};
use crate::body::{Body, Reading};
use crate::inputs::InputPath;
use crate::variables::Output;

/// A change of unknowns and loads, with its effects.
#[derive(Debug, Default)]
pub struct Tangent {
    bodies: Vec<Vec<f64>>,
    cache: Cache,
    /// True if the unknowns change, too.
    in_time: bool,
}

impl Model {
    /// Returns the change when the inputs change at `rates` and the unknowns are constant.
    pub fn input_tangent(&self, state: &State, rates: &[f64]) -> Result<Tangent, ModelError> {
        self.check_inputs(&state.inputs)?;
        let change = |body: &dyn Body| match body.linear() {
            Some(linear) => linear.change(&state.inputs, rates),
            None => body.memo(&state.inputs, &[]),
        };
        let bodies = state.bodies.iter().map(|unknowns| vec![0.0; unknowns.len()]).collect();
        let cache = Cache::of_memos(self.bodies.iter().map(|body| change(body.as_ref())).collect());
        Ok(Tangent { bodies, cache, in_time: false })
    }

    /// Returns the time derivative under the present inputs and their first derivatives.
    pub fn time_tangent(&self, state: &State, cache: &mut Cache) -> Result<Tangent, ModelError> {
        let held = vec![0.0; state.inputs.len()];
        let mut tangent = self.input_tangent(state, state.derivatives.first().unwrap_or(&held))?;
        tangent.in_time = true;
        cache.update(self, state);
        let path = InputPath::new(&state.inputs, &[]);
        let joints = self.through_joints(&state.bodies, cache, &path)?;
        for (place, body) in self.bodies.iter().enumerate() {
            let Some(linear) = body.linear() else { continue };
            let change = tangent.cache.memo(place);
            let through = Exchange::with(&joints, place);
            tangent.bodies[place] = match through.is_empty() {
                true => linear.rates(&state.bodies[place], cache.memo(place), change),
                false => {
                    let links = self.through_links(state);
                    let received = [Exchange::with(&links, place), through].concat();
                    let now = body.memo(&state.inputs, &received);
                    linear.rates(&state.bodies[place], &now, change)
                }
            };
        }
        Ok(tangent)
    }

    /// Returns the change of an output, see [`Linear::read_rate`](crate::body::Linear::read_rate). Between steps a body
    /// that is not linear follows no input. Its outputs and running maxima have no time derivative.
    pub fn output_rate(
        &self,
        state: &State,
        cache: &mut Cache,
        Tangent { bodies, cache: change, in_time }: &mut Tangent,
        output: &Output,
    ) -> Result<f64, ModelError> {
        cache.update(self, state);
        let place = output.body;
        if output.reading == Reading::Error {
            return Ok(0.0);
        }
        if matches!(output.reading, Reading::Peak { .. }) {
            match (*in_time, state.peaks.is_empty()) {
                (true, _) => return Err(BodyError::NoRate.into()),
                // A noted maximum follows no input.
                (false, false) => return Ok(0.0),
                (false, true) => {}
            }
        }
        let rate = match self.bodies[place].linear() {
            Some(linear) => linear.read_rate(
                (&state.bodies[place], cache.memo(place)),
                (&bodies[place], change.memo(place)),
                &output.reading,
            )?,
            None if *in_time || self.bodies[place].follows_at_once(&output.reading) => {
                return Err(BodyError::NoRate.into());
            }
            None => 0.0,
        };
        Ok(BodyError::unless_finite(rate)?)
    }
}

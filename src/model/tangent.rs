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

    /// Returns the time derivative under the present inputs and their first derivatives. Bodies that receive through
    /// links have none: only the means of these transfers over the last step are known.
    pub fn time_tangent(&self, state: &State, cache: &mut Cache) -> Result<Tangent, ModelError> {
        let held = vec![0.0; state.inputs.len()];
        let mut tangent = self.input_tangent(state, state.derivatives.first().unwrap_or(&held))?;
        tangent.in_time = true;
        cache.update(self, state);
        let path = InputPath::new(&state.inputs, &[]);
        let joints = self.through_joints(&state.bodies, cache, &path)?;
        for (place, body) in self.bodies.iter().enumerate() {
            let Some(linear) = body.linear().filter(|_| !self.has_links_to(place)) else {
                continue;
            };
            let change = tangent.cache.memo(place);
            let through = Exchange::with(&joints, place);
            tangent.bodies[place] = match through.is_empty() {
                true => linear.rates(&state.bodies[place], cache.memo(place), change),
                false => {
                    let now = body.memo(&state.inputs, &through);
                    linear.rates(&state.bodies[place], &now, change)
                }
            };
        }
        Ok(tangent)
    }

    /// Returns true if other bodies transfer heat or force to a body through links.
    fn has_links_to(&self, place: usize) -> bool {
        self.links.iter().any(|link| link.to == place)
    }

    /// Returns true if an output follows inputs at once though its declared dependencies lack them: a running maximum
    /// or a risk equals the present value until it is noted.
    pub fn follows_undeclared(&self, state: &State, output: &Output) -> bool {
        match output.reading {
            Reading::Error => false,
            Reading::Peak { which, .. } => self.noted_peak(state, (output.body, which)).is_none(),
            _ => self.bodies[output.body].follows_at_once(&output.reading),
        }
    }

    /// Returns the change of an output, see [`Linear::read_rate`](crate::body::Linear::read_rate). Between steps a body
    /// that is not linear follows no input. Its outputs, those of bodies that receive through links, and running maxima
    /// have no time derivative.
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
        if *in_time && self.has_links_to(place) {
            return Err(BodyError::NoRate.into());
        }
        if let Reading::Peak { which, .. } = output.reading {
            match (*in_time, self.noted_peak(state, (place, which))) {
                (true, _) => return Err(BodyError::NoRate.into()),
                // A noted maximum follows no input.
                (false, Some(_)) => return Ok(0.0),
                (false, None) => {}
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

//! Outputs of a state.

use super::{BodyError, Cache, Model, ModelError, State};
use crate::body::Reading;
use crate::variables::Output;

/// Outputs of one state whose inputs have been checked; see [`Model::reader`].
pub struct Reader<'a> {
    pub(super) model: &'a Model,
    pub(super) state: &'a State,
    pub(super) cache: &'a mut Cache,
}

impl Reader<'_> {
    /// Returns the value of an output, or an error if it is not finite.
    pub fn value(&mut self, output: &Output) -> Result<f64, ModelError> {
        let place = output.body;
        if let Reading::Peak { which, part } = output.reading {
            return self.model.read_peak(self.state, self.cache, (place, which), part);
        }
        if output.reading == Reading::Error {
            return Ok(self.model.estimated_error(place));
        }
        let (body, unknowns) = (&self.model.bodies[place], &self.state.bodies[place]);
        let value = body.read(unknowns, self.cache.memo(place), &output.reading)?;
        Ok(BodyError::unless_finite(value)?)
    }
}

impl Model {
    /// Returns true if an output needs a mechanical solution that is missing from the cache, which belongs to this
    /// state. Then it needs more stack than a host's thread has to provide.
    pub fn is_deep(&self, state: &State, cache: &Cache, output: &Output) -> bool {
        if output.reading == Reading::Error {
            return self.errors[output.body].get().is_none();
        }
        if let Reading::Peak { which, .. } = output.reading
            && self.noted_peak(state, (output.body, which)).is_some()
        {
            return false;
        }
        self.bodies[output.body].is_deep(cache.known(output.body), &output.reading)
    }
}

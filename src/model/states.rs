//! Checks that a state from outside belongs to a model.

use super::{HIGHEST_INPUT_DERIVATIVE, Model, ModelError, State};
use crate::limits::LARGEST;

impl Model {
    /// Refuses a state from which this model cannot continue. It may have a wrong number of inputs or bodies, or a
    /// length that a body does not accept. Its numbers may not be finite, or exceed all constants of scenes. No run may
    /// produce its heat, particles or running maxima.
    pub fn check_state(&self, state: &State) -> Result<(), ModelError> {
        let refuse = |message: String| Err(ModelError::State(message));
        let orders = state.derivatives.len();
        if orders > HIGHEST_INPUT_DERIVATIVE {
            return refuse(format!(
                "derivatives of inputs up to order {orders}; the highest is \
                 {HIGHEST_INPUT_DERIVATIVE}"
            ));
        }
        let wanted = self.layout.len;
        for values in std::iter::once(&state.inputs).chain(&state.derivatives) {
            if values.len() != wanted {
                return refuse(format!(
                    "values of {} inputs; the scene has {wanted}",
                    values.len()
                ));
            }
        }
        let mut numbers = state.inputs.iter().chain(state.derivatives.iter().flatten());
        if !state.time.is_finite() || !numbers.all(|value| value.is_finite()) {
            return refuse("a number that is not finite".into());
        }
        let (found, wanted) = (state.bodies.len(), self.bodies.len());
        if found != wanted {
            return refuse(format!("unknowns of {found} bodies; the scene has {wanted}"));
        }
        for (body, unknowns) in self.bodies.iter().zip(&state.bodies) {
            let is_beyond = |number: &f64| !number.is_finite() || number.abs() > LARGEST;
            if let Some(at) = unknowns.iter().position(is_beyond) {
                let place = body.layout(unknowns).and_then(|layout| layout.place(at));
                let place = place.map_or("a number".to_owned(), |place| place.to_string());
                let wrong = match unknowns[at].is_finite() {
                    true => format!("of {:e} is larger than any run leads to", unknowns[at]),
                    false => "is not finite".to_owned(),
                };
                return refuse(format!("{}: {place} {wrong}", body.name()));
            }
            body.check_state(unknowns, &state.inputs).or_else(refuse)?;
        }
        self.check_peaks(state)
    }
}

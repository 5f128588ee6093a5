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
            let is_beyond = |&at: &usize| {
                let number: f64 = unknowns[at];
                let is_large = number.abs() > LARGEST && !body.is_of_field(unknowns, at);
                !number.is_finite() || is_large
            };
            if let Some(at) = (0..unknowns.len()).find(is_beyond) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    /// A brittle plate whose bottom has a prescribed temperature, so that stress is noted as steps end only.
    const GLASS: &str = r#"
name = "Glass"
stop_time = 1.0
step = 0.1
[body.glass]
kind = "solid"
shape = { box = [4e-3, 4e-3, 2e-3] }
initial_temperature = 300.0
mesh = { spacing = 2e-3 }
[body.glass.material]
model = "thermoelastic"
density = 2500.0
specific_heat = 750.0
conductivity = 1.0
young = 70e9
poisson = 0.22
expansion = 9e-6
weibull = { modulus = 10.0, strength = 300e6, volume = 1e-9 }
[body.glass.faces]
bottom = { temperature = 280.0, clamped = true }
"#;

    #[test]
    fn marks_of_stress_that_is_not_noted_yet_are_accepted() {
        let scene = scene::parse(GLASS, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        let model = Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
        let start = model.initial_state();
        assert!(start.bodies[0].contains(&f64::MIN));
        model.check_state(&start).unwrap();
        for (at, value) in [(0, f64::MIN), (start.bodies[0].len() - 1, 2.0 * LARGEST)] {
            let mut forged = start.clone();
            forged.bodies[0][at] = value;
            assert!(model.check_state(&forged).is_err(), "{at}");
        }
    }
}

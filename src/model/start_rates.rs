//! Derivatives of outputs at time zero with respect to the constants of a scene.

use super::{Cache, Model, ModelError};
use crate::laws::AtStart;
use crate::scene::Scene;
use crate::variables::{Output, Parameter, Quantity};

/// Weights of the central difference of sixth order at one, two and three steps (B. Fornberg 1988,
/// doi 10.1090/S0025-5718-1988-0935077-0).
const WEIGHTS: [f64; 3] = [0.75, -0.15, 1.0 / 60.0];

/// Step as a fraction of the distance to the nearest pole of the solution. The error of the difference is then about
/// 1e-11 of the rate, which is also the effect of rounding.
const STEP: f64 = 0.01;

/// Distance from the value of a constant to the nearest pole of the outputs at time zero; `None` if they do not depend
/// on it.
fn reach_of(start: AtStart, quantity: Quantity, value: f64) -> Option<f64> {
    match start {
        AtStart::Never => None,
        AtStart::PoleAtZero if value > 0.0 => Some(value),
        AtStart::PoleAtZero => Some(quantity.nominal()),
        AtStart::PolesAt([low, high]) => Some((value - low).min(high - value)),
        // Any step is suitable; the constant may be zero.
        AtStart::Polynomial => Some(quantity.nominal()),
    }
}

/// Rates of outputs at time zero, under these inputs, when a parameter of the scene changes.
///
/// Specific heat, conductivity, heat transfer coefficients and contacts have no effect before heat has moved, nor has the
/// density of bodies of small strain. The outputs depend smoothly on the other constants: for these the model is built
/// at six values about the present one.
pub fn start_rates(
    scene: &Scene,
    inputs: &[f64],
    parameter: &Parameter,
    outputs: &[&Output],
) -> Result<Vec<f64>, ModelError> {
    let value = parameter.get(scene);
    let constant = &parameter.constant;
    let start = constant.at_start(&scene.body[&parameter.body]);
    let reach = reach_of(start, constant.quantity(), value);
    let mut rates = vec![0.0; outputs.len()];
    let Some(reach) = reach else { return Ok(rates) };
    let step = STEP * reach;
    for (i, weight) in WEIGHTS.into_iter().enumerate() {
        for sign in [1.0, -1.0] {
            let mut moved = scene.clone();
            parameter.set(&mut moved, value + sign * (i + 1) as f64 * step);
            for (rate, value) in rates.iter_mut().zip(start_values(&moved, inputs, outputs)?) {
                *rate += sign * weight * value / step;
            }
        }
    }
    Ok(rates)
}

fn start_values(
    scene: &Scene,
    inputs: &[f64],
    outputs: &[&Output],
) -> Result<Vec<f64>, ModelError> {
    let model = Model::build_for_states(scene, scene.solver.threads, 1)?;
    let mut state = model.initial_state();
    state.inputs = inputs.to_vec();
    let mut cache = Cache::default();
    let mut reader = model.reader(&state, &mut cache)?;
    outputs.iter().map(|output| reader.value(output)).collect()
}

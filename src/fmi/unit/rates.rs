//! Derivatives of inputs and outputs, in safe Rust.

use std::sync::Arc;

use super::Unit;
use super::built::explain;
use super::kind::Kind;
use super::values::{aside_if, find};
use crate::fmi::gate::answer::{Answer, Reference, Refusal, Status};
use crate::fmi::table::Phase;
use crate::inputs::InputPath;
use crate::model::{BodyError, Cache, HIGHEST_INPUT_DERIVATIVE, ModelError, State, start_rates};
use crate::scene::Scene;
use crate::variables::{Output, Parameter, Registry, Slot, Variable};

/// Highest order of output derivatives, as declared in the XML. Only outputs of linear solids have them; steps of
/// particles have none, nor have solids on which other bodies fall or are laid.
pub fn highest_output_derivative(scene: &Scene) -> usize {
    usize::from(scene.has_linear_solids() && !scene.has_drops() && !scene.has_links())
}

/// Variables by which outputs may be differentiated.
pub(in crate::fmi) enum Known<'a> {
    /// Place among the state's inputs.
    Input(usize),
    Parameter(&'a Parameter),
}

/// Changes of inputs or parameters.
pub(in crate::fmi) enum Change<'a> {
    /// All inputs, at these rates.
    Inputs(Vec<f64>),
    /// Change of one input at rate one.
    Input(usize),
    Parameter(&'a Parameter),
}

impl Unit {
    /// Computes changes of outputs when inputs change by `changes`; in initialization mode also parameters.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[Reference],
        knowns: &[Reference],
        changes: &[f64],
    ) -> Answer<Vec<f64>> {
        let registry = Arc::clone(&self.registry);
        let outputs = outputs(&registry, unknowns)?;
        let mut direction = vec![0.0; self.state.inputs.len()];
        let (mut changed, mut weights) = (Vec::new(), vec![1.0]);
        for ((known, name), &change) in self.knowns(&registry, knowns)?.into_iter().zip(changes) {
            check_finite(name, change)?;
            match known {
                Known::Input(index) => direction[index] += change,
                Known::Parameter(parameter) => {
                    changed.push(Change::Parameter(parameter));
                    weights.push(change);
                }
            }
        }
        // Rates by inputs are refused of some bodies: none are asked for where no input changes.
        if direction.iter().any(|&change| change != 0.0) || changed.is_empty() {
            changed.insert(0, Change::Inputs(direction));
        } else {
            weights.remove(0);
        }
        let mut sum = vec![0.0; outputs.len()];
        for (rates, weight) in self.rates(&outputs, &changed)?.iter().zip(weights) {
            sum.iter_mut().zip(rates).for_each(|(s, rate)| *s += weight * rate);
        }
        Ok(sum)
    }

    /// Returns the variables by which outputs may be differentiated now, with their names.
    pub(in crate::fmi) fn knowns<'a>(
        &self,
        registry: &'a Registry,
        references: &[Reference],
    ) -> Answer<Vec<(Known<'a>, &'a str)>> {
        let known = |variable: &'a Variable| {
            let name = variable.name.as_str();
            match &variable.slot {
                Slot::Input(index) => Ok((Known::Input(*index), name)),
                Slot::Parameter(parameter) if self.phase == Phase::InitializationMode => {
                    Ok((Known::Parameter(parameter), name))
                }
                _ => Err(Refusal::error(format!("{name} is no input"))),
            }
        };
        find(registry, references, Kind::Real)?.into_iter().map(known).collect()
    }

    /// Computes the rates of outputs for each of these changes.
    pub(in crate::fmi) fn rates(
        &mut self,
        outputs: &[&Output],
        changes: &[Change],
    ) -> Answer<Vec<Vec<f64>>> {
        let registry = Arc::clone(&self.registry);
        self.run()?;
        self.expect_room()?;
        let scene = self.scene.clone();
        let (run, state) = self.run()?;
        let (model, cache) = (Arc::clone(&run.model), &mut run.cache);
        // Changes have no cached solution yet, and those of parameters need further models.
        let is_deep = outputs.iter().any(|output| model.is_deep(state, &Cache::default(), output))
            || changes.iter().any(|change| matches!(change, Change::Parameter(_)));
        aside_if(is_deep, || {
            let mut follow = |direction: &[f64]| -> Result<Vec<f64>, ModelError> {
                let mut tangent = model.input_tangent(state, direction)?;
                let rate = |out: &&Output| model.output_rate(state, cache, &mut tangent, out);
                outputs.iter().map(rate).collect()
            };
            let mut rates = |change: &Change| match change {
                Change::Inputs(direction) => follow(direction),
                Change::Input(index) => {
                    let mut direction = vec![0.0; state.inputs.len()];
                    direction[*index] = 1.0;
                    follow(&direction)
                }
                Change::Parameter(parameter) => {
                    start_rates(&scene, &state.inputs, parameter, outputs)
                }
            };
            let found: Result<Vec<Vec<f64>>, _> = changes.iter().map(&mut rates).collect();
            found.map_err(|error| explain(&registry, error))
        })
    }

    /// Sets time derivatives of inputs for the next step; all or none.
    pub fn set_input_derivatives(
        &mut self,
        references: &[Reference],
        orders: &[i32],
        values: &[f64],
    ) -> Answer {
        let registry = Arc::clone(&self.registry);
        let inputs = inputs(&registry, references)?;
        for ((_, variable), (&order, &value)) in inputs.iter().zip(orders.iter().zip(values)) {
            check_order(variable, order, HIGHEST_INPUT_DERIVATIVE)?;
            if let Some(message) = variable.refusal_of_derivative(order, value) {
                return Err(Refusal::error(message));
            }
        }
        self.forget_past_derivatives();
        self.has_set_derivatives = true;
        for ((index, _), (&order, &value)) in inputs.iter().zip(orders.iter().zip(values)) {
            let order = order as usize;
            let count = self.state.inputs.len();
            let derivatives = &mut self.state.derivatives;
            derivatives.resize(derivatives.len().max(order), vec![0.0; count]);
            derivatives[order - 1][*index] = value;
        }
        Ok(Status::Ok)
    }

    /// First time derivatives of outputs.
    pub fn output_derivatives(
        &mut self,
        references: &[Reference],
        orders: &[i32],
    ) -> Answer<Vec<f64>> {
        let registry = Arc::clone(&self.registry);
        let outputs = outputs(&registry, references)?;
        let highest = highest_output_derivative(&self.scene);
        for (&reference, &order) in references.iter().zip(orders) {
            let variable = &registry.variables[reference as usize];
            check_order(variable, order, highest)?;
        }
        self.run()?;
        self.expect_room()?;
        let (run, state) = self.run()?;
        let none = Cache::default();
        let is_deep = outputs.iter().any(|out| run.model.is_deep(state, &none, out));
        aside_if(is_deep, || {
            let tangent = match &mut run.tangent {
                Some(tangent) => tangent,
                none => {
                    let tangent = run.model.time_tangent(state, &mut run.cache);
                    none.insert(tangent.map_err(|error| explain(&registry, error))?)
                }
            };
            let rate = |output| run.model.output_rate(state, &mut run.cache, tangent, output);
            let found: Result<Vec<f64>, _> = outputs.into_iter().map(rate).collect();
            found.map_err(|error| explain(&registry, error))
        })
    }
}

/// Refuses a step of `dt` [s] over which an input leaves its bounds by more than rounding.
pub(in crate::fmi) fn check_path(
    registry: &Registry,
    state: &State,
    dt: f64,
) -> Result<(), ModelError> {
    let path = InputPath::new(&state.inputs, &state.derivatives);
    if path.is_held() {
        return Ok(());
    }
    for after in path.turns(dt).into_iter().chain([dt]) {
        let (inputs, sizes) = (path.at(0, after), path.sizes(after));
        for variable in &registry.variables {
            let Slot::Input(index) = variable.slot else { continue };
            let value = variable.rounded(inputs[index], sizes[index]);
            if let Some(why) = variable.objection(value) {
                let message = format!("{value:?}: {why}");
                return Err(BodyError::Underway { index, message, after }.into());
            }
        }
    }
    Ok(())
}

/// Sets inputs that have ended a step beyond their bounds by rounding to the ends of these.
pub(in crate::fmi) fn keep_within_bounds(registry: &Registry, state: &mut State) {
    for variable in &registry.variables {
        let Slot::Input(index) = variable.slot else { continue };
        let input = &mut state.inputs[index];
        *input = variable.rounded(*input, f64::MAX);
    }
}

pub(in crate::fmi) fn outputs<'a>(
    registry: &'a Registry,
    references: &[Reference],
) -> Answer<Vec<&'a Output>> {
    let output = |variable: &'a Variable| match &variable.slot {
        Slot::Output(output) => Ok(output),
        _ => Err(Refusal::error(format!("{} is no output", variable.name))),
    };
    find(registry, references, Kind::Real)?.into_iter().map(output).collect()
}

/// Inputs with their places in a state.
fn inputs<'a>(
    registry: &'a Registry,
    references: &[Reference],
) -> Answer<Vec<(usize, &'a Variable)>> {
    let input = |variable: &'a Variable| match variable.slot {
        Slot::Input(index) if !variable.is_tunable => Ok((index, variable)),
        _ => Err(Refusal::error(format!("{} is no input", variable.name))),
    };
    find(registry, references, Kind::Real)?.into_iter().map(input).collect()
}

fn check_order(variable: &Variable, order: i32, highest: usize) -> Answer<()> {
    match order {
        _ if highest == 0 => Err(Refusal::error(format!(
            "no derivative of {}: this unit offers none of its outputs",
            variable.name
        ))),
        _ if (1..=highest as i32).contains(&order) => Ok(()),
        _ => Err(Refusal::error(format!(
            "derivative of order {order} of {}; allowed: 1 to {highest}",
            variable.name
        ))),
    }
}

pub(in crate::fmi) fn check_finite(name: &str, value: f64) -> Answer<()> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(Refusal::error(format!("{name} = {value}: must be finite"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::scene;

    const STRAND: &str = include_str!("../../../tests/scenes/filament.toml");

    fn strand() -> Scene {
        scene::parse(STRAND, "strand.toml").unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn solids_below_a_filament_have_no_time_derivatives() {
        let scene = strand();
        assert_eq!(highest_output_derivative(&scene), 0);
        let model = Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
        let (state, mut cache) = (model.initial_state(), Cache::default());
        let mut tangent = model.time_tangent(&state, &mut cache).unwrap();
        let registry = Registry::of(&scene);
        let Slot::Output(heat) =
            &registry.variables[registry.find("plate.heat_stored").unwrap()].slot
        else {
            panic!("an output")
        };
        let rate = model.output_rate(&state, &mut cache, &mut tangent, heat);
        assert!(matches!(rate, Err(ModelError::Body(BodyError::NoRate))));
        // Inputs act on the plate as on any other.
        let none = vec![0.0; state.inputs.len()];
        let mut tangent = model.input_tangent(&state, &none).unwrap();
        let rate = model.output_rate(&state, &mut cache, &mut tangent, heat);
        assert_eq!(rate.unwrap(), 0.0);
    }

    #[test]
    fn solids_without_others_on_them_have_time_derivatives() {
        assert_eq!(highest_output_derivative(&Unit::for_tests().scene), 1);
    }

    #[test]
    fn units_without_a_linear_solid_have_no_time_derivatives() {
        let bodies = ["gel", "concrete", "lattice", "crack"];
        for (name, text) in bodies.into_iter().zip([
            include_str!("../../../tests/scenes/gel.toml"),
            include_str!("../../../tests/scenes/concrete.toml"),
            include_str!("../../../tests/scenes/lattice.toml"),
            include_str!("../../../tests/scenes/crack.toml"),
        ]) {
            let scene = scene::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(highest_output_derivative(&scene), 0, "{name}");
        }
    }

    /// A flow that falls to zero over a step ends at −1.7e-24 m³/s by rounding.
    #[test]
    fn flows_may_end_below_zero_by_rounding() {
        let Unit { registry, mut state, .. } = Unit::of_scene_for_tests(STRAND);
        let Slot::Input(flow) = registry.variables[registry.find("ink.flow").unwrap()].slot else {
            panic!("an input")
        };
        let dt = 0.035;
        state.inputs[flow] = 9.4e-9;
        state.derivatives = vec![vec![0.0; state.inputs.len()]];
        state.derivatives[0][flow] = -9.4e-9 / dt;
        check_path(&registry, &state, dt).unwrap();
        let mut end = state.clone();
        end.inputs = InputPath::new(&state.inputs, &state.derivatives).at(0, dt);
        assert!(end.inputs[flow] < 0.0);
        keep_within_bounds(&registry, &mut end);
        assert_eq!(end.inputs[flow], 0.0);
        state.derivatives[0][flow] *= 1.0 + 1e-6;
        assert!(check_path(&registry, &state, dt).is_err());
    }

    /// A radius that grows to the end of its range exceeds it by rounding, and so does one that a host computes.
    #[test]
    fn radii_may_exceed_their_range_by_rounding() {
        let mut unit = Unit::for_tests();
        let radius = [unit.registry.find("spot.radius").unwrap() as Reference];
        unit.enter_initialization().unwrap();
        unit.set_reals(&radius, &[4e-5]).unwrap();
        unit.finish_initialization().unwrap();
        let dt = 81.0 * 1e-9;
        let slope = (9e-5 - 4e-5) / dt;
        assert!(4e-5 + dt * slope > 9e-5);
        unit.set_input_derivatives(&radius, &[1], &[slope]).unwrap();
        unit.step(0.0, dt).unwrap();
        assert_eq!(unit.reals(&radius).unwrap(), [9e-5]);
        unit.set_reals(&radius, &[9e-5_f64.next_up()]).unwrap();
        assert_eq!(unit.reals(&radius).unwrap(), [9e-5]);
        assert!(unit.set_reals(&radius, &[9.0001e-5]).is_err());
    }
}

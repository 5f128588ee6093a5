//! Gets and sets variables by reference, in safe Rust.
//!
//! A set is all or nothing: every reference and value is checked before the first one is stored.

use std::ffi::CString;
use std::sync::Arc;

use super::Unit;
use super::built::{expect_room, explain};
use super::kind::{Kind, look_up, wrong_type};
use crate::fmi::gate::answer::{Answer, Reference, Refusal, Status};
use crate::quantity::Quantity;
use crate::runtime::address_space::SPARE;
use crate::runtime::thread::{STACK, aside};
use crate::variables::{Causality, Output, Registry, Slot, Variable};

impl Unit {
    /// Returns values of Real variables.
    pub fn reals(&mut self, references: &[Reference]) -> Answer<Vec<f64>> {
        let registry = Arc::clone(&self.registry);
        let variables = find(&registry, references, Kind::Real)?;
        let mut outputs = self.outputs(&registry, &variables)?.into_iter();
        let value = |variable: &Variable| match &variable.slot {
            Slot::Parameter(parameter) => Ok(parameter.get(&self.scene)),
            Slot::Input(index) => Ok(self.state.inputs[*index]),
            Slot::Output(_) => Ok(outputs.next().expect("as many as there are outputs")),
            Slot::Threads | Slot::OutputDirectory => Err(wrong_kind(variable, Kind::Real)),
        };
        let values: Vec<f64> = variables.iter().copied().map(value).collect::<Answer<_>>()?;
        self.warn_of_values(&variables, &values);
        Ok(values)
    }

    /// Warns once of each output whose value is less accurate than it seems.
    fn warn_of_values(&mut self, variables: &[&Variable], values: &[f64]) {
        let Some(run) = self.run.as_ref() else { return };
        let has_substances = !self.scene.substances.is_empty();
        let model = Arc::clone(&run.model);
        for (variable, &value) in variables.iter().zip(values) {
            let warning =
                output_of(variable).and_then(|output| model.warning_on_value(output, value));
            self.warn_once(warning.map(|warning| warning.of_subject(&variable.name)));
            if has_substances
                && let Some(output) = output_of(variable)
                && variable.quantity == Some(Quantity::Temperature)
            {
                self.warn_once(model.warning_on_temperature(output.body, value));
            }
        }
    }

    /// Returns values of those variables that are outputs.
    fn outputs(&mut self, registry: &Registry, variables: &[&Variable]) -> Answer<Vec<f64>> {
        if !variables.iter().any(|variable| output_of(variable).is_some()) {
            return Ok(Vec::new());
        }
        self.run()?;
        self.expect_room()?;
        let (run, state) = self.run()?;
        let (model, cache) = (Arc::clone(&run.model), &mut run.cache);
        model.refresh(state, cache);
        let mut outputs = variables.iter().filter_map(output_of);
        let is_deep = outputs.any(|output| model.is_deep(state, cache, output));
        let read = || {
            let reader = model.reader(state, cache);
            let mut reader = reader.map_err(|error| explain(registry, error))?;
            let value = |variable: &&Variable| {
                Some(reader.value(output_of(variable)?).map_err(|error| {
                    let reason = explain(registry, error).message;
                    Refusal::error(format!("no value of {}: {reason}", variable.name))
                }))
            };
            variables.iter().filter_map(value).collect()
        };
        aside_if(is_deep, read)
    }

    /// Values of Integer variables.
    pub fn integers(&self, references: &[Reference]) -> Answer<Vec<i32>> {
        let variables = find(&self.registry, references, Kind::Integer)?;
        let threads = i32::try_from(self.scene.solver.threads).unwrap_or(i32::MAX);
        Ok(vec![threads; variables.len()])
    }

    /// Returns texts, which the unit keeps until the next call.
    pub fn texts(&mut self, references: &[Reference]) -> Answer<&[CString]> {
        let variables = find(&self.registry, references, Kind::Text)?;
        let text = CString::new(self.directory.as_str()).unwrap_or_default();
        self.texts = vec![text; variables.len()];
        Ok(&self.texts)
    }

    /// Returns the refusal of a variable whose type is not that of a function, or of an unknown reference.
    pub fn scalar_of_another_type(&self, reference: Reference, wanted: &str) -> Refusal {
        match look_up(&self.registry.variables, reference) {
            Ok(variable) => {
                wrong_type(&variable.name, wanted, Kind::of(&variable.slot).of_scalars())
            }
            Err(unknown) => unknown,
        }
    }

    /// Sets Real variables, all or none. Inputs that exceed their bounds by rounding get the ends of these.
    pub fn set_reals(&mut self, references: &[Reference], values: &[f64]) -> Answer {
        let registry = Arc::clone(&self.registry);
        let variables = find(&registry, references, Kind::Real)?;
        let mut rounded = Vec::with_capacity(values.len());
        for (variable, &value) in variables.iter().zip(values) {
            self.check_settable(variable)?;
            let value = variable.rounded_alone(value);
            check_bounds(variable, value)?;
            rounded.push(value);
        }
        let mut scene = None;
        let mut has_changed = false;
        for (variable, value) in variables.iter().zip(rounded) {
            match &variable.slot {
                Slot::Parameter(parameter) => {
                    parameter.set(scene.get_or_insert_with(|| self.scene.clone()), value);
                }
                // Compares bits, so that a zero of the other sign is read back as set.
                Slot::Input(index) => {
                    let input = &mut self.state.inputs[*index];
                    has_changed |= input.to_bits() != value.to_bits();
                    *input = value;
                }
                Slot::Threads | Slot::OutputDirectory | Slot::Output(_) => {}
            }
        }
        if has_changed {
            self.forget_past_inputs();
        }
        if let Some(scene) = scene {
            self.set_scene(scene);
        }
        self.warn_of_implausible(&variables, values);
        Ok(Status::Ok)
    }

    /// Warns once of each input with an implausible value, and of one element per array.
    fn warn_of_implausible(&mut self, variables: &[&Variable], values: &[f64]) {
        for (variable, &value) in variables.iter().zip(values) {
            let together = || variable.implausible_among(&self.scene, &self.state.inputs);
            let warning = variable.implausible(&self.scene, value).or_else(together);
            let subject = format!("input {}", variable.family());
            self.warn_once(warning.map(|warning| warning.of_subject(subject)));
        }
    }

    /// Sets Integer variables, all or none.
    pub fn set_integers(&mut self, references: &[Reference], values: &[i32]) -> Answer {
        let registry = Arc::clone(&self.registry);
        let variables = find(&registry, references, Kind::Integer)?;
        for (variable, &value) in variables.iter().zip(values) {
            self.check_settable(variable)?;
            check_bounds(variable, f64::from(value))?;
        }
        // `solver.threads` is the only Integer; the last value counts.
        if let Some(threads) = values.last().and_then(|&value| usize::try_from(value).ok()) {
            let mut scene = self.scene.clone();
            scene.solver.threads = threads;
            self.set_scene(scene);
        }
        Ok(Status::Ok)
    }

    /// Sets String variables, all or none.
    pub fn set_texts(&mut self, references: &[Reference], values: Vec<String>) -> Answer {
        let registry = Arc::clone(&self.registry);
        for variable in find(&registry, references, Kind::Text)? {
            self.check_settable(variable)?;
        }
        // `output.directory` is the only String; the last value counts.
        if let Some(directory) = values.into_iter().last() {
            self.directory = directory;
        }
        Ok(Status::Ok)
    }

    fn check_settable(&self, variable: &Variable) -> Answer<()> {
        let name = &variable.name;
        match variable.causality() {
            Causality::Output => Err(Refusal::error(format!("{name} is an output"))),
            Causality::Parameter if !variable.is_tunable && self.phase.is_running() => {
                Err(Refusal::error(format!(
                    "{name} is a fixed parameter: it may be set until initialisation ends"
                )))
            }
            Causality::Parameter | Causality::Input => Ok(()),
        }
    }
}

fn output_of<'a>(variable: &&'a Variable) -> Option<&'a Output> {
    match &variable.slot {
        Slot::Output(output) => Some(output),
        _ => None,
    }
}

/// Runs `work`, on a thread of our own if it needs much stack.
pub(in crate::fmi) fn aside_if<R: Send>(
    is_deep: bool,
    work: impl FnOnce() -> Answer<R> + Send,
) -> Answer<R> {
    if !is_deep {
        return work();
    }
    expect_room(STACK + SPARE)?;
    aside(work)
}

/// Returns the variables of these references, all of one kind.
pub(in crate::fmi) fn find<'a>(
    registry: &'a Registry,
    references: &[Reference],
    kind: Kind,
) -> Answer<Vec<&'a Variable>> {
    let of_kind = |&reference: &Reference| {
        let variable = look_up(&registry.variables, reference)?;
        let fits = Kind::of(&variable.slot) == kind;
        if fits { Ok(variable) } else { Err(wrong_kind(variable, kind)) }
    };
    references.iter().map(of_kind).collect()
}

fn wrong_kind(variable: &Variable, wanted: Kind) -> Refusal {
    wrong_type(&variable.name, wanted.of_scalars(), Kind::of(&variable.slot).of_scalars())
}

pub(in crate::fmi) fn check_bounds(variable: &Variable, value: f64) -> Answer<()> {
    variable.refusal(value).map_or(Ok(()), |message| Err(Refusal::error(message)))
}

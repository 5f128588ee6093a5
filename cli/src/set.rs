use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use impinge::limits::Bounds;
use impinge::model::initial_inputs;
use impinge::scene::{self, Carries, Scene};
use impinge::variables::{Causality, Quantity, Registry, Slot, Value, Variable};
use impinge::warning::Warning;

/// A value for a variable, as given on the command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    name: String,
    value: String,
}

impl FromStr for Assignment {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
        Ok(Self { name: name.trim().to_owned(), value: value.trim().to_owned() })
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} = {}", self.name, self.value)
    }
}

/// Index into a state's inputs, and its value.
pub type InputValue = (usize, f64);

/// All errors of a list of assignments.
#[derive(Debug, PartialEq, Eq)]
pub struct SetErrors(Vec<SetError>);

impl std::error::Error for SetErrors {}

impl fmt::Display for SetErrors {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let lines: Vec<String> = self.0.iter().map(ToString::to_string).collect();
        f.write_str(&lines.join("\nerror: "))
    }
}

#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetError {
    #[error("cannot set {name}: there is no such parameter or input{}", suggestion(close))]
    Unknown { name: String, close: Vec<String> },
    #[error("cannot set {name}: it is an output")]
    Output { name: String },
    #[error("cannot set {name}: --out sets the folder of a run's files")]
    Directory { name: String },
    #[error("cannot set {name}: it is set twice; allowed: one --set {name}=VALUE")]
    Twice { name: String },
    #[error("cannot set {name} = {value}: expected {expected}")]
    Value { name: String, value: String, expected: String },
}

/// Sets parameters in the scene, and returns the inputs for the state. A name without indices denotes all elements of
/// an array.
///
/// Bounds are those of the registry; the scene's own check then decides on parameters.
pub fn apply(scene: &mut Scene, assignments: &[Assignment]) -> Result<Vec<InputValue>, SetErrors> {
    let registry = Registry::of(scene);
    let mut inputs = Vec::new();
    let mut errors = Vec::new();
    let mut known = BTreeSet::new();
    for assignment in assignments {
        if !known.insert(&assignment.name) {
            errors.push(SetError::Twice { name: assignment.name.clone() });
        }
        match targets(&registry, &assignment.name) {
            Ok(variables) => {
                let results =
                    variables.into_iter().map(|v| put(v, &assignment.value, scene, &mut inputs));
                // Elements of an array share their bounds, so one error suffices for all.
                errors.extend(results.filter_map(Result::err).next());
            }
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(inputs) } else { Err(SetErrors(errors)) }
}

/// Warnings of implausible values of inputs, one per array.
pub fn implausible(scene: &Scene, inputs: &[InputValue]) -> Vec<Warning> {
    let registry = Registry::of(scene);
    let mut warned = BTreeSet::new();
    let mut warnings = Vec::new();
    for &(index, value) in inputs {
        let is_meant = |variable: &&Variable| variable.slot == Slot::Input(index);
        let Some(variable) = registry.variables.iter().find(is_meant) else { continue };
        let warning = variable.implausible(scene, value);
        warnings.extend(warning.filter(|_| warned.insert(variable.family())));
    }
    warnings
}

/// Warnings of powers and radii of loads that make implausible heat fluxes together, one per input; each list holds
/// inputs that are set at one time.
pub fn implausible_together(
    scene: &Scene,
    lists: impl IntoIterator<Item = Vec<InputValue>>,
) -> Vec<Warning> {
    if !scene.load.iter().any(|load| load.carries.contains(&Carries::Power)) {
        return Vec::new();
    }
    let registry = Registry::of(scene);
    let is_judged = |variable: &&Variable| {
        matches!(variable.quantity, Some(Quantity::HeatFlow | Quantity::Length))
    };
    let judged: Vec<&Variable> = registry.variables.iter().filter(is_judged).collect();
    let start = initial_inputs(scene);
    let mut warned = BTreeSet::new();
    let mut warnings = Vec::new();
    for list in lists {
        let mut inputs = start.clone();
        list.iter().for_each(|&(index, value)| inputs[index] = value);
        let is_set = |variable: &&&Variable| {
            list.iter().any(|&(index, _)| variable.slot == Slot::Input(index))
        };
        for variable in judged.iter().filter(is_set) {
            let warning = variable.implausible_among(scene, &inputs);
            warnings.extend(warning.filter(|_| warned.insert(&variable.name)));
        }
    }
    warnings
}

/// The variables that a name denotes: at least one, none of them an output.
pub fn targets<'a>(registry: &'a Registry, name: &str) -> Result<Vec<&'a Variable>, SetError> {
    let found: Vec<&Variable> = match registry.find(name) {
        Some(reference) => vec![&registry.variables[reference]],
        None => registry.variables.iter().filter(|v| array_name(&v.name) == name).collect(),
    };
    if found.is_empty() {
        return Err(SetError::Unknown {
            name: name.to_owned(),
            close: close_names(registry, name),
        });
    }
    if found.iter().any(|variable| variable.causality() == Causality::Output) {
        return Err(SetError::Output { name: name.to_owned() });
    }
    Ok(found)
}

fn put(
    variable: &Variable,
    value: &str,
    scene: &mut Scene,
    inputs: &mut Vec<InputValue>,
) -> Result<(), SetError> {
    match &variable.slot {
        Slot::Parameter(parameter) => parameter.set(scene, number(variable, value)?),
        Slot::Threads => scene.solver.threads = number(variable, value)? as usize,
        Slot::Input(index) => inputs.push((*index, number(variable, value)?)),
        Slot::OutputDirectory => {
            return Err(SetError::Directory { name: variable.name.clone() });
        }
        Slot::Output(_) => return Err(SetError::Output { name: variable.name.clone() }),
    }
    Ok(())
}

/// Parses a finite number within the variable's bounds, whole if the variable is; texts with units stand for numbers.
pub fn number(variable: &Variable, text: &str) -> Result<f64, SetError> {
    let with_unit = || {
        let is_temperature = variable.quantity == Some(Quantity::Temperature);
        scene::quantity(text, variable.unit()?, is_temperature).ok()
    };
    let is_whole = matches!(variable.start, Some(Value::Integer(_)));
    let fits = |value: &f64| {
        value.is_finite() && variable.bounds.hold(*value) && (!is_whole || value.fract() == 0.0)
    };
    text.parse().ok().or_else(with_unit).filter(fits).ok_or_else(|| SetError::Value {
        name: variable.name.clone(),
        value: text.to_owned(),
        expected: expectation(variable, is_whole),
    })
}

/// Describes the values that a variable accepts.
fn expectation(variable: &Variable, is_whole: bool) -> String {
    let kind = if is_whole { "a whole number" } else { "a number" };
    let unit = variable.unit().map_or(String::new(), |unit| format!(" in {unit}"));
    let bounds = match variable.bounds {
        none if none == Bounds::default() => String::new(),
        bounds => format!(", {bounds}"),
    };
    format!("{kind}{unit}{bounds}")
}

/// At most three settable names similar to `name`, the most similar first.
fn close_names(registry: &Registry, name: &str) -> Vec<String> {
    const ALIKE: f64 = 0.8;
    let likeness = |candidate: &str| {
        let last = candidate.rsplit('.').next().unwrap_or(candidate);
        strsim::jaro_winkler(candidate, name).max(strsim::jaro_winkler(last, name))
    };
    let settable: BTreeSet<&str> = [Causality::Parameter, Causality::Input]
        .into_iter()
        .flat_map(|causality| registry.of_causality(causality))
        .map(|reference| array_name(&registry.variables[reference].name))
        .collect();
    let mut ranked: Vec<(f64, &str)> =
        settable.into_iter().map(|candidate| (likeness(candidate), candidate)).collect();
    ranked.retain(|(likeness, _)| *likeness >= ALIKE);
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(3).map(|(_, name)| name.to_owned()).collect()
}

fn suggestion(close: &[String]) -> String {
    if close.is_empty() {
        "; `impinge check --list` lists them".into()
    } else {
        format!("; did you mean {}?", close.join(" or "))
    }
}

/// Name of an array that `name` is an element of; a scalar's own name.
fn array_name(name: &str) -> &str {
    name.split_once('[').map_or(name, |(array, _)| array)
}

//! The registry of a unit's variables.

use std::collections::HashMap;

use super::{Parameter, inputs, outputs, parameters};
use crate::body::Reading;
use crate::limits::{self, Bounds};
use crate::quantity::Quantity;
use crate::scene::{Naming, Scene};

/// All variables of a scene's unit. The value reference of a variable is its place in the list.
#[derive(Debug, Clone, PartialEq)]
pub struct Registry {
    pub variables: Vec<Variable>,
    by_name: HashMap<String, usize>,
}

/// One variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    pub name: String,
    pub description: String,
    pub slot: Slot,
    /// Set for reals.
    pub quantity: Option<Quantity>,
    /// Start value; none for outputs.
    pub start: Option<Value>,
    /// Allowed values.
    pub bounds: Bounds,
    /// True for an input that cannot be connected: a parameter that may be set between steps.
    pub is_tunable: bool,
}

/// A value of one of the FMI types in use.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Real(f64),
    Integer(i32),
    Text(String),
}

/// Meaning of a variable, and so the location of its value.
#[derive(Debug, Clone, PartialEq)]
pub enum Slot {
    /// Constant of the scene.
    Parameter(Parameter),
    /// Number of threads a unit may use.
    Threads,
    /// Folder for field files.
    OutputDirectory,
    /// Index into the state's inputs.
    Input(usize),
    /// Computed from the state.
    Output(Output),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    Parameter,
    Input,
    Output,
}

/// A computed value: a reading of a body, given by the body's place among the scene's.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    pub body: usize,
    pub reading: Reading,
}

/// Part of the terms of a sum by which it may be off.
const ROUNDING: f64 = 1e-9;

impl Variable {
    pub fn causality(&self) -> Causality {
        match self.slot {
            Slot::Parameter(_) | Slot::Threads | Slot::OutputDirectory => Causality::Parameter,
            Slot::Input(_) if self.is_tunable => Causality::Parameter,
            Slot::Input(_) => Causality::Input,
            Slot::Output(_) => Causality::Output,
        }
    }

    /// Smallest value, which may itself be excluded.
    pub fn min(&self) -> Option<f64> {
        self.bounds.low.map(|end| end.value)
    }

    /// Largest value, which may itself be excluded.
    pub fn max(&self) -> Option<f64> {
        self.bounds.high.map(|end| end.value)
    }

    /// Returns why the variable cannot have a value, with its name and the allowed values.
    pub fn refusal(&self, value: f64) -> Option<String> {
        let why = self.objection(value)?;
        Some(format!("{} = {value:?}: {why}", self.name))
    }

    /// Returns why the variable cannot have a value, with the allowed values.
    pub fn objection(&self, value: f64) -> Option<String> {
        if !value.is_finite() {
            return Some("must be finite".to_owned());
        }
        let required = self.bounds.requirement(self.bounds.side(value)?);
        Some(format!("{required} (allowed: {}{})", self.bounds, self.unit_after()))
    }

    /// Returns the end of the bounds that an input exceeds by rounding alone, or else the value. `size` is that of the
    /// terms of which the value is the sum. Counts have no rounding, nor has what is not finite.
    pub fn rounded(&self, value: f64, size: f64) -> f64 {
        match (&self.slot, self.quantity) {
            (Slot::Input(_), Some(quantity))
                if quantity != Quantity::Count && value.is_finite() =>
            {
                self.bounds.rounded(value, ROUNDING * size)
            }
            _ => value,
        }
    }

    /// Returns the value that a host may set for an input that it has computed, see [`rounded`](Self::rounded).
    pub fn rounded_alone(&self, value: f64) -> f64 {
        let nominal = self.quantity.map_or(0.0, Quantity::nominal);
        self.rounded(value, nominal.max(value.abs()))
    }

    /// Returns why a time derivative of the variable cannot have a value: the variable would cross its whole range
    /// within the shortest step.
    pub fn refusal_of_derivative(&self, order: i32, value: f64) -> Option<String> {
        let shortest = limits::step().bounds().low.map_or(0.0, |end| end.value);
        let steepest = self.bounds.span() / shortest.powi(order);
        let (why, allowed) = match value.is_finite() {
            true if value.abs() <= steepest => return None,
            true => (
                "is steeper than any step resolves",
                format!(" (allowed: up to ±{})", limits::number(steepest)),
            ),
            false => ("must be finite", String::new()),
        };
        let name = &self.name;
        Some(format!("derivative of order {order} of {name} = {value:?}: {why}{allowed}"))
    }

    fn unit_after(&self) -> String {
        self.unit().map_or(String::new(), |unit| format!(" {unit}"))
    }

    /// Unit of a value that has one.
    pub fn unit(&self) -> Option<&'static str> {
        self.quantity.map(Quantity::unit).filter(|unit| *unit != "1")
    }

    /// The start value of a real.
    pub fn real_start(&self) -> Option<f64> {
        match self.start {
            Some(Value::Real(value)) => Some(value),
            _ => None,
        }
    }
}

impl Registry {
    /// Lists the variables of a checked scene: parameters, inputs, outputs.
    pub fn of(scene: &Scene) -> Self {
        let mut list = list(scene);
        if scene.naming == Naming::Flat {
            list.iter_mut().for_each(|variable| variable.name = flat(&variable.name));
        }
        Self::new(list)
    }

    /// Lists the variables under their structured names, which show what belongs together.
    pub fn structured(scene: &Scene) -> Self {
        Self::new(list(scene))
    }

    /// Lists only the inputs, including tunable parameters, under their structured names: outputs may be many.
    pub fn inputs(scene: &Scene) -> Vec<Variable> {
        let mut list = Vec::new();
        inputs::list(scene, &mut list);
        list
    }

    fn new(list: Vec<Variable>) -> Self {
        let by_name = list.iter().enumerate().map(|(i, v)| (v.name.clone(), i)).collect();
        Self { variables: list, by_name }
    }

    /// The value reference of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Value references of all variables of one causality.
    pub fn of_causality(&self, causality: Causality) -> impl Iterator<Item = usize> + '_ {
        (0..self.variables.len()).filter(move |&i| self.variables[i].causality() == causality)
    }
}

fn list(scene: &Scene) -> Vec<Variable> {
    let mut list = Vec::new();
    parameters::list(scene, &mut list);
    inputs::list(scene, &mut list);
    outputs::list(scene, &mut list);
    list
}

/// `a.b[1,2]` as `a_b_1_2`.
pub(super) fn flat(name: &str) -> String {
    name.replace(']', "").replace(['.', '[', ','], "_")
}

use std::collections::HashMap;

use super::{Parameter, inputs, outputs, parameters};
use crate::body::Reading;
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
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// Whether it is an input that nothing may be connected to: a parameter that may be set between steps.
    pub is_tunable: bool,
}

/// A value of one of the FMI types in use.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Real(f64),
    Integer(i32),
    Text(String),
}

/// What a variable stands for, and so where its value lives.
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

/// A computed value: what is read of which body, by its place among the scene's.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    pub body: usize,
    pub reading: Reading,
}

impl Variable {
    pub fn causality(&self) -> Causality {
        match self.slot {
            Slot::Parameter(_) | Slot::Threads | Slot::OutputDirectory => Causality::Parameter,
            Slot::Input(_) if self.is_tunable => Causality::Parameter,
            Slot::Input(_) => Causality::Input,
            Slot::Output(_) => Causality::Output,
        }
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

    /// The same variables under their structured names, from which one sees what belongs together.
    pub fn structured(scene: &Scene) -> Self {
        Self::new(list(scene))
    }

    /// The inputs alone under their structured names, tunable parameters among them: outputs may be many.
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

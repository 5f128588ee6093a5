//! A scene that runs, for tests: set, step, read by name.

use impinge::model::{Cache, Model, ModelError, NodalFields, State, Tangent};
use impinge::runtime::allowance::Allowance;
use impinge::scene::{self, Scene};
use impinge::variables::{Causality, Output, Registry, Slot};

pub struct Trial {
    pub model: Model,
    pub state: State,
    registry: Registry,
    cache: Cache,
}

impl Trial {
    /// Builds the scene of a text.
    pub fn new(text: &str) -> Self {
        Self::on_threads(text, 1)
    }

    pub fn on_threads(text: &str, threads: usize) -> Self {
        let scene = scene::parse(text, "scene").unwrap_or_else(|e| panic!("{e}\n{text}"));
        Self::with_scene(&scene, threads)
    }

    pub fn of(scene: Scene) -> Self {
        Self::with_scene(&scene, 1)
    }

    fn with_scene(scene: &Scene, threads: usize) -> Self {
        let model = Model::build(scene, threads).unwrap();
        let state = model.initial_state();
        Self { model, state, registry: Registry::of(scene), cache: Cache::default() }
    }

    pub fn set(&mut self, name: &str, value: f64) {
        let index = self.input(name);
        self.state.inputs[index] = value;
    }

    /// Sets a time derivative of an input.
    pub fn set_derivative(&mut self, name: &str, order: usize, value: f64) {
        let index = self.input(name);
        let count = self.state.inputs.len();
        let derivatives = &mut self.state.derivatives;
        derivatives.resize(derivatives.len().max(order), vec![0.0; count]);
        derivatives[order - 1][index] = value;
    }

    pub fn step(&mut self, dt: f64) {
        self.try_step(dt).unwrap();
    }

    pub fn try_step(&mut self, dt: f64) -> Result<(), ModelError> {
        self.model.step(&mut self.state, &mut self.cache, dt)
    }

    /// Takes a step, and returns how often it tried the fluxes between bodies in contact.
    pub fn exchanges_of_step(&mut self, dt: f64) -> u64 {
        let allowance = Allowance::default();
        let stepped =
            self.model.step_within(&allowance, &mut self.state, &mut self.cache, (dt, dt));
        stepped.unwrap();
        allowance.exchanges()
    }

    /// Values at all nodes of a body.
    pub fn fields(&mut self, body: &str) -> NodalFields {
        self.model.nodal_fields(&self.state, &mut self.cache, body).unwrap()
    }

    /// Puts a saved state back.
    pub fn restart(&mut self, state: &State) {
        self.state = state.clone();
        self.cache.clear();
    }

    pub fn get(&mut self, name: &str) -> f64 {
        let output = self.output(name);
        self.model.output(&self.state, &mut self.cache, &output).unwrap()
    }

    /// Ids of the warnings that values of bodies, probes and flaws give rise to.
    pub fn warnings_on_values(&mut self) -> Vec<&'static str> {
        let watched: Vec<_> = self.model.watched_outputs().collect();
        let warning = |(name, output): &(String, Output)| {
            let value = self.get(name);
            Some(self.model.warning_on_value(output, value)?.finding().id)
        };
        watched.iter().filter_map(warning).collect()
    }

    /// Time derivatives of outputs.
    pub fn rates(&mut self, names: &[String]) -> Vec<f64> {
        let tangent = self.model.time_tangent(&self.state, &mut self.cache).unwrap();
        self.follow(tangent, names).unwrap()
    }

    /// Changes of outputs when inputs change.
    pub fn changes(&mut self, names: &[String], inputs: &[(&str, f64)]) -> Vec<f64> {
        self.try_changes(names, inputs).unwrap()
    }

    pub fn try_changes(
        &mut self,
        names: &[String],
        inputs: &[(&str, f64)],
    ) -> Result<Vec<f64>, ModelError> {
        let mut direction = vec![0.0; self.state.inputs.len()];
        for (name, change) in inputs {
            direction[self.input(name)] = *change;
        }
        let tangent = self.model.input_tangent(&self.state, &direction)?;
        self.follow(tangent, names)
    }

    /// Names of all outputs but estimates of errors: constants, each of which costs a study of meshes.
    pub fn outputs(&self) -> Vec<String> {
        let outputs = self.registry.of_causality(Causality::Output);
        let names = outputs.map(|i| self.registry.variables[i].name.clone());
        names.filter(|name| !name.ends_with(".estimated_error")).collect()
    }

    /// The output of a name.
    pub fn output(&self, name: &str) -> Output {
        match self.slot(name) {
            Slot::Output(output) => output,
            _ => panic!("{name} is no output"),
        }
    }

    fn follow(&mut self, mut tangent: Tangent, names: &[String]) -> Result<Vec<f64>, ModelError> {
        let mut rate = |name: &String| {
            let output = self.output(name);
            self.model.output_rate(&self.state, &mut self.cache, &mut tangent, &output)
        };
        names.iter().map(&mut rate).collect()
    }

    pub fn input(&self, name: &str) -> usize {
        match self.slot(name) {
            Slot::Input(index) => index,
            _ => panic!("{name} is no input"),
        }
    }

    /// What heat came in, less what is stored and what was lost, relative to the largest of them.
    pub fn heat_residual(&mut self, body: &str) -> f64 {
        let [heat_in, stored, lost] =
            ["heat_in", "heat_stored", "heat_lost"].map(|key| self.get(&format!("{body}.{key}")));
        let largest = heat_in.abs().max(stored.abs()).max(lost.abs());
        (heat_in - stored - lost).abs() / largest
    }

    fn slot(&self, name: &str) -> Slot {
        let place = self.registry.find(name).unwrap_or_else(|| panic!("no variable {name}"));
        self.registry.variables[place].slot.clone()
    }
}

/// All values of a sweep where `SWEEP_ALL` is set, as `make verify` does; otherwise those at some places.
pub fn sweep<T: Copy>(all: &[T], places: &[usize]) -> Vec<T> {
    match std::env::var_os("SWEEP_ALL") {
        Some(_) => all.to_vec(),
        None => places.iter().map(|&place| all[place]).collect(),
    }
}

/// Relative difference to a wanted value other than zero.
pub fn off(value: f64, wanted: f64) -> f64 {
    (value / wanted - 1.0).abs()
}

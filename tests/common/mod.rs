//! A scene that runs, for tests: set, step, read by name.

use impinge::model::{Cache, Model, State};
use impinge::scene::{self, Scene};
use impinge::variables::{Registry, Slot};

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
        let scene: Scene = scene::parse(text, "scene").unwrap_or_else(|e| panic!("{e}\n{text}"));
        let model = Model::build(&scene, threads).unwrap();
        let state = model.initial_state();
        Self { model, state, registry: Registry::of(&scene), cache: Cache::default() }
    }

    pub fn set(&mut self, name: &str, value: f64) {
        match self.slot(name) {
            Slot::Input(index) => self.state.inputs[index] = value,
            _ => panic!("{name} is no input"),
        }
    }

    pub fn step(&mut self, dt: f64) {
        self.model.step(&mut self.state, &mut self.cache, dt).unwrap();
    }

    /// Puts a saved state back.
    pub fn restart(&mut self, state: &State) {
        self.state = state.clone();
        self.cache.clear();
    }

    pub fn get(&mut self, name: &str) -> f64 {
        match self.slot(name) {
            Slot::Output(output) => {
                self.model.output(&self.state, &mut self.cache, &output).unwrap()
            }
            _ => panic!("{name} is no output"),
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

/// Relative difference to a wanted value other than zero.
pub fn off(value: f64, wanted: f64) -> f64 {
    (value / wanted - 1.0).abs()
}

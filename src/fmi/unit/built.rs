//! The model of a unit, built lazily and kept consistent with the inputs.

use std::sync::Arc;

use super::Unit;
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::model::{BodyError, Cache, Model, ModelError, State, Tangent, to_be_recorded};
use crate::runtime::address_space::{self, PRODUCTS, SPARE};
use crate::runtime::available_memory;
use crate::runtime::thread::{STACK, aside};
use crate::scene::{self, Scene};
use crate::variables::{Registry, Slot, Variable};

/// A built model, with results of the present state.
pub struct Run {
    pub model: Arc<Model>,
    pub cache: Cache,
    /// Time derivative of the state, if it was computed.
    pub tangent: Option<Tangent>,
    /// True if the inputs have been checked together since they changed.
    pub checked: bool,
}

impl Run {
    /// Wraps a model without any results.
    pub fn new(model: Arc<Model>) -> Self {
        Self { model, cache: Cache::default(), tangent: None, checked: false }
    }
}

impl Unit {
    /// Returns the model, built if necessary, and the state with valid inputs.
    pub fn run(&mut self) -> Answer<(&mut Run, &mut State)> {
        let run = match self.run.take() {
            Some(run) => run,
            None => self.build()?,
        };
        let run = self.run.insert(run);
        if !run.checked {
            let checked = run.model.check_inputs(&self.state.inputs);
            checked.map_err(|error| explain(&self.registry, error))?;
            run.checked = true;
        }
        Ok((run, &mut self.state))
    }

    fn build(&mut self) -> Answer<Run> {
        for note in self.to_be_recorded() {
            self.log.send(Status::Ok, &note);
        }
        let model = match self.model_of(&self.scene) {
            // Kept data may occupy the missing memory.
            Err(_) if !self.kept.is_empty() => {
                self.kept.clear();
                self.model_of(&self.scene)?
            }
            other => other?,
        };
        self.kept.clear();
        self.reductions.clear();
        self.warn_of_scene();
        for note in self.reduced_anew(&model) {
            self.log.send(Status::Ok, &note);
        }
        for note in model.notes() {
            self.log.send(Status::Ok, &note);
        }
        self.warn_once(model.tolerance_warnings());
        // Meshes are kept, whatever the parameters become.
        self.scene.refinement.clone_from(&model.scene().refinement);
        self.state.bodies = model.initial_state().bodies;
        Ok(Run::new(model))
    }

    /// Solids whose stored reduction differs from that of a model.
    fn reduced_anew(&self, model: &Model) -> Vec<String> {
        let anew = model.reductions().into_iter().filter_map(|(name, reduction)| {
            let stored = self.stored.iter().find(|(body, _)| *body == name)?;
            let note = format!(
                "{name}: reduced anew, as the reduction that the unit has stored belongs to other parameters"
            );
            (stored.1 != reduction).then_some(note)
        });
        anew.collect()
    }

    /// Returns the recordings to be computed before the first step, which neither this process nor the unit holds.
    fn to_be_recorded(&self) -> Vec<String> {
        let scene = &self.scene;
        if !scene.has_replayed_drops() {
            return Vec::new();
        }
        aside(|| match scene::check(scene) {
            Ok(()) => to_be_recorded(scene),
            Err(_) => Vec::new(),
        })
    }

    /// Refuses to read or copy the state if there is too little address space.
    pub fn expect_room(&self) -> Answer<()> {
        let room = |run: &Run| run.model.room(&self.state);
        expect_room(self.run.as_ref().map_or(0, room))
    }

    /// Returns the model of a scene with parameters.
    pub fn model_of(&self, scene: &Scene) -> Answer<Arc<Model>> {
        expect_room(STACK + PRODUCTS + SPARE)?;
        let model = aside(|| {
            scene::check(scene)?;
            Model::shared(scene, scene.solver.threads, available_memory())
        });
        model.map_err(|error| explain(&self.registry, error))
    }

    /// Discards all results that followed from other inputs.
    pub fn forget_past_inputs(&mut self) {
        self.is_settled = false;
        self.forget_past_derivatives();
        if let Some(run) = &mut self.run {
            run.cache.expect_inputs();
            run.checked = false;
        }
    }

    /// Replaces the scene by one with other parameters; a model of the old ones is dropped.
    pub fn set_scene(&mut self, scene: Scene) {
        if scene == self.scene {
            return;
        }
        self.drop_run();
        self.state.bodies.clear();
        self.state.peaks.clear();
        self.scene = scene;
        self.scene.forget_estimates();
    }

    /// Drops the model and the results of the state, except its stiffness and its reductions.
    pub fn drop_run(&mut self) {
        if let Some(run) = self.run.take() {
            self.kept = run.model.stiffness();
            self.reductions = run.model.reductions();
        }
    }

    /// Drops the derivatives of inputs at the end of the last step, unless they were set since.
    pub fn forget_past_derivatives(&mut self) {
        if !self.has_set_derivatives {
            self.state.derivatives.clear();
        }
        if let Some(run) = &mut self.run {
            run.tangent = None;
        }
    }
}

/// Refuses an operation that needs more address space than there is.
pub fn expect_room(bytes: usize) -> Answer<()> {
    address_space::expect(bytes).map_err(|error| Refusal::error(error.to_string()))
}

/// Converts an error of the model to a message that names the variable at fault.
pub fn explain(registry: &Registry, error: ModelError) -> Refusal {
    let message = error.to_string();
    let (status, index) = match error {
        ModelError::Body(error) => match error {
            BodyError::Input { index, .. } => (Status::Error, Some(index)),
            BodyError::Underway { index, .. } => (Status::Discard, Some(index)),
            BodyError::Overflow { .. }
            | BodyError::BelowAbsoluteZero { .. }
            | BodyError::Unbalanced { .. }
            | BodyError::Droplet { .. }
            | BodyError::Contact { .. }
            | BodyError::Reduction { .. }
            | BodyError::Heat { .. }
            | BodyError::Equilibrium { .. }
            | BodyError::Cracking { .. }
            | BodyError::Uneven { .. }
            | BodyError::LargeStrain { .. }
            | BodyError::Filament { .. }
            | BodyError::Lattice { .. }
            | BodyError::NoRoom(_)
            | BodyError::Halted { .. } => (Status::Discard, None),
            BodyError::NotFinite(_)
            | BodyError::Solver(_)
            | BodyError::NoSuchReading
            | BodyError::NoRate => (Status::Error, None),
        },
        _ => (Status::Error, None),
    };
    let is_at_fault = |v: &&Variable| index.is_some_and(|index| v.slot == Slot::Input(index));
    let message = match registry.variables.iter().find(is_at_fault) {
        Some(variable) => format!("{}: {message}", variable.name),
        None => message,
    };
    Refusal { status, message }
}

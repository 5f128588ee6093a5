//! What an instance is and does, in safe Rust: its life from instantiation to the last step.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ffi::CString;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

mod packed;
mod warnings;

pub use packed::{Packed, read};

use super::legality::{Function, Phase};
use super::log::Log;
use super::rates::check_path;
use super::saved::SavedStates;
use super::step_control::StepControl;
use super::types::{Answer, Refusal, Status};
use crate::model::{
    BodyError, Cache, Kept, KeptReduction, Model, ModelError, State, Stiffness, Tangent,
    check_step_length, initial_inputs, to_be_recorded,
};
use crate::output::{FieldSeries, FolderLock};
use crate::runtime::address_space::{self, PRODUCTS, SPARE};
use crate::runtime::allowance::{Halt, Interrupt};
use crate::runtime::available_memory;
use crate::runtime::thread::{STACK, aside};
use crate::scene::{self, Scene};
use crate::variables::{ArrayRegistry, Registry, Slot, Variable};
use crate::warning::Warning;

/// A time is taken for another one if they differ by less than this part of the step …
const STEP_TOLERANCE: f64 = 1e-9;
/// … plus this part of the times themselves, which masters sum up with rounding errors.
const TIME_TOLERANCE: f64 = 1e-13;

/// One instance of a unit.
pub struct Unit {
    pub log: Log,
    pub phase: Phase,
    /// What the last fmi2GetString or fmi3GetString gave pointers to.
    pub texts: Vec<CString>,
    /// The states that the master has saved and not freed.
    pub(super) saved: SavedStates,
    pub(super) registry: Arc<Registry>,
    /// The variables as FMI 3.0 counts them, listed when first asked for.
    pub(super) arrays: OnceCell<Arc<ArrayRegistry>>,
    pub(super) guid: String,
    /// The scene as packed.
    pub(super) packed: Scene,
    /// The scene with the parameters that were set.
    pub(super) scene: Scene,
    /// Folder for field files; nothing is written if empty.
    pub(super) directory: String,
    pub(super) experiment: Experiment,
    /// Time and inputs, and the unknowns once there is a model.
    pub(super) state: State,
    /// Whether the master has set the state's derivatives of inputs since the last step; if not,
    /// they are what that step ended with, and the next one holds its inputs.
    pub(super) has_set_derivatives: bool,
    pub(super) run: Option<Run>,
    /// Stiffness of a model that has gone, for the next one, which may differ in what concerns heat alone.
    kept: Stiffness,
    /// Recorded drops of the unit, which its models find as long as they are held here.
    _records: Vec<Kept>,
    /// Reductions that the unit has stored, each with the name of its body.
    stored: Vec<(String, KeptReduction)>,
    /// Those of a model that has gone, for the next one.
    reductions: Vec<(String, KeptReduction)>,
    /// What is implausible in the scene as packed.
    warnings: Vec<Warning>,
    /// What the master has been warned of.
    said: BTreeSet<String>,
    /// Inputs at the beginning of the last step, where what they become next may tell of it; nothing after a jump back.
    told: Option<Vec<f64>>,
    /// Whether the last step was no shorter than the meshes tell, and no input has been set otherwise since: a single short
    /// one follows no jump then.
    is_settled: bool,
    /// The files of fields, in a folder that is written by nobody else meanwhile.
    pub(super) series: Option<(FieldSeries, FolderLock)>,
    /// Ends the step under way, from another thread.
    pub(super) interrupt: Interrupt,
    /// What the host lets a step do besides going to its end.
    pub(super) control: Rc<StepControl>,
}

/// The times that fmi2SetupExperiment tells [s].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Experiment {
    pub start: f64,
    pub stop: Option<f64>,
}

/// A built model, and what follows from the present state.
pub(super) struct Run {
    pub model: Arc<Model>,
    pub cache: Cache,
    /// Time derivative of the state, once asked for.
    pub tangent: Option<Tangent>,
    /// Whether the inputs have been checked together since they changed.
    pub checked: bool,
}

impl Run {
    pub fn new(model: Arc<Model>) -> Self {
        Self { model, cache: Cache::default(), tangent: None, checked: false }
    }
}

/// Time and inputs at their start, without unknowns.
fn start_state(packed: &Scene) -> State {
    let inputs = initial_inputs(packed);
    State { time: 0.0, inputs, derivatives: Vec::new(), bodies: Vec::new(), peaks: Vec::new() }
}

impl Unit {
    pub fn new(packed: Packed, log: Log) -> Self {
        let Packed { scene, warnings, registry, guid, state, records, reductions } = packed;
        Self {
            log,
            phase: Phase::Instantiated,
            texts: Vec::new(),
            saved: SavedStates::default(),
            registry: Arc::new(registry),
            arrays: OnceCell::new(),
            guid,
            state,
            has_set_derivatives: false,
            kept: Vec::new(),
            _records: records,
            stored: reductions,
            reductions: Vec::new(),
            packed: scene.clone(),
            scene,
            directory: String::new(),
            experiment: Experiment::default(),
            run: None,
            warnings,
            said: BTreeSet::new(),
            told: None,
            is_settled: false,
            series: None,
            interrupt: Interrupt::default(),
            control: Rc::default(),
        }
    }

    /// Refuses a function that the standard does not allow now.
    pub fn check_phase<F: Function>(&self, function: F) -> Answer<()> {
        if function.allowed_in(self.phase) {
            return Ok(());
        }
        let allowed = function.allowed_phases().join(", ");
        if allowed.is_empty() {
            return Err(function.never().into());
        }
        let phase = F::phase_name(self.phase);
        let message = format!("not allowed in state {phase}, only in {allowed}");
        Err(Refusal::error(message))
    }

    pub fn set_experiment(&mut self, tolerance: Option<f64>, experiment: Experiment) -> Answer {
        let Experiment { start, stop } = experiment;
        if !start.is_finite() {
            return Err(Refusal::error(format!("start time {start} is not finite")));
        }
        if let Some(stop) = stop.filter(|stop| !(stop.is_finite() && *stop > start)) {
            let message = format!("stop time {stop:?} s is not after the start time {start:?} s");
            return Err(Refusal::error(message));
        }
        if let Some(tolerance) = tolerance.filter(|t| !(t.is_finite() && *t > 0.0)) {
            return Err(Refusal::error(format!("tolerance {tolerance:?} is not positive")));
        }
        self.experiment = experiment;
        self.state.time = start;
        Ok(Status::Ok)
    }

    /// Builds the model if nobody has asked for it yet; from here on parameters are fixed.
    pub fn finish_initialization(&mut self) -> Answer {
        let registry = Arc::clone(&self.registry);
        let (run, state) = self.run()?;
        // From here on running maxima follow no input at once.
        let noted = run.model.note_peaks(state, &mut run.cache);
        noted.map_err(|error| Refusal::error(explain(&registry, error).message))?;
        self.phase = Phase::StepComplete;
        Ok(self.open_series())
    }

    pub fn terminate(&mut self) -> Answer {
        self.warn_at_end();
        self.series = None;
        self.phase = Phase::Terminated;
        Ok(Status::Ok)
    }

    /// Back to the start values, as after fmi2Instantiate; log settings and saved states stay.
    pub fn reset(&mut self) -> Answer {
        self.drop_run();
        self.forget_answers();
        self.is_settled = false;
        self.series = None;
        self.texts.clear();
        self.scene = self.packed.clone();
        self.directory.clear();
        self.state = start_state(&self.packed);
        self.has_set_derivatives = false;
        self.experiment = Experiment::default();
        self.phase = Phase::Instantiated;
        Ok(Status::Ok)
    }

    /// Time of the last successful step [s].
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Advances from `point` by `step` [s]. The time afterwards is their sum, so that it never
    /// drifts from the master's. Inputs whose derivatives have been set follow them; afterwards they
    /// are what they have become.
    ///
    /// A step that cannot be completed, though nothing was wrong when it began, is discarded; so is one
    /// that another thread cancels. One that may end early then stands where it has come to.
    pub fn step(&mut self, point: f64, step: f64) -> Answer {
        self.check_step(point, step)?;
        let registry = Arc::clone(&self.registry);
        let has_set = self.has_set_derivatives;
        let told = self.told.take();
        let listens = self.listens_to_answers();
        let (interrupt, control) = (self.interrupt.clone(), Rc::clone(&self.control));
        let (run, state) = self.run()?;
        let past = if has_set { None } else { Some(std::mem::take(&mut state.derivatives)) };
        let on_answer = told.and_then(|before| run.model.warning_on_response(state, &before));
        let told = listens.then(|| state.inputs.clone());
        let stepping = interrupt.begin();
        let stepped = check_path(&registry, state, step).and_then(|()| {
            control.advance((&*run.model, &mut run.cache), state, (point, step), &interrupt)
        });
        drop(stepping);
        if let Err(error) = stepped {
            let is_cancelled = error.halt() == Some(&Halt::Interrupted);
            if let Some(past) = past {
                state.derivatives = past;
            }
            let refusal = explain(&registry, error);
            if refusal.status == Status::Discard {
                self.phase = if is_cancelled { Phase::StepCanceled } else { Phase::StepFailed };
            }
            return Err(refusal);
        }
        run.tangent = None;
        run.checked &= !has_set;
        let warnings = run.model.warnings(state);
        self.told = told;
        self.warn_once(warnings);
        self.warn_of_response(on_answer);
        self.warn_of_phases();
        self.warn_of_length(step);
        self.has_set_derivatives = false;
        Ok(self.write_fields())
    }

    /// Drops the derivatives of inputs that the last step ended with, unless they were set since.
    pub(super) fn forget_past_derivatives(&mut self) {
        if !self.has_set_derivatives {
            self.state.derivatives.clear();
        }
        if let Some(run) = &mut self.run {
            run.tangent = None;
        }
    }

    fn check_step(&self, point: f64, step: f64) -> Answer<()> {
        if !(step.is_finite() && step > 0.0) {
            return Err(Refusal::error(format!("step size {step:?} s is not positive and finite")));
        }
        check_step_length(step).map_err(|error| Refusal::error(error.to_string()))?;
        let time = self.time();
        // A step that is far too long may end early: what it asked for says nothing of how far it goes.
        let usual = step.min(self.scene.step);
        let tolerance = STEP_TOLERANCE * usual + TIME_TOLERANCE * time.abs();
        if !point.is_finite() || (point - time).abs() > tolerance {
            let message =
                format!("communication point {point:?} s is not the unit's time {time:?} s");
            return Err(Refusal::error(message));
        }
        let end = point + step;
        if end <= point || end <= time {
            let message = format!("step size {step:?} s is lost in rounding at {point:?} s");
            return Err(Refusal::error(message));
        }
        match self.experiment.stop {
            Some(stop) if end > stop + tolerance => Err(Refusal::error(format!(
                "a step to {end:?} s goes beyond the stop time {stop:?} s"
            ))),
            _ => Ok(()),
        }
    }

    /// The model and the state, built when first needed, with inputs that make sense together.
    pub(super) fn run(&mut self) -> Answer<(&mut Run, &mut State)> {
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
            // What is kept may be the memory that is missing.
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
        // Meshes stay what they are, whatever parameters become.
        self.scene.refinement.clone_from(&model.scene().refinement);
        self.state.bodies = model.initial_state().bodies;
        Ok(Run::new(model))
    }

    /// Solids whose stored reduction is not that of a model.
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

    /// What is computed before the first step, as neither this process nor the unit knows it.
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

    /// Refuses to look at the state, or to copy it, where there is too little address space for that.
    pub(super) fn expect_room(&self) -> Answer<()> {
        let room = |run: &Run| run.model.room(&self.state);
        expect_room(self.run.as_ref().map_or(0, room))
    }

    /// The model of a scene with parameters.
    pub(super) fn model_of(&self, scene: &Scene) -> Answer<Arc<Model>> {
        expect_room(STACK + PRODUCTS + SPARE)?;
        let model = aside(|| {
            scene::check(scene)?;
            Model::shared(scene, scene.solver.threads, available_memory())
        });
        model.map_err(|error| explain(&self.registry, error))
    }

    /// Drops all that followed from other inputs.
    pub(super) fn forget_past_inputs(&mut self) {
        self.is_settled = false;
        self.forget_past_derivatives();
        if let Some(run) = &mut self.run {
            run.cache.expect_inputs();
            run.checked = false;
        }
    }

    /// Takes over a scene with other parameters; a model of the old ones is dropped.
    pub(super) fn set_scene(&mut self, scene: Scene) {
        if scene == self.scene {
            return;
        }
        self.drop_run();
        self.state.bodies.clear();
        self.state.peaks.clear();
        self.scene = scene;
        self.scene.forget_estimates();
    }

    /// Drops the model and what follows from the state, but for its stiffness and its reductions.
    fn drop_run(&mut self) {
        if let Some(run) = self.run.take() {
            self.kept = run.model.stiffness();
            self.reductions = run.model.reductions();
        }
    }

    /// Opens the files of fields if they are wanted, and writes the present ones.
    pub(super) fn open_series(&mut self) -> Status {
        let Some(run) = self.run.as_ref().filter(|_| !self.directory.is_empty()) else {
            return Status::Ok;
        };
        // Where the host is now: it may go elsewhere.
        let named = Path::new(&self.directory);
        let directory = std::path::absolute(named).unwrap_or_else(|_| named.to_owned());
        let open = || {
            let lock = FolderLock::take(&directory)?;
            Ok((FieldSeries::create(&directory, &run.model)?, lock))
        };
        match aside(open) {
            Ok(series) => {
                self.series = Some(series);
                self.write_fields()
            }
            Err(error) => self.warn_of_output(&error),
        }
    }

    fn write_fields(&mut self) -> Status {
        let (Some((series, _)), Some(run)) = (&mut self.series, &mut self.run) else {
            return Status::Ok;
        };
        let state = &self.state;
        match aside(|| series.write(&run.model, state, &mut run.cache)) {
            Ok(()) => Status::Ok,
            Err(error) => self.warn_of_output(&error),
        }
    }
}

/// Refuses what takes more address space than there is.
pub(super) fn expect_room(bytes: usize) -> Answer<()> {
    address_space::expect(bytes).map_err(|error| Refusal::error(error.to_string()))
}

/// An error of the model in words that name the variable at fault.
pub(super) fn explain(registry: &Registry, error: ModelError) -> Refusal {
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
            | BodyError::Uneven { .. }
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

#[cfg(test)]
impl Unit {
    /// A unit of the scene that the tests of the C ABI use, without logger.
    pub fn for_tests() -> Self {
        let text = include_str!("../../tests/fmi/scene.toml");
        let scene = crate::advice::parse_with_warnings(text, "scene.toml");
        let scene = scene.unwrap_or_else(|error| panic!("{error}"));
        Self::new(Packed::of(scene, text), Log::new(Box::new(|_, _, _| {}), true))
    }
}

//! What an instance is and does, in safe Rust: its life from instantiation to the last step.

use std::ffi::CString;
use std::path::Path;
use std::sync::Arc;

use super::legality::{Function, Phase};
use super::log::Log;
use super::pin;
use super::refused::Reason;
use super::types::{Answer, Refusal, Status};
use super::{guid, uri};
use crate::model::{Cache, Model, ModelError, State, initial_inputs};
use crate::output::{FieldSeries, OutputError};
use crate::scene::{self, Scene};
use crate::variables::{Registry, Slot};

/// A time is taken for another one if they differ by less than this part of the step …
const STEP_TOLERANCE: f64 = 1e-9;
/// … plus this part of the times themselves, which masters sum up with rounding errors.
const TIME_TOLERANCE: f64 = 1e-13;

/// One instance of a unit.
pub struct Unit {
    pub log: Log,
    pub phase: Phase,
    /// What the last fmi2GetString gave pointers to.
    pub texts: Vec<CString>,
    pub(super) registry: Arc<Registry>,
    /// The scene as packed.
    packed: Scene,
    /// The scene with the parameters that were set.
    pub(super) scene: Scene,
    /// Folder for field files; nothing is written if empty.
    pub(super) directory: String,
    /// Input values while there is no model.
    inputs: Vec<f64>,
    experiment: Experiment,
    run: Option<Run>,
    series: Option<FieldSeries>,
}

/// The times that fmi2SetupExperiment tells [s].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Experiment {
    pub start: f64,
    pub stop: Option<f64>,
}

/// A built model with its state.
pub(super) struct Run {
    pub model: Arc<Model>,
    pub state: State,
    pub cache: Cache,
    /// Whether the inputs have been checked together since they changed.
    checked: bool,
}

/// What a unit's resources hold, and what follows from it.
pub struct Packed {
    scene: Scene,
    registry: Registry,
    inputs: Vec<f64>,
}

impl Packed {
    fn of(scene: Scene) -> Self {
        Self { registry: Registry::of(&scene), inputs: initial_inputs(&scene), scene }
    }
}

/// Reads the scene of a unit and compares the GUID. Nothing heavy: parameters may still change.
pub fn read(resources: &str, guid: &str) -> Result<Packed, String> {
    let path = uri::to_path(resources)?.join("scene.toml");
    let file = path.display().to_string();
    let text = std::fs::read_to_string(&path)
        .map_err(|error| format!("cannot read the unit's scene {file}: {error}"))?;
    let scene = scene::parse(&text, &file).map_err(|error| error.to_string())?;
    let packed = Packed::of(scene);
    let own = guid::guid(&text, &packed.registry);
    if guid != own {
        return Err(format!(
            "the master's GUID {guid} is not {own}, which belongs to {file} and impinge {}: \
             modelDescription.xml, scene and library are not of one unit",
            env!("CARGO_PKG_VERSION")
        ));
    }
    Ok(packed)
}

impl Unit {
    pub fn new(packed: Packed, log: Log) -> Self {
        let Packed { scene, registry, inputs } = packed;
        Self {
            log,
            phase: Phase::Instantiated,
            texts: Vec::new(),
            registry: Arc::new(registry),
            inputs,
            packed: scene.clone(),
            scene,
            directory: String::new(),
            experiment: Experiment::default(),
            run: None,
            series: None,
        }
    }

    /// Refuses a function that the standard does not allow now.
    pub fn check_phase(&self, function: Function) -> Answer<()> {
        if function.allowed_in(self.phase) {
            return Ok(());
        }
        let allowed = function.allowed_phases().join(", ");
        if allowed.is_empty() {
            return Err(Reason::ModelExchange.into());
        }
        let message = format!("not allowed in state {}, only in {allowed}", self.phase.name());
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
        Ok(Status::Ok)
    }

    /// Builds the model if nobody has asked for it yet; from here on parameters are fixed.
    pub fn finish_initialization(&mut self) -> Answer {
        self.run()?;
        self.phase = Phase::StepComplete;
        Ok(self.open_series())
    }

    pub fn terminate(&mut self) -> Answer {
        self.series = None;
        self.phase = Phase::Terminated;
        Ok(Status::Ok)
    }

    /// Back to the start values, as after fmi2Instantiate; log settings stay.
    pub fn reset(&mut self) -> Answer {
        self.run = None;
        self.series = None;
        self.texts.clear();
        self.scene = self.packed.clone();
        self.directory.clear();
        self.inputs = initial_inputs(&self.packed);
        self.experiment = Experiment::default();
        self.phase = Phase::Instantiated;
        Ok(Status::Ok)
    }

    /// Time of the last successful step [s].
    pub fn time(&self) -> f64 {
        self.run.as_ref().map_or(self.experiment.start, |run| run.state.time)
    }

    /// Advances from `point` by `step` [s]. The time afterwards is their sum, so that it never
    /// drifts from the master's.
    pub fn step(&mut self, point: f64, step: f64) -> Answer {
        self.check_step(point, step)?;
        let registry = Arc::clone(&self.registry);
        let run = self.run()?;
        run.model
            .step(&mut run.state, &mut run.cache, step)
            .map_err(|error| explain(&registry, error))?;
        run.state.time = point + step;
        Ok(self.write_fields())
    }

    fn check_step(&self, point: f64, step: f64) -> Answer<()> {
        if !(step.is_finite() && step > 0.0) {
            return Err(Refusal::error(format!("step size {step:?} s is not positive and finite")));
        }
        let time = self.time();
        let tolerance = STEP_TOLERANCE * step + TIME_TOLERANCE * time.abs();
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

    /// The model with its state, built when first needed, with inputs that make sense together.
    pub(super) fn run(&mut self) -> Answer<&mut Run> {
        let run = match self.run.take() {
            Some(run) => run,
            None => self.build()?,
        };
        let run = self.run.insert(run);
        if !run.checked {
            let checked = run.model.check_inputs(&run.state.inputs);
            checked.map_err(|error| explain(&self.registry, error))?;
            run.checked = true;
        }
        Ok(run)
    }

    fn build(&self) -> Answer<Run> {
        scene::check(&self.scene).map_err(|error| Refusal::error(error.to_string()))?;
        let model = Model::shared(&self.scene, self.scene.solver.threads)
            .map_err(|error| explain(&self.registry, error))?;
        if model.threads() > 1 {
            pin::keep_loaded();
        }
        for note in model.notes() {
            self.log.send(Status::Ok, &note);
        }
        let mut state = model.initial_state();
        state.time = self.experiment.start;
        state.inputs.clone_from(&self.inputs);
        Ok(Run { model, state, cache: Cache::default(), checked: false })
    }

    pub(super) fn inputs(&self) -> &[f64] {
        self.run.as_ref().map_or(&self.inputs, |run| &run.state.inputs)
    }

    pub(super) fn set_input(&mut self, index: usize, value: f64) {
        let Some(run) = &mut self.run else {
            self.inputs[index] = value;
            return;
        };
        // Bits, so that a zero of the other sign is read back as it was set.
        if run.state.inputs[index].to_bits() != value.to_bits() {
            run.state.inputs[index] = value;
            run.cache.clear();
            run.checked = false;
        }
    }

    /// Takes over a scene with other parameters; a model of the old ones is dropped.
    pub(super) fn set_scene(&mut self, scene: Scene) {
        if scene == self.scene {
            return;
        }
        if let Some(run) = self.run.take() {
            self.inputs = run.state.inputs;
        }
        self.scene = scene;
    }

    fn open_series(&mut self) -> Status {
        let Some(run) = self.run.as_ref().filter(|_| !self.directory.is_empty()) else {
            return Status::Ok;
        };
        match FieldSeries::create(Path::new(&self.directory), &run.model) {
            Ok(series) => {
                self.series = Some(series);
                self.write_fields()
            }
            Err(error) => self.warn_of_output(&error),
        }
    }

    fn write_fields(&mut self) -> Status {
        let (Some(series), Some(run)) = (&mut self.series, &mut self.run) else {
            return Status::Ok;
        };
        match series.write(&run.model, &run.state, &mut run.cache) {
            Ok(()) => Status::Ok,
            Err(error) => self.warn_of_output(&error),
        }
    }

    /// The computation is fine, so files that cannot be written are no error.
    fn warn_of_output(&self, error: &OutputError) -> Status {
        let message = format!("output.directory {:?}: {error}", self.directory);
        self.log.send(Status::Warning, &message);
        Status::Warning
    }
}

/// An error of the model in words that name the variable at fault.
pub(super) fn explain(registry: &Registry, error: ModelError) -> Refusal {
    let ModelError::Input { index, message } = error else {
        return Refusal::error(error.to_string());
    };
    let at_fault = registry.variables.iter().find(|v| v.slot == Slot::Input(index));
    Refusal::error(match at_fault {
        Some(variable) => format!("{}: {message}", variable.name),
        None => message,
    })
}

#[cfg(test)]
impl Unit {
    /// A unit of the scene that the tests of the C ABI use, without logger.
    pub fn for_tests() -> Self {
        let callbacks = super::types::Callbacks {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment: std::ptr::null_mut(),
        };
        let text = include_str!("../../tests/fmi/scene.toml");
        let scene = scene::parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        Self::new(Packed::of(scene), Log::new(c"unit", &callbacks, true))
    }
}

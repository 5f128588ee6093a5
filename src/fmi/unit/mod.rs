//! An instance of either version in safe Rust: its life cycle from instantiation to termination.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ffi::CString;
use std::rc::Rc;
use std::sync::Arc;

mod adjoint;
mod arrays;
mod built;
mod fields;
mod kind;
mod packed;
mod rates;
mod saved;
mod state_bytes;
mod step;
mod step_control;
mod values;
mod warnings;

pub use arrays::array_variable;
pub use built::expect_room;
pub use packed::{Packed, read};
pub use rates::highest_output_derivative;
pub use step_control::{Ask, StepControl};

use super::gate::answer::{Answer, Refusal, Status};
use super::gate::log::Log;
use super::table::{Function, Phase, Reason, Rule};

use crate::model::{Kept, KeptReduction, State, Stiffness, initial_inputs};
use crate::runtime::allowance::Interrupt;
use crate::scene::Scene;
use crate::variables::{ArrayRegistry, Registry};
use crate::warning::Warning;
use built::{Run, explain};
use fields::Series;
use saved::SavedStates;

/// One instance of a unit.
pub struct Unit {
    pub log: Log,
    pub phase: Phase,
    /// Targets of the pointers returned by the last fmi2GetString or fmi3GetString.
    pub texts: Vec<CString>,
    /// The states saved by the master and not freed.
    pub(super) saved: SavedStates,
    pub(super) registry: Arc<Registry>,
    /// The variables as numbered in FMI 3.0, listed lazily.
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
    /// True if the master has set the state's derivatives of inputs since the last step. If not, they are those at the
    /// end of that step, and inputs are constant in the next one.
    pub(super) has_set_derivatives: bool,
    pub(super) run: Option<Run>,
    /// Stiffness of a dropped model, for the next one, which may differ only in thermal data.
    kept: Stiffness,
    /// Recorded drops of the unit, available to its models while held here.
    _records: Vec<Kept>,
    /// Reductions stored in the unit, each with the name of its body.
    stored: Vec<(String, KeptReduction)>,
    /// Reductions of a dropped model, for the next one.
    reductions: Vec<(String, KeptReduction)>,
    /// Warnings about the scene as packed.
    warnings: Vec<Warning>,
    /// Subjects of which the master was warned.
    said: BTreeSet<String>,
    /// Inputs at the beginning of the last step, if the next inputs may respond to that step; `None` after a restored
    /// state.
    told: Option<Vec<f64>>,
    /// True if the last step was no shorter than the meshes resolve and no input has been set differently since. A
    /// single short step then follows no jump.
    is_settled: bool,
    /// The field files of the run, also after its end, from which a restored state may go on.
    pub(super) series: Option<Series>,
    /// Ends the step under way from another thread.
    pub(super) interrupt: Interrupt,
    /// True if the last step has ended at an event that is to be reported.
    pub is_at_event: bool,
    /// Host settings that let a step end early, or report its progress or events.
    pub(super) control: Rc<StepControl>,
}

/// The times set by fmi2SetupExperiment [s].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Experiment {
    pub start: f64,
    pub stop: Option<f64>,
}

/// Time and inputs at their start, without unknowns.
fn start_state(packed: &Scene) -> State {
    let inputs = initial_inputs(packed);
    State { time: 0.0, inputs, derivatives: Vec::new(), bodies: Vec::new(), peaks: Vec::new() }
}

impl Unit {
    /// An instance at its start values.
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
            is_at_event: false,
            control: Rc::default(),
        }
    }

    /// Refuses a function that the standard does not allow in this phase.
    pub fn check_phase<F: Function>(&self, function: F) -> Answer<()> {
        if let Rule::Never(reason) = function.rule() {
            return Err(reason.into());
        }
        if function.allowed_in(self.phase) {
            return Ok(());
        }
        let allowed = function.allowed_phases().join(", ");
        let phase = F::phase_name(self.phase);
        let message = format!("not allowed in state {phase}, only in {allowed}");
        Err(Refusal::error(message))
    }

    /// Sets start and stop time. A tolerance is checked but not used.
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

    /// Begins the initialization, in which inputs and parameters are set together.
    pub fn enter_initialization(&mut self) -> Answer {
        self.phase = Phase::InitializationMode;
        Ok(Status::Ok)
    }

    /// Builds the model if necessary; from here on parameters are fixed.
    pub fn finish_initialization(&mut self) -> Answer {
        let registry = Arc::clone(&self.registry);
        let (run, state) = self.run()?;
        // From here on running maxima follow no input without delay.
        let noted = run.model.note_peaks(state, &mut run.cache);
        noted.map_err(|error| Refusal::error(explain(&registry, error).message))?;
        self.phase =
            if self.control.reports_events { Phase::EventMode } else { Phase::StepComplete };
        Ok(self.open_series())
    }

    /// Enters Event Mode, in which inputs are set and nothing advances.
    pub fn enter_event_mode(&mut self) -> Answer {
        let reason = match (self.scene.has_events(), self.control.reports_events) {
            (true, true) => {
                self.phase = Phase::EventMode;
                return Ok(Status::Ok);
            }
            (true, false) => Reason::NoEventMode,
            (false, _) => Reason::NoEvents,
        };
        Err(reason.into())
    }

    /// Returns to steps.
    pub fn leave_event_mode(&mut self) -> Answer {
        self.phase = Phase::StepComplete;
        Ok(Status::Ok)
    }

    /// Ends the run: releases the folder of its files, and sends warnings that only the end of a run allows.
    pub fn terminate(&mut self) -> Answer {
        self.warn_at_end();
        if let Some(series) = &mut self.series {
            series.release();
        }
        self.phase = Phase::Terminated;
        Ok(Status::Ok)
    }

    /// Restores the start values, as after fmi2Instantiate; log settings and saved states are kept.
    pub fn reset(&mut self) -> Answer {
        self.drop_run();
        self.forget_answers();
        self.said.clear();
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
}

#[cfg(test)]
impl Unit {
    /// A unit of the scene that the tests of the C ABI use, without logger.
    pub fn for_tests() -> Self {
        Self::of_scene_for_tests(include_str!("../../../tests/fmi/scene.toml"))
    }

    /// A unit of a scene, without logger.
    pub fn of_scene_for_tests(text: &str) -> Self {
        let scene = crate::advice::parse_with_warnings(text, "scene.toml");
        let scene = scene.unwrap_or_else(|error| panic!("{error}"));
        Self::new(Packed::of(scene, text), Log::new(Box::new(|_, _, _| {}), true))
    }
}

//! Warnings to the master and their occasions.

use std::sync::Arc;

use super::Unit;
use crate::advice;
use crate::fmi::gate::answer::Status;
use crate::output::OutputError;
use crate::runtime::thread::aside;
use crate::scene::Wall;
use crate::warning::Warning;

/// Subject of warnings about steps that are too short, of which one is sufficient.
const SHORT_STEPS: &str = "short steps";
/// Subject of warnings about walls that are held but respond.
const HELD_WALL: &str = "held wall";

impl Unit {
    /// Sends warnings that are only known at the end of a run, if memory allows.
    pub(super) fn warn_at_end(&mut self) {
        let Some(model) = self.run.as_ref().map(|run| Arc::clone(&run.model)) else { return };
        if self.expect_room().is_err() {
            return;
        }
        let state = &self.state;
        let warnings = aside(|| model.closing_warnings(state));
        self.warn_once(warnings);
    }

    /// Returns true if inputs may respond to a step during which they were constant, and no warning was sent yet.
    pub(super) fn listens_to_answers(&self) -> bool {
        let is_held =
            |wall: &Wall| wall.effusivity.is_none() && self.scene.drop_above(wall).is_some();
        self.scene.wall.iter().any(is_held) && !self.said.contains(HELD_WALL)
    }

    /// Discards the inputs of the last step, because the next ones do not respond to it.
    pub(in crate::fmi) fn forget_answers(&mut self) {
        self.told = None;
    }

    /// Warns once of implausible values in the scene with its parameters, which are now fixed.
    pub(super) fn warn_of_scene(&mut self) {
        let changed = self.scene != self.packed;
        let warnings = match changed {
            true => aside(|| advice::warnings(&self.scene)),
            false => self.warnings.clone(),
        };
        self.warn_once(warnings);
    }

    /// Warns once of each fluid beyond its freezing or boiling point, if memory allows.
    pub(super) fn warn_of_phases(&mut self) {
        let Some(model) = self.run.as_ref().map(|run| Arc::clone(&run.model)) else { return };
        if !model.watches_phases() || self.expect_room().is_err() {
            return;
        }
        let (state, said) = (&self.state, &self.said);
        let warnings = aside(|| model.phase_warnings(state, |subject| said.contains(subject)));
        self.warn_once(warnings);
    }

    /// Warns of an input that was set in response to a step and contradicts the step's assumption.
    pub(super) fn warn_of_response(&mut self, warning: Option<Warning>) {
        self.warn_once(warning.map(|warning| warning.of_subject(HELD_WALL)));
    }

    /// Warns of a step that is too short for a mesh [s], if it may follow a jump.
    pub(super) fn warn_of_length(&mut self, step: f64) {
        if self.said.contains(SHORT_STEPS) {
            return;
        }
        let warning = self.run.as_ref().and_then(|run| run.model.warning_on_step(step));
        let was_settled = std::mem::replace(&mut self.is_settled, warning.is_none());
        let warning = warning.filter(|_| !was_settled);
        self.warn_once(warning.map(|warning| warning.of_subject(SHORT_STEPS)));
    }

    /// Sends warnings whose subjects were not warned of before.
    pub(in crate::fmi) fn warn_once(&mut self, warnings: impl IntoIterator<Item = Warning>) {
        for warning in warnings {
            if self.said.insert(warning.subject().to_owned()) {
                self.log.send(Status::Warning, &warning.to_string());
            }
        }
    }

    /// Warns once of each file that cannot be written; the computation is unaffected, so this is no error.
    pub(in crate::fmi) fn warn_of_output(&mut self, error: &OutputError) -> Status {
        let message = format!("output.directory {:?}: {error}", self.directory);
        if self.said.insert(message.clone()) {
            self.log.send(Status::Warning, &message);
        }
        Status::Warning
    }
}

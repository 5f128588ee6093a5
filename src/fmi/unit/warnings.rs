//! What a master is warned of, and when.

use std::sync::Arc;

use super::Unit;
use crate::advice;
use crate::fmi::types::Status;
use crate::output::OutputError;
use crate::runtime::thread::aside;
use crate::warning::Warning;

/// The subject of warnings of steps that are too short, of which one is enough.
const SHORT_STEPS: &str = "short steps";
/// The same of walls that are held and respond all the same.
const HELD_WALL: &str = "held wall";

impl Unit {
    /// Warns of what is known of drops and of what melts only as a run ends, where there is room to look.
    pub(super) fn warn_at_end(&mut self) {
        let Some(model) = self.run.as_ref().map(|run| Arc::clone(&run.model)) else { return };
        if !(self.scene.has_drops() || self.scene.melts()) || self.expect_room().is_err() {
            return;
        }
        let state = &self.state;
        let warnings = aside(|| model.closing_warnings(state));
        self.warn_once(warnings);
    }

    /// Whether inputs may be answers to a step that took them as held, and nothing has been said of that yet.
    pub(super) fn listens_to_answers(&self) -> bool {
        let is_held = self.scene.wall.iter().any(|wall| wall.effusivity.is_none());
        is_held && !self.said.contains(HELD_WALL)
    }

    /// Forgets what the last step began with, as what comes is no answer to it.
    pub(in super::super) fn forget_answers(&mut self) {
        self.told = None;
    }

    /// Warns once of what is implausible in the scene with its parameters, now that they are fixed.
    pub(super) fn warn_of_scene(&mut self) {
        let changed = self.scene != self.packed;
        let warnings = match changed {
            true => aside(|| advice::warnings(&self.scene)),
            false => self.warnings.clone(),
        };
        self.warn_once(warnings);
    }

    /// Warns once of each fluid that is beyond a point at which it freezes or boils, where there is room to look.
    pub(super) fn warn_of_phases(&mut self) {
        let Some(model) = self.run.as_ref().map(|run| Arc::clone(&run.model)) else { return };
        if !model.watches_phases() || self.expect_room().is_err() {
            return;
        }
        let (state, said) = (&self.state, &self.said);
        let warnings = aside(|| model.phase_warnings(state, |subject| said.contains(subject)));
        self.warn_once(warnings);
    }

    /// Warns of an input that was set in response to a step and contradicts how that was computed.
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
    pub(in super::super) fn warn_once(&mut self, warnings: impl IntoIterator<Item = Warning>) {
        for warning in warnings {
            if self.said.insert(warning.subject().to_owned()) {
                self.log.send(Status::Warning, &warning.to_string());
            }
        }
    }

    /// The computation is fine, so files that cannot be written are no error. Each is told once.
    pub(in super::super) fn warn_of_output(&mut self, error: &OutputError) -> Status {
        let message = format!("output.directory {:?}: {error}", self.directory);
        if self.said.insert(message.clone()) {
            self.log.send(Status::Warning, &message);
        }
        Status::Warning
    }
}

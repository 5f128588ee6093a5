//! What a master is warned of, and when.

use std::sync::Arc;

use super::Unit;
use crate::advice;
use crate::fmi::types::Status;
use crate::output::OutputError;
use crate::runtime::thread::aside;

/// The subject of warnings of steps that are too short.
const SHORT_STEPS: &str = "short steps";
/// The subject of warnings of walls that are held and answer all the same.
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
        for warning in warnings {
            if self.said.insert(warning.subject()) {
                self.log.send(Status::Warning, &warning.to_string());
            }
        }
    }

    /// Warns once of each fluid that is beyond a point at which it freezes or boils, where there is room to look.
    pub(super) fn warn_of_phases(&mut self) {
        let Some(model) = self.run.as_ref().map(|run| Arc::clone(&run.model)) else { return };
        if !model.watches_phases() || self.expect_room().is_err() {
            return;
        }
        let (state, said) = (&self.state, &self.said);
        let warnings = aside(|| model.phase_warnings(state, |subject| said.contains(subject)));
        for warning in warnings {
            self.warn_once_of(&warning.subject, &warning.message);
        }
    }

    /// Warns of an input that was told, in answer to a step, what does not go with how that was computed.
    pub(super) fn warn_of_answer(&mut self, message: Option<String>) {
        if let Some(message) = message {
            self.warn_once_of(HELD_WALL, &message);
        }
    }

    /// Warns of a step that is too short for a mesh [s], if it may follow a jump.
    pub(super) fn warn_of_length(&mut self, step: f64) {
        if self.said.contains(SHORT_STEPS) {
            return;
        }
        let message = self.run.as_ref().and_then(|run| run.model.warning_on_step(step));
        let was_settled = std::mem::replace(&mut self.is_settled, message.is_none());
        if let Some(message) = message.filter(|_| !was_settled) {
            self.warn_once_of(SHORT_STEPS, &message);
        }
    }

    /// Warns of a subject unless there was a warning of it before.
    pub(in super::super) fn warn_once_of(&mut self, subject: &str, message: &str) {
        if self.said.insert(subject.to_owned()) {
            self.log.send(Status::Warning, message);
        }
    }

    pub(super) fn warn_once(&mut self, messages: Vec<String>) {
        for message in messages {
            if !self.said.contains(&message) {
                self.log.send(Status::Warning, &message);
                self.said.insert(message);
            }
        }
    }

    /// The computation is fine, so files that cannot be written are no error. Each is told once.
    pub(in super::super) fn warn_of_output(&mut self, error: &OutputError) -> Status {
        let message = format!("output.directory {:?}: {error}", self.directory);
        self.warn_once(vec![message]);
        Status::Warning
    }
}

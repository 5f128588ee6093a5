//! Events of a model's bodies.

use super::{Model, State};

impl Model {
    /// Returns true if a body may have events.
    pub fn has_events(&self) -> bool {
        self.bodies.iter().any(|body| body.has_events())
    }

    /// Returns true if an event lies between two states of a run.
    pub fn event_between(&self, before: &State, after: &State) -> bool {
        let states = before.bodies.iter().zip(&after.bodies);
        self.bodies
            .iter()
            .zip(states)
            .any(|(body, (before, after))| body.event_between(before, after))
    }
}

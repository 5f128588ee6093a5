//! Fluids that would freeze or boil.

use super::{Model, State};

/// A warning of a fluid beyond a point of its phases, which is worth saying once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhaseWarning {
    /// The body and the change of phase.
    pub subject: String,
    pub message: String,
}

impl Model {
    /// Warns of fluids in a state beyond the points at which they freeze or boil, but for subjects that have been said.
    pub fn phase_warnings(
        &self,
        state: &State,
        is_said: impl Fn(&str) -> bool,
    ) -> Vec<PhaseWarning> {
        let mut found = Vec::new();
        for (body, unknowns) in self.bodies.iter().zip(&state.bodies) {
            let Some(watch) = body.watch() else { continue };
            let changes = watch.changes().map(|change| (change, watch.subject(change)));
            let wanted: Vec<_> = changes.filter(|(_, subject)| !is_said(subject)).collect();
            if wanted.is_empty() {
                continue;
            }
            let Some(places) = body.warm_places(unknowns) else { continue };
            for (change, subject) in wanted {
                let message = watch.warning(change, places, state.time);
                found.extend(message.map(|message| PhaseWarning { subject, message }));
            }
        }
        found
    }

    /// Returns true if a fluid has points to be watched.
    pub fn watches_phases(&self) -> bool {
        self.bodies.iter().any(|body| body.watch().is_some_and(|watch| watch.changes().count() > 0))
    }
}

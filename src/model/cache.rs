//! Lazily computed values of a state.

use super::schedule::Exchange;
use super::{Model, State};
use crate::body::Memo;

/// Lazily computed values of one state. It must be cleared when the state changes. Changed inputs are detected, and
/// values that do not follow them without delay are kept.
#[derive(Debug, Default)]
pub struct Cache {
    inputs: Vec<f64>,
    /// Memo of each body; memos of bodies that receive from others depend on the state, too.
    memos: Vec<Memo>,
}

impl Cache {
    /// Discards everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Marks the inputs as changed. Values that do not follow them without delay are kept.
    pub fn expect_inputs(&mut self) {
        self.inputs.clear();
    }

    /// Discards all that depends on the unknowns.
    pub(super) fn forget_states(&mut self, model: &Model) {
        if !model.links.is_empty() {
            self.clear();
        }
        for (body, memo) in model.bodies.iter().zip(&mut self.memos) {
            body.forget_state(memo);
        }
    }

    /// Updates the loads to the inputs and to the last transfers between bodies.
    pub(super) fn update(&mut self, model: &Model, state: &State) {
        if self.inputs == state.inputs && self.memos.len() == model.bodies.len() {
            return;
        }
        self.inputs = state.inputs.to_vec();
        let given = model.through_links(state);
        let mut old = std::mem::take(&mut self.memos).into_iter();
        for (place, body) in model.bodies.iter().enumerate() {
            let mut memo = body.memo(&self.inputs, &Exchange::with(&given, place));
            if let Some(old) = old.next() {
                body.carry_over(old, &mut memo);
            }
            self.memos.push(memo);
        }
    }

    /// Creates a cache of memos that follow from no inputs, such as those of a change.
    pub(super) fn of_memos(memos: Vec<Memo>) -> Self {
        Self { inputs: Vec::new(), memos }
    }

    pub(super) fn memo(&mut self, place: usize) -> &mut Memo {
        &mut self.memos[place]
    }

    /// `None` before the first update.
    pub(super) fn known(&self, place: usize) -> Option<&Memo> {
        self.memos.get(place)
    }
}

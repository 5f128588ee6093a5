use super::schedule::Exchange;
use super::{Model, State};
use crate::body::Memo;

/// Values derived from one state, computed when first asked for. Clear it when the state changes;
/// changed inputs are noticed, and what does not follow them at once is kept.
#[derive(Debug, Default)]
pub struct Cache {
    inputs: Vec<f64>,
    /// Of each body; those of bodies that receive from others follow from the state, too.
    memos: Vec<Memo>,
}

impl Cache {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Expects other inputs. What does not follow them at once is kept.
    pub fn expect_inputs(&mut self) {
        self.inputs.clear();
    }

    /// Forgets all that depends on the unknowns.
    pub(super) fn forget_states(&mut self, model: &Model) {
        if !model.links.is_empty() {
            self.clear();
        }
        for (body, memo) in model.bodies.iter().zip(&mut self.memos) {
            body.forget_state(memo);
        }
    }

    /// Brings what acts up to date with the inputs and with what bodies gave last.
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

    /// What the bodies remember where that follows from no inputs: of a change, say.
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

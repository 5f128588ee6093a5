//! Probability of failure of a solid of brittle material.
//!
//! A flaw breaks at the largest stress that it has met, so the equivalent stress of every node keeps its running
//! maximum, as part of the body's state. It is noted at communication points, like other running maxima.

use super::SolidBody;
use super::memo::SolidMemo;
use super::reader::SolidReader;
use crate::body::BodyError;
use crate::state::{Field, Layout, Per};

/// Value of a node before anything is noted [Pa].
const NOTHING: f64 = f64::MIN;

/// Risk B of a body and the place of its largest failure density [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Risk {
    pub value: f64,
    pub at: [f64; 3],
}

impl Risk {
    /// `P = 1 − e^{−B}`
    pub fn probability(&self) -> f64 {
        -(-self.value).exp_m1()
    }
}

impl SolidBody {
    /// Fields of the running maxima.
    pub(super) fn layout_of_flaws(&self) -> Layout {
        let field = Field {
            name: "equivalent_stress",
            words: "largest equivalent stress of flaws so far [Pa]",
            per: Per::Node,
            width: 1,
        };
        match self.solid.risk_points() {
            0 => Layout::default(),
            count => Layout::default().with(field, count),
        }
    }

    /// Running maxima before anything is noted.
    pub(super) fn nothing_noted(&self) -> Vec<f64> {
        vec![NOTHING; self.solid.risk_points()]
    }

    /// Running maxima of a state; `None` before anything is noted.
    fn noted<'s>(&self, state: &'s [f64]) -> Option<&'s [f64]> {
        let noted = &state[state.len() - self.solid.risk_points()..];
        noted.first().is_some_and(|&first| first != NOTHING).then_some(noted)
    }

    /// Computes the present equivalent stress, which [`Self::note_flaws`] needs.
    pub(super) fn observe_flaws(
        &self,
        state: &[f64],
        memo: &mut SolidMemo,
    ) -> Result<(), BodyError> {
        let Some(flaws) = self.solid.flaws() else { return Ok(()) };
        let present = memo.equivalent_stress(self, flaws, state)?;
        let wrong = present.iter().copied().find(|value| !value.is_finite());
        wrong.map_or(Ok(()), |value| BodyError::unless_finite(value).map(|_| ()))
    }

    /// Updates the running maxima to the observed values.
    pub(super) fn note_flaws(&self, state: &mut [f64], memo: &mut SolidMemo) {
        let Some(flaws) = self.solid.flaws() else { return };
        let first = state.len() - self.solid.risk_points();
        self.solid.note_largest(flaws, &mut state[first..], memo.observed(), NOTHING);
        memo.forget_risk();
    }

    /// Refuses running maxima that no run produces.
    pub(super) fn check_flaws(&self, state: &[f64]) -> Result<(), String> {
        let noted = &state[state.len() - self.solid.risk_points()..];
        let nothing = noted.iter().filter(|&&value| value == NOTHING).count();
        let is_whole = nothing == 0 || nothing == noted.len();
        match is_whole && noted.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err(format!("equivalent stresses of {} that no run leads to", self.name)),
        }
    }
}

impl SolidReader<'_> {
    /// The largest risk so far: that of the running maxima, or the present one before any is noted.
    pub fn risk_so_far(&mut self) -> Result<Risk, BodyError> {
        let body = self.body;
        if let Some(known) = self.memo.risk_so_far() {
            return Ok(known);
        }
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        // While stress grows, the present one is the largest so far.
        let risk = match body.noted(self.state).filter(|noted| *noted != self.memo.observed()) {
            Some(noted) => {
                let value = body.solid.risk(flaws, noted);
                Risk { value, at: body.solid.riskiest(flaws, noted) }
            }
            None => {
                let value = self.memo.present_risk(body, flaws, self.state)?;
                Risk { value, at: body.solid.riskiest(flaws, self.memo.observed()) }
            }
        };
        self.memo.keep_risk_so_far(risk);
        Ok(risk)
    }

    /// The risk under the present stress.
    pub fn present_risk(&mut self) -> Result<f64, BodyError> {
        let body = self.body;
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        self.memo.present_risk(body, flaws, self.state)
    }
}

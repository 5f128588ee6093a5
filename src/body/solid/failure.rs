//! Probability of failure of a solid of brittle material.
//!
//! A flaw breaks at the largest stress that it has met, so the equivalent stress of every node keeps its running
//! maximum, as part of the body's state. It is noted at communication points, like other running maxima. Flaws that
//! grow slowly break at a stress that falls with time, which counts like a stress that rises.

use std::borrow::Cow;

use super::SolidBody;
use super::memo::SolidMemo;
use super::reader::SolidReader;
use crate::body::BodyError;
use crate::limits::LARGEST;
use crate::method::fem::{Flaws, FlawsIn};
use crate::state::{Field, Layout, Per};

/// Value of a node before anything is noted [Pa].
const NOTHING: f64 = f64::MIN;
/// Share of a risk by which rounding may change it.
const ROUNDING: f64 = 1e-9;

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

/// Running maxima of a state: the risk, and the equivalent stress of the nodes [Pa].
struct Noted<'s> {
    risk: f64,
    stress: &'s [f64],
}

/// Growth of the flaws of all nodes: `∫ (s/σ₀)^n dt` [s], and the equivalent stress when it was last noted [Pa].
struct Growth<'s> {
    grown: &'s mut [f64],
    last: &'s mut [f64],
}

impl SolidBody {
    /// Fields of the running maxima.
    pub(super) fn layout_of_flaws(&self) -> Layout {
        let field = |name, words, per| Field { name, words, per, width: 1 };
        let Some(flaws) = self.solid.flaws() else { return Layout::default() };
        let count = self.solid.risk_points();
        let risk = field("failure_risk", "largest risk of failure so far [1]", Per::Body);
        let stress =
            field("equivalent_stress", "largest equivalent stress of flaws so far [Pa]", Per::Node);
        let layout = Layout::default().with(risk, 1).with(stress, count);
        if !flaws.grow() {
            return layout;
        }
        let grown = field("grown", "integral of its power over time [s]", Per::Node);
        let last = field("present_stress", "equivalent stress when last noted [Pa]", Per::Node);
        layout.with(grown, count).with(last, count)
    }

    /// Running maxima before anything is noted.
    pub(super) fn nothing_noted(&self) -> Vec<f64> {
        let Some(flaws) = self.solid.flaws() else { return Vec::new() };
        let count = self.solid.risk_points();
        let mut noted = [vec![0.0], vec![NOTHING; count]].concat();
        if flaws.grow() {
            noted
                .extend([0.0, NOTHING].into_iter().flat_map(|own| std::iter::repeat_n(own, count)));
        }
        noted
    }

    /// Place of the running maxima in a state.
    pub(super) fn place_of_noted(&self, state: &[f64]) -> usize {
        state.len() - self.layout_of_flaws().len()
    }

    /// Running maxima of a state; `None` before anything is noted.
    fn noted<'s>(&self, state: &'s [f64]) -> Option<Noted<'s>> {
        let (&risk, rest) = state[self.place_of_noted(state)..].split_first()?;
        let stress = &rest[..self.solid.risk_points()];
        (*stress.first()? != NOTHING).then_some(Noted { risk, stress })
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

    /// Returns true if running maxima of a state are noted.
    pub(super) fn has_noted_flaws(&self, state: &[f64]) -> bool {
        self.noted(state).is_some()
    }

    /// Updates the running maxima to the observed values, a duration [s] after the last time; without one, no flaw
    /// grows until the next. The risk follows from the stresses; it is kept itself, so that it never falls where these
    /// change the interpolation between them.
    pub(super) fn note_flaws(
        &self,
        state: &mut [f64],
        memo: &mut SolidMemo,
        duration: Option<f64>,
    ) {
        let Some(flaws) = self.solid.flaws() else { return };
        memo.forget_risk();
        let place = self.place_of_noted(state);
        let count = self.solid.risk_points();
        let Some((risk, rest)) = state[place..].split_first_mut() else { return };
        let (stress, growth) = rest.split_at_mut(count);
        let observed = match (growth.split_at_mut_checked(count), duration) {
            (Some((grown, last)), Some(duration)) if flaws.grow() => {
                self.note_growth(flaws, Growth { grown, last }, memo.observed(), duration)
            }
            _ => Cow::Borrowed(memo.observed()),
        };
        self.solid.note_largest(flaws, stress, [&observed, memo.observed()], NOTHING);
        drop(observed);
        // While stress grows, the present one is the largest so far.
        let found = match memo.known_risk().filter(|_| stress == memo.observed()) {
            Some(present) => present,
            None => self.solid.risk(flaws, stress),
        };
        *risk = risk.max(found.min(f64::MAX));
        if stress == memo.observed() {
            memo.keep_present_risk(found);
        }
    }

    /// Lets flaws grow up to the observed stress; returns the stress that breaks as many which have not grown. Before
    /// the first note the stress counts as if it had been there from the start.
    fn note_growth<'o>(
        &self,
        flaws: &Flaws,
        Growth { grown, last }: Growth,
        observed: &'o [f64],
        duration: f64,
    ) -> Cow<'o, [f64]> {
        if last.first() == Some(&NOTHING) {
            last.copy_from_slice(observed);
        }
        self.solid.grow(flaws, [last, observed], duration, grown);
        last.copy_from_slice(observed);
        Cow::Owned(self.solid.inert_stress(flaws, observed, grown))
    }

    /// Refuses running maxima that no run produces.
    pub(super) fn check_flaws(&self, state: &[f64]) -> Result<(), String> {
        let Some(flaws) = self.solid.flaws() else { return Ok(()) };
        let place = self.place_of_noted(state);
        let is_possible = match self.noted(state) {
            None => state[place..] == self.nothing_noted()[..],
            Some(Noted { risk, stress }) => {
                let is_known = |own: &f64| own.abs() <= LARGEST;
                // Between nodes that keep their tension, the stress may have fallen.
                let follows = || {
                    let least = self.solid.risk(flaws, stress).min(f64::MAX);
                    let most = self.solid.largest_risk(flaws, stress) * (1.0 + ROUNDING);
                    risk.is_finite() && risk >= least && risk <= most.max(least)
                };
                stress.iter().all(is_known) && self.growth_is_possible(state) && follows()
            }
        };
        match is_possible {
            true => Ok(()),
            false => Err(format!("stresses of flaws in {} that no run leads to", self.name)),
        }
    }
}

impl SolidBody {
    /// Returns true if flaws of a state have grown by finite amounts at finite stresses.
    fn growth_is_possible(&self, state: &[f64]) -> bool {
        let count = self.solid.risk_points();
        let growth = &state[self.place_of_noted(state) + 1 + count..];
        let (grown, last) = growth.split_at(growth.len() / 2);
        let is_start =
            grown.iter().all(|own| *own == 0.0) && last.iter().all(|own| *own == NOTHING);
        is_start
            || grown.iter().all(|own| own.is_finite() && *own >= 0.0)
                && last.iter().all(|own| own.abs() <= LARGEST)
    }
}

impl SolidReader<'_> {
    /// The largest risk so far: that of the running maxima, or the present one before any is noted.
    pub fn risk_so_far(&mut self) -> Result<Risk, BodyError> {
        let body = self.body;
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        if let Some(known) = self.memo.risk_so_far() {
            return Ok(known);
        }
        let risk = match body.noted(self.state) {
            Some(Noted { risk, stress }) => {
                Risk { value: risk, at: body.solid.riskiest(flaws, stress) }
            }
            None => {
                let value = self.memo.present_risk(body, flaws, self.state)?;
                Risk { value, at: body.solid.riskiest(flaws, self.memo.observed()) }
            }
        };
        self.memo.keep_risk_so_far(risk);
        Ok(risk)
    }

    /// Failure density so far at a point [1/m³, 1/m² of flaws in faces].
    pub fn failure_density_at(
        &mut self,
        which: FlawsIn,
        point: [f64; 3],
    ) -> Result<f64, BodyError> {
        let body = self.body;
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        let stress = match body.noted(self.state) {
            Some(Noted { stress, .. }) => stress,
            None => self.memo.equivalent_stress(body, flaws, self.state)?,
        };
        let density = body.solid.failure_density_at(flaws, which, stress, point);
        Ok(density.min(f64::MAX))
    }

    /// The risk under the present stress.
    pub fn present_risk(&mut self) -> Result<f64, BodyError> {
        let body = self.body;
        let Some(flaws) = body.solid.flaws() else { return Err(BodyError::NoSuchReading) };
        self.memo.present_risk(body, flaws, self.state)
    }
}

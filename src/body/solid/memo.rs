//! Memo of a solid: its loads, and results computed when first needed.

use std::any::Any;
use std::borrow::Cow;

use super::SolidBody;
use super::failure::Risk;
use super::rows::ByClass;
use crate::body::{BodyError, Extreme, Memo};
use crate::method::damage::Energies;
use crate::method::fem::{
    Deformation, Flaws, ImageStress, NodalFields, SolidFem, SolidLoads, Temperatures,
};

/// Loads on a solid, and lazily computed results of these and of a state.
#[derive(Debug, Default)]
pub struct SolidMemo {
    /// Loads from the inputs.
    outside: SolidLoads,
    /// Loads including the transfers through ports, if there are any.
    with_received: Option<SolidLoads>,
    temperatures: Option<Temperatures>,
    /// Temperatures above the stress-free one; those of a change are its temperatures.
    thermal: Option<Temperatures>,
    is_change: bool,
    deformation: Option<Deformation>,
    /// Energies of a body that cracks.
    energies: Option<Energies>,
    hottest: Option<Extreme>,
    most_stressed: Option<[Extreme; 2]>,
    /// Stress at the nodes, kept for bodies with flaws.
    stresses: Option<Vec<ImageStress>>,
    /// Equivalent stress of flaws at the nodes, and its risk.
    equivalent_stress: Option<Vec<f64>>,
    present_risk: Option<f64>,
    /// Stress along the flaws that grow, one after another [Pa].
    along_flaws: Vec<f64>,
    /// Largest risk so far.
    risk_so_far: Option<Risk>,
    /// Results of the same loads before prescribed temperatures act, at the uniform temperature of the start.
    before_jump: Option<Box<Self>>,
    /// Results of the same loads and temperatures, with what the loads deform at once: `None` before that is computed,
    /// `Some(None)` where these are the present ones.
    at_once: Option<Option<Box<Self>>>,
    /// The last point that was read: its components are read one after another.
    stress: Option<([f64; 3], [f64; 6])>,
    /// For each symmetry class: whether heat drives it, and whether instantaneous loads do.
    driven: Option<Vec<[bool; 2]>>,
    /// Values from rows, by their numbers.
    by_rows: Vec<Option<ByClass>>,
}

/// Forces on a class without any.
static NO_FORCES: [Vec<Vec<f64>>; 2] = [Vec::new(), Vec::new()];

const OWN: &str = "a memo is that of the body that made it";

impl SolidMemo {
    pub fn new(outside: SolidLoads) -> Self {
        Self { outside, ..Self::default() }
    }

    /// Creates the memo of a change of loads.
    pub fn of_change(outside: SolidLoads) -> Self {
        Self { outside, is_change: true, ..Self::default() }
    }

    pub fn of(memo: &Memo) -> &Self {
        let memo: &(dyn Any + Send + Sync) = memo.as_ref();
        memo.downcast_ref().expect(OWN)
    }

    pub fn of_mut(memo: &mut Memo) -> &mut Self {
        let memo: &mut (dyn Any + Send + Sync) = memo.as_mut();
        memo.downcast_mut().expect(OWN)
    }

    /// Unwraps a memo whose results are to be carried over.
    pub fn taken(memo: Memo) -> Self {
        let memo: Box<dyn Any> = memo;
        *memo.downcast().expect(OWN)
    }

    /// Keeps results of the same state if the loads differ only in heat flow. Heat flow takes time to act; only
    /// prescribed temperatures and forces change temperatures and stress without delay.
    pub fn carry_over(&mut self, from: Self) {
        if !from.loads().acts_at_once_as(self.loads()) || self.is_change != from.is_change {
            return;
        }
        let outside = std::mem::take(&mut self.outside);
        let with_received = self.with_received.take();
        *self = Self { outside, with_received, ..from };
    }

    /// Discards all results that depend on the state.
    pub fn forget_state(&mut self) {
        let outside = std::mem::take(&mut self.outside);
        let with_received = self.with_received.take();
        *self = Self { outside, with_received, is_change: self.is_change, ..Self::default() };
    }

    /// Loads from the inputs alone.
    pub fn outside(&self) -> &SolidLoads {
        &self.outside
    }

    /// All loads.
    pub fn loads(&self) -> &SolidLoads {
        self.with_received.as_ref().unwrap_or(&self.outside)
    }

    /// All loads, to which transfers through ports are added.
    pub fn received(&mut self) -> &mut SolidLoads {
        self.with_received.get_or_insert_with(|| self.outside.clone())
    }

    /// Memo of the same loads while faces have the temperature of the start.
    pub fn before_jump(&mut self) -> &mut Self {
        let SolidLoads { heat, force, faces } = self.loads();
        let faces = faces.iter().map(|own| vec![0.0; own.len()]).collect();
        let loads = SolidLoads { heat: heat.clone(), force: force.clone(), faces };
        self.before_jump.get_or_insert_with(|| Box::new(Self::new(loads)))
    }

    /// Computes the deformation that the loads cause at once in a body with a history, whose state has that of the last
    /// loads. Where there is no equilibrium, the step that begins says so.
    pub fn deform_at_once(&mut self, body: &SolidBody, state: &[f64]) -> Result<(), BodyError> {
        if self.at_once.is_some() {
            return Ok(());
        }
        let temperatures = self.heat(body, state).clone();
        let deformation = body.deformation_at_once(state, &temperatures, self.loads())?;
        self.at_once = Some(deformation.map(|deformation| {
            let own = Self::new(self.loads().clone());
            let (temperatures, deformation) = (Some(temperatures), Some(deformation));
            Box::new(Self { temperatures, deformation, ..own })
        }));
        Ok(())
    }

    /// The memo with what the loads deform at once, if that is known and differs; otherwise this one.
    pub fn at_once(&mut self) -> &mut Self {
        match self.at_once {
            Some(Some(_)) => self.at_once.as_mut().and_then(Option::as_mut).expect("just seen"),
            _ => self,
        }
    }

    /// Nodal temperatures above the initial one.
    pub fn heat(&mut self, body: &SolidBody, state: &[f64]) -> &Temperatures {
        if self.temperatures.is_none() {
            let heat = body.heat_of(state);
            self.temperatures = Some(body.solid.temperatures(heat, self.loads()));
        }
        self.temperatures.as_ref().expect("just computed")
    }

    /// Nodal temperatures above the stress-free one, and the deformation.
    pub fn solve(
        &mut self,
        body: &SolidBody,
        state: &[f64],
    ) -> Result<(&Temperatures, &Deformation), BodyError> {
        if self.thermal.is_none() {
            let temperatures = self.heat(body, state).clone();
            self.thermal = Some(match self.is_change {
                true => temperatures,
                false => body.solid.above_stress_free(temperatures),
            });
        }
        let thermal = self.thermal.as_ref().expect("just computed");
        if self.deformation.is_none() {
            let loads = self.with_received.as_ref().unwrap_or(&self.outside);
            self.deformation = Some(match body.remembered(state, self.temperatures.as_ref())? {
                Some(deformation) => deformation,
                None => body.solid.deformation(thermal, loads)?,
            });
        }
        Ok((thermal, self.deformation.as_ref().expect("just computed")))
    }

    /// Values at all nodes.
    pub fn fields(&mut self, body: &SolidBody, state: &[f64]) -> Result<NodalFields, BodyError> {
        self.heat(body, state);
        self.solve(body, state)?;
        let known = "just computed";
        let [temperatures, thermal] = [&self.temperatures, &self.thermal];
        let (temperatures, thermal) = (temperatures.as_ref(), thermal.as_ref());
        let deformation = self.deformation.as_ref().expect(known);
        Ok(body.solid.fields(temperatures.expect(known), thermal.expect(known), deformation))
    }

    /// Returns true if all loads are changes.
    pub fn is_change(&self) -> bool {
        self.is_change
    }

    /// Returns for each symmetry class whether heat drives it, and whether instantaneous loads do.
    pub fn driven(&mut self, body: &SolidBody, heat: &[f64]) -> Vec<[bool; 2]> {
        if self.driven.is_none() {
            let any = |values: &[f64]| values.iter().any(|&value| value != 0.0);
            let by_heat: Vec<bool> = match body.solid.contents(heat) {
                Some(contents) => contents.into_iter().map(any).collect(),
                None => self.heat(body, heat).iter().map(|part| any(part)).collect(),
            };
            let loads = self.loads();
            let both = by_heat.into_iter().enumerate();
            let both = both.map(|(class, heat)| [heat, SolidFem::drives_at_once(loads, class)]);
            self.driven = Some(both.collect());
        }
        self.driven.clone().expect("just computed")
    }

    /// Operand of a class's rows: its part of a state, or nodal temperatures if heat has no modes.
    pub fn content<'s>(&'s self, body: &'s SolidBody, heat: &'s [f64], class: usize) -> &'s [f64] {
        match body.solid.contents_of(heat, class) {
            Some(content) => content,
            None => &self.temperatures.as_ref().expect("asked for by `driven`")[class],
        }
    }

    /// Values of the thermal faces of a class.
    pub fn faces(&self, class: usize) -> &[f64] {
        self.loads().faces.get(class).map_or(&[], Vec::as_slice)
    }

    /// Forces on the bottom and the top of a class.
    pub fn forces(&self, class: usize) -> &[Vec<Vec<f64>>; 2] {
        self.loads().force.get(class).unwrap_or(&NO_FORCES)
    }

    /// Values of a row by classes.
    pub fn by_row(&self, number: usize) -> Option<ByClass> {
        self.by_rows.get(number).copied().flatten()
    }

    pub fn keep_by_row(&mut self, number: usize, values: ByClass) {
        let count = self.by_rows.len().max(number + 1);
        self.by_rows.resize(count, None);
        self.by_rows[number] = Some(values);
    }

    /// Returns true if the deformation is already known.
    pub fn is_solved(&self) -> bool {
        self.deformation.is_some()
    }

    pub fn has_max_stress(&self) -> bool {
        self.most_stressed.is_some()
    }

    /// Energies of cracks, computed when first needed.
    pub fn energies(&mut self, compute: impl FnOnce() -> Energies) -> Energies {
        *self.energies.get_or_insert_with(compute)
    }

    /// Highest temperature.
    pub fn hottest(&mut self, body: &SolidBody, state: &[f64]) -> Extreme {
        if let Some(known) = self.hottest {
            return known;
        }
        let found = body.solid.hottest(self.heat(body, state));
        self.hottest = Some(found);
        found
    }

    /// Highest von Mises and largest principal stress.
    pub fn most_stressed(
        &mut self,
        body: &SolidBody,
        state: &[f64],
    ) -> Result<[Extreme; 2], BodyError> {
        if let Some(known) = self.most_stressed {
            return Ok(known);
        }
        let found = match body.solid.flaws() {
            None => {
                let (temperatures, deformation) = self.solve(body, state)?;
                body.solid.most_stressed(temperatures, deformation)
            }
            Some(_) => {
                let stresses = self.stresses(body, state)?.iter();
                let borrowed = stresses.map(|(image, stress)| (*image, Cow::Borrowed(&stress[..])));
                body.solid.most_stressed_of(borrowed)
            }
        };
        self.most_stressed = Some(found);
        Ok(found)
    }

    /// Stress at the nodes of all distinct images.
    pub fn stresses(
        &mut self,
        body: &SolidBody,
        state: &[f64],
    ) -> Result<&[ImageStress], BodyError> {
        if self.stresses.is_none() {
            let (temperatures, deformation) = self.solve(body, state)?;
            let found = body.solid.stresses(temperatures, deformation);
            self.stresses = Some(found);
        }
        Ok(self.stresses.as_deref().unwrap_or_default())
    }

    /// Equivalent stress of flaws at the nodes of all images.
    pub fn equivalent_stress(
        &mut self,
        body: &SolidBody,
        flaws: &Flaws,
        state: &[f64],
    ) -> Result<&[f64], BodyError> {
        if self.equivalent_stress.is_none() {
            let stresses = self.stresses(body, state)?;
            let found = body.solid.equivalent_stress(flaws, stresses);
            self.equivalent_stress = Some(found);
        }
        Ok(self.observed())
    }

    /// Stress along the flaws that grow, when last observed.
    pub fn along_flaws(&self) -> &[f64] {
        &self.along_flaws
    }

    pub fn keep_along_flaws(&mut self, stress: Vec<f64>) {
        self.along_flaws = stress;
    }

    /// The equivalent stress that is already known; none otherwise.
    pub fn observed(&self) -> &[f64] {
        self.equivalent_stress.as_deref().unwrap_or_default()
    }

    /// Risk under the present stress.
    pub fn present_risk(
        &mut self,
        body: &SolidBody,
        flaws: &Flaws,
        state: &[f64],
    ) -> Result<f64, BodyError> {
        if let Some(known) = self.present_risk {
            return Ok(known);
        }
        let found = body.solid.risk(flaws, self.equivalent_stress(body, flaws, state)?);
        self.present_risk = Some(found);
        Ok(found)
    }

    pub fn risk_so_far(&self) -> Option<Risk> {
        self.risk_so_far
    }

    pub fn keep_risk_so_far(&mut self, risk: Risk) {
        self.risk_so_far = Some(risk);
    }

    /// Discards the risk so far, as its running maxima change.
    pub fn forget_risk(&mut self) {
        self.risk_so_far = None;
    }

    /// Risk under the present stress, if it is already known.
    pub fn known_risk(&self) -> Option<f64> {
        self.present_risk
    }

    pub fn keep_present_risk(&mut self, risk: f64) {
        self.present_risk = Some(risk);
    }

    pub fn stress_at(
        &mut self,
        body: &SolidBody,
        state: &[f64],
        point: [f64; 3],
    ) -> Result<[f64; 6], BodyError> {
        if let Some((place, stress)) = self.stress
            && place == point
        {
            return Ok(stress);
        }
        let (temperatures, deformation) = self.solve(body, state)?;
        let stress = body.solid.stress_at(temperatures, deformation, point);
        self.stress = Some((point, stress));
        Ok(stress)
    }
}

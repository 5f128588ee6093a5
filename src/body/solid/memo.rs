use std::any::Any;

use super::SolidBody;
use super::rows::ByClass;
use crate::body::{BodyError, Extreme, Memo};
use crate::method::fem::{Deformation, NodalFields, SolidFem, SolidLoads, Temperatures};

/// What acts on a solid, and what follows from that and from a state, computed when first asked for.
#[derive(Debug, Default)]
pub struct SolidMemo {
    /// By the inputs.
    outside: SolidLoads,
    /// The same with what came through ports, if anything did.
    with_received: Option<SolidLoads>,
    temperatures: Option<Temperatures>,
    /// Temperatures above the one without stress; those of a change are its temperatures.
    thermal: Option<Temperatures>,
    is_change: bool,
    deformation: Option<Deformation>,
    hottest: Option<Extreme>,
    most_stressed: Option<[Extreme; 2]>,
    /// The last point asked for: its components are read one after another.
    stress: Option<([f64; 3], [f64; 6])>,
    /// Whether heat, and whether what acts at once drives each symmetry class.
    driven: Option<Vec<[bool; 2]>>,
    /// What rows gave, by their numbers.
    by_rows: Vec<Option<ByClass>>,
}

/// Of a class that no force acts on.
static NO_FORCES: [Vec<Vec<f64>>; 2] = [Vec::new(), Vec::new()];

const OWN: &str = "a memo is that of the body that made it";

impl SolidMemo {
    pub fn new(outside: SolidLoads) -> Self {
        Self { outside, ..Self::default() }
    }

    /// Of a change of what acts.
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

    /// A memo, for what it remembers to be taken over.
    pub fn taken(memo: Memo) -> Self {
        let memo: Box<dyn Any> = memo;
        *memo.downcast().expect(OWN)
    }

    /// Takes over what follows from the same state, where what acts differs by no more than heat that flows, which takes
    /// time: temperatures and stress follow prescribed temperatures and forces alone at once.
    pub fn carry_over(&mut self, from: Self) {
        if !from.loads().acts_at_once_as(self.loads()) || self.is_change != from.is_change {
            return;
        }
        let outside = std::mem::take(&mut self.outside);
        let with_received = self.with_received.take();
        *self = Self { outside, with_received, ..from };
    }

    /// Forgets all that depends on the state.
    pub fn forget_state(&mut self) {
        let outside = std::mem::take(&mut self.outside);
        let with_received = self.with_received.take();
        *self = Self { outside, with_received, is_change: self.is_change, ..Self::default() };
    }

    /// What acts by the inputs alone.
    pub fn outside(&self) -> &SolidLoads {
        &self.outside
    }

    /// All that acts.
    pub fn loads(&self) -> &SolidLoads {
        self.with_received.as_ref().unwrap_or(&self.outside)
    }

    /// All that acts, for what comes through ports to be added.
    pub fn received(&mut self) -> &mut SolidLoads {
        self.with_received.get_or_insert_with(|| self.outside.clone())
    }

    /// Nodal temperatures above the initial one.
    pub fn heat(&mut self, body: &SolidBody, state: &[f64]) -> &Temperatures {
        if self.temperatures.is_none() {
            let heat = body.heat_of(state);
            self.temperatures = Some(body.solid.temperatures(heat, self.loads()));
        }
        self.temperatures.as_ref().expect("just computed")
    }

    /// Nodal temperatures above the one without stress, and the deformation.
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

    /// Whether all is a change.
    pub fn is_change(&self) -> bool {
        self.is_change
    }

    /// Whether heat, and whether what acts at once drives each symmetry class.
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

    /// What rows of a class act on: its part of a state, or nodal temperatures where heat has no modes.
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

    /// What a row gave by classes.
    pub fn by_row(&self, number: usize) -> Option<ByClass> {
        self.by_rows.get(number).copied().flatten()
    }

    pub fn keep_by_row(&mut self, number: usize, values: ByClass) {
        let count = self.by_rows.len().max(number + 1);
        self.by_rows.resize(count, None);
        self.by_rows[number] = Some(values);
    }

    /// Whether stresses need but be looked up.
    pub fn is_solved(&self) -> bool {
        self.deformation.is_some()
    }

    pub fn has_max_stress(&self) -> bool {
        self.most_stressed.is_some()
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
        let (temperatures, deformation) = self.solve(body, state)?;
        let found = body.solid.most_stressed(temperatures, deformation);
        self.most_stressed = Some(found);
        Ok(found)
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

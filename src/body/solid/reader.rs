//! Readings of a solid in a state.

use super::SolidBody;
use super::memo::SolidMemo;
use super::rows::{self, Acting};
use crate::body::{BodyError, Extreme};
use crate::coupling::FaceMeans;
use crate::method::damage::Energies;
use crate::method::fem::HeatTotals;

/// A solid in a state, or a change of one; linear readings are the same for both.
pub struct SolidReader<'a> {
    pub body: &'a SolidBody,
    pub state: &'a [f64],
    pub memo: &'a mut SolidMemo,
}

impl SolidReader<'_> {
    /// Temperature above the initial one [K]. At a point that is `alone` it is computed from the modes, which is
    /// cheaper than the whole field.
    pub fn rise_at(&mut self, point: [f64; 3], alone: bool) -> f64 {
        let (body, solid) = (self.body, &self.body.solid);
        match alone {
            true => solid.rise_at(body.heat_of(self.state), self.memo.loads(), point),
            false => solid.rise_from(self.memo.heat(body, self.state), point),
        }
    }

    /// Mean temperature above the initial one over a cell [K].
    pub fn mean_rise(&mut self, means: &FaceMeans, cell: usize) -> f64 {
        means.rise(cell, self.memo.heat(self.body, self.state))
    }

    /// [K]
    pub fn initial_temperature(&self) -> f64 {
        self.body.solid.initial_temperature()
    }

    /// Readings by influence rows.
    fn by_rows(&mut self) -> Acting<'_> {
        Acting { body: self.body, state: self.state, memo: self.memo }
    }

    /// Along an axis [m]
    pub fn displacement_along(&mut self, axis: usize, point: [f64; 3]) -> Result<f64, BodyError> {
        if let Some(found) = self.by_rows().at_point(point, rows::displacement(axis)) {
            return found;
        }
        Ok(self.displacement_at(point)?[axis])
    }

    /// One of xx, yy, zz, xy, yz, xz [Pa].
    pub fn stress_component(&mut self, slot: usize, point: [f64; 3]) -> Result<f64, BodyError> {
        if let Some(found) = self.by_rows().at_point(point, rows::stress(slot)) {
            return found;
        }
        Ok(self.stress_at(point)?[slot])
    }

    /// Mean of a component over a cell of a field, by its place among the scene's; `None` if it needs a solution.
    pub fn mean_by_rows(
        &mut self,
        cell: (usize, usize),
        component: usize,
    ) -> Option<Result<f64, BodyError>> {
        self.by_rows().over_cell(cell, component)
    }

    /// Signed stress intensity of a flaw by its row; `None` if it needs a solution.
    pub fn flaw_by_row(&mut self, flaw: usize) -> Option<Result<f64, BodyError>> {
        self.by_rows().of_flaw(flaw)
    }

    /// Signed stress intensity of a flaw from the stress of all nodes; `None` if it is not read so.
    pub fn flaw_by_nodes(&mut self, flaw: usize) -> Option<Result<f64, BodyError>> {
        let body = self.body;
        let sum = body.flaw_sums.get(body.place_of_flaw(flaw)?)?.as_ref()?;
        let stresses = self.memo.stresses(body, self.state);
        Some(stresses.map(|stresses| body.solid.value_of(sum, stresses)))
    }

    /// [m]
    fn displacement_at(&mut self, point: [f64; 3]) -> Result<[f64; 3], BodyError> {
        let (_, deformation) = self.memo.solve(self.body, self.state)?;
        Ok(self.body.solid.displacement_at(deformation, point))
    }

    /// xx, yy, zz, xy, yz, xz [Pa]
    pub fn stress_at(&mut self, point: [f64; 3]) -> Result<[f64; 6], BodyError> {
        let mut found = [0.0; 6];
        for (slot, value) in found.iter_mut().enumerate() {
            match self.by_rows().at_point(point, rows::stress(slot)) {
                Some(component) => *value = component?,
                None => return self.solved_stress_at(point),
            }
        }
        Ok(found)
    }

    fn solved_stress_at(&mut self, point: [f64; 3]) -> Result<[f64; 6], BodyError> {
        self.memo.stress_at(self.body, self.state, point)
    }

    /// Accumulated plastic strain [1].
    pub fn plastic_strain_at(&mut self, point: [f64; 3]) -> Result<f64, BodyError> {
        let (_, deformation) = self.memo.solve(self.body, self.state)?;
        Ok(self.body.solid.plastic_strain_at(deformation, point))
    }

    /// [K]
    pub fn max_temperature(&mut self) -> f64 {
        self.hottest().value
    }

    /// Highest von Mises and largest principal stress [Pa].
    pub fn max_stress(&mut self) -> Result<[f64; 2], BodyError> {
        Ok(self.most_stressed()?.map(|extreme| extreme.value))
    }

    /// Highest temperature [K].
    pub fn hottest(&mut self) -> Extreme {
        self.memo.hottest(self.body, self.state)
    }

    /// Highest von Mises and largest principal stress [Pa].
    pub fn most_stressed(&mut self) -> Result<[Extreme; 2], BodyError> {
        self.memo.most_stressed(self.body, self.state)
    }

    pub fn heat_totals(&self) -> HeatTotals {
        self.body.solid.heat_totals(self.body.heat_of(self.state))
    }

    /// [J]
    pub fn heat_stored(&self) -> f64 {
        self.body.solid.heat_stored(self.body.heat_of(self.state))
    }

    /// [J]
    pub fn heat_drift(&self) -> f64 {
        self.body.solid.heat_drift(self.body.heat_of(self.state))
    }

    /// [m³]
    pub fn liquid_volume(&self) -> f64 {
        self.body.solid.liquid_volume(self.body.heat_of(self.state))
    }

    /// Largest accumulated plastic strain [1].
    pub fn max_plastic_strain(&self) -> f64 {
        self.body.max_plastic_strain(self.state)
    }

    /// Energy dissipated by yielding [J].
    pub fn plastic_work(&self) -> f64 {
        self.body.plastic_work(self.state)
    }

    /// Energy dissipated by relaxation [J].
    pub fn relaxation_loss(&self) -> f64 {
        self.body.relaxation_loss(self.state)
    }

    /// Elastic energy, and that of hardening [J].
    pub fn stored_energy(&mut self) -> Result<f64, BodyError> {
        self.body.stored_energy(self.state, self.memo.heat(self.body, self.state))
    }

    /// Damage [1].
    pub fn damage_at(&mut self, point: [f64; 3]) -> Result<f64, BodyError> {
        let (_, deformation) = self.memo.solve(self.body, self.state)?;
        Ok(self.body.solid.damage_at(deformation, point))
    }

    /// Largest damage [1].
    pub fn max_damage(&self) -> f64 {
        self.body.max_damage(self.state)
    }

    /// Energies of a body that cracks [J].
    pub fn energies(&mut self) -> Energies {
        self.body.energies(self.state, self.memo)
    }

    /// Work that loads and thermal strain have done [J].
    pub fn work_of_cracks(&self) -> f64 {
        self.body.work_of_cracks(self.state)
    }

    /// Area of notches and of cracks: the energy of cracks over that per area [m²].
    pub fn crack_area(&mut self) -> f64 {
        let [all, _] = self.body.areas_of_cracks(self.state, self.memo);
        all
    }

    /// Number of cracks [1].
    pub fn crack_count(&self) -> f64 {
        self.body.cracks_of(self.state).count as f64
    }

    /// Time from the start to the first crack [s].
    pub fn time_of_first_crack(&self) -> f64 {
        self.body.time_of_first_crack(self.state)
    }

    /// Place of the first crack along an axis: x, or the radius, y and z [m].
    pub fn place_of_first_crack(&self, axis: usize) -> f64 {
        self.body.place_of_first_crack(self.state, axis)
    }

    /// Depth of the deepest crack [m].
    pub fn crack_depth(&self) -> f64 {
        self.body.cracks_of(self.state).depth
    }

    /// Length of notches and cracks in a plane section [m].
    pub fn crack_length(&mut self) -> f64 {
        let width = self.body.width_of_section();
        width.map_or(0.0, |width| self.crack_area() / width)
    }

    /// Length of cracks in a plane section without that of notches [m].
    pub fn crack_growth(&mut self) -> f64 {
        let Some(width) = self.body.width_of_section() else { return 0.0 };
        let [all, notches] = self.body.areas_of_cracks(self.state, self.memo);
        (all - notches) / width
    }

    pub fn fallback_particles(&self) -> f64 {
        self.body.solid.fallback_particles().unwrap_or(0) as f64
    }
}

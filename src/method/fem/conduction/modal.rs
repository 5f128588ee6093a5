//! Finite elements, exact in time by their modes, for one material or several layers.

use faer::Mat;

use super::{Heat, HeatFailure, HeatValue, ModalHeat};
use crate::method::fem::heat::{DepthModes, HeatLoads, HeatProblem, ModalRow};
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::Mesh;
use crate::runtime::allowance::Allowance;
use crate::state::Layout;

impl<D: DepthModes> Heat for HeatProblem<D> {
    fn layout(&self) -> Layout {
        self.layout()
    }

    /// One step of any length.
    fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure> {
        allowance.spend(1.0, "steps", state.len())?;
        self.advance(state, loads, dt);
        Ok(())
    }

    fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.nodal(state, faces)
    }

    fn along_depth(&self, state: &[f64], faces: &[Vec<f64>], rows: &Mat<f64>) -> Vec<Vec<f64>> {
        self.along_depth(state, faces, rows)
    }

    fn stored(&self, state: &[f64]) -> f64 {
        self.stored(state)
    }

    fn totals(&self, state: &[f64]) -> HeatTotals {
        self.totals(state)
    }

    fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Option<Vec<f64>> {
        Some(self.rates(state, loads, rates))
    }

    fn modal(&self) -> Option<&dyn ModalHeat> {
        Some(self)
    }
}

impl<D: DepthModes> ModalHeat for HeatProblem<D> {
    fn at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        (point, image): ([f64; 3], [bool; 2]),
    ) -> f64 {
        self.temperature_at(mesh, state, faces, point, image)
    }

    fn contents<'s>(&'s self, state: &'s [f64]) -> Vec<&'s [f64]> {
        self.class_contents(state)
    }

    fn row(&self, class: usize, nodal: &[f64]) -> [Vec<f64>; 2] {
        self.row(class, nodal)
    }

    fn driven(&self, loads: &HeatLoads) -> Vec<bool> {
        self.driven(loads)
    }

    fn decay_rates(&self, take: &[bool]) -> Vec<f64> {
        self.modal_rates(take)
    }

    fn sources(&self, take: &[bool], loads: &HeatLoads) -> Vec<f64> {
        self.modal_sources(take, loads)
    }

    fn brought_in_by(&self, loads: &HeatLoads) -> f64 {
        self.brought_in_by(loads)
    }

    fn value_row(&self, mesh: &Mesh, take: &[bool], of: &HeatValue) -> ModalRow {
        match of {
            HeatValue::Point { place, image } => self.point_row(mesh, take, (*place, *image)),
            HeatValue::Face { weights, high } => self.face_row(take, weights, *high),
            HeatValue::Stored => self.stored_row(take),
        }
    }
}

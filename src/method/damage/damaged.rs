//! Elements in which damage takes stiffness: what they lack of the forces and the stiffness of the intact domain.
//!
//! All others are linear, so that the forces of a domain are those of its intact stiffness and of its temperatures,
//! less those of a few elements.

use super::domain::{Kinematics, Point};
use super::elements::{AT_A_TIME, Elements, Nodal, dot};
use crate::math::grid_matrix::GridMatrix;
use crate::runtime::parallel::Team;

/// Elements with a damaged corner, in ascending order.
#[derive(Debug)]
pub struct Damaged<const D: usize> {
    places: Vec<[usize; D]>,
}

impl<const D: usize> Damaged<D> {
    pub fn none() -> Self {
        Self { places: Vec::new() }
    }

    pub fn of<const C: usize, const V: usize>(
        elements: &Elements<D, C, V>,
        damage: &[f64],
    ) -> Self {
        let grid = elements.grid;
        let columns = grid.elements()[0];
        let all = (0..grid.rows()).flat_map(|row| (0..columns).map(move |i| grid.element(i, row)));
        let is_damaged =
            |place: &[usize; D]| grid.corners::<C>(*place).iter().any(|&n| damage[n] > 0.0);
        Self { places: all.filter(is_damaged).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Adds the forces of their stress to nodal forces, and takes those away that they have where nothing is damaged
    /// [N].
    pub fn correct_forces<const C: usize, const V: usize>(
        &self,
        elements: &Elements<D, C, V>,
        nodal: &Nodal,
        forces: &mut [f64],
        team: &Team,
    ) where
        Point<D, C>: Kinematics<D, C, V>,
    {
        let intact = elements.intact_tangent();
        let loss = |strain: [f64; V], damage: f64| -> [f64; V] {
            let own = elements.respond(strain, damage).stress;
            std::array::from_fn(|i| own[i] - dot(&intact[i], &strain))
        };
        let found =
            team.map(self.places.len(), |n| elements.nodal_forces(self.places[n], nodal, loss));
        for (place, own) in self.places.iter().zip(&found) {
            elements.add_forces(forces, *place, own);
        }
    }

    /// Adds the difference of their stiffness from that of intact elements to a matrix.
    pub fn correct_stiffness<const C: usize, const V: usize>(
        &self,
        elements: &Elements<D, C, V>,
        nodal: &Nodal,
        matrix: &mut GridMatrix<D, D>,
        team: &Team,
    ) where
        Point<D, C>: Kinematics<D, C, V>,
    {
        let intact = elements.intact_tangent();
        let correction = |place: [usize; D]| {
            let mut stiffness = Elements::<D, C, V>::no_stiffness();
            elements.each_strain(place, nodal, |_, point, strain, damage| {
                let mut tangent = elements.tangent(strain, damage);
                let entries = tangent.as_flattened_mut().iter_mut().zip(intact.as_flattened());
                entries.for_each(|(own, intact)| *own -= intact);
                Elements::add_stiffness(&mut stiffness, point, &tangent);
            });
            Elements::<D, C, V>::mirror(&mut stiffness);
            stiffness
        };
        // Some at a time, which need not fill the memory.
        for places in self.places.chunks(AT_A_TIME) {
            let found = team.map(places.len(), |n| correction(places[n]));
            for (place, own) in places.iter().zip(&found) {
                matrix.add_element::<C>(*place, own);
            }
        }
    }

    /// Gives the rows of their nodes the values of another matrix.
    pub fn restore<const C: usize, const V: usize>(
        &self,
        elements: &Elements<D, C, V>,
        matrix: &mut GridMatrix<D, D>,
        other: &GridMatrix<D, D>,
    ) {
        for place in &self.places {
            for node in elements.grid.corners::<C>(*place) {
                matrix.copy_row_from(node, other);
            }
        }
    }
}

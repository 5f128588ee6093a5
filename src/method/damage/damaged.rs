//! Elements in which damage takes stiffness: what they lack of the forces and the stiffness of the intact section.
//!
//! All others are linear, so that the forces of a section are those of its intact stiffness and of its temperatures,
//! less those of a few elements.

use super::elements::{Elements, Nodal, add_forces, add_stiffness, dot, mirror};
use crate::laws::fracture::Components;
use crate::math::nine_point::NinePoint;
use crate::runtime::parallel::Team;

/// Elements with a damaged corner, in ascending order.
#[derive(Debug, Default)]
pub struct Damaged {
    places: Vec<[usize; 2]>,
}

impl Damaged {
    pub fn of(elements: &Elements, damage: &[f64]) -> Self {
        let [columns, rows] = elements.grid.elements();
        let all = (0..rows).flat_map(|j| (0..columns).map(move |i| [i, j]));
        let is_damaged =
            |place: &[usize; 2]| elements.grid.corners(*place).iter().any(|&n| damage[n] > 0.0);
        Self { places: all.filter(is_damaged).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Adds the forces of their stress to nodal forces, and takes those away that they have where nothing is damaged
    /// [N].
    pub fn correct_forces(
        &self,
        elements: &Elements,
        nodal: &Nodal,
        forces: &mut [f64],
        team: &Team,
    ) {
        let intact = elements.intact_tangent();
        let loss = |strain: Components, damage: f64| -> Components {
            let own = elements.law.respond(strain, damage).stress;
            std::array::from_fn(|i| own[i] - dot(&intact[i], &strain))
        };
        let found =
            team.map(self.places.len(), |n| elements.nodal_forces(self.places[n], nodal, loss));
        for (place, own) in self.places.iter().zip(&found) {
            add_forces(forces, elements.grid.corners(*place), own);
        }
    }

    /// Adds the difference of their stiffness from that of intact elements to a matrix.
    pub fn correct_stiffness(
        &self,
        elements: &Elements,
        nodal: &Nodal,
        matrix: &mut NinePoint<2>,
        team: &Team,
    ) {
        let intact = elements.intact_tangent();
        let found = team.map(self.places.len(), |n| {
            let mut stiffness = Box::new([0.0; 64]);
            elements.each_strain(self.places[n], nodal, |_, point, strain, damage| {
                let mut tangent = elements.law.respond(strain, damage).stiffness.tangent();
                let entries = tangent.as_flattened_mut().iter_mut().zip(intact.as_flattened());
                entries.for_each(|(own, intact)| *own -= intact);
                let strains = std::array::from_fn(|k| point.unit_strains(k / 2)[k % 2]);
                add_stiffness(&mut stiffness, point, &strains, tangent);
            });
            mirror(&mut stiffness);
            stiffness
        });
        for (place, own) in self.places.iter().zip(&found) {
            matrix.add_element(*place, &own[..]);
        }
    }

    /// Gives the rows of their nodes the values of another matrix.
    pub fn restore(&self, elements: &Elements, matrix: &mut NinePoint<2>, other: &NinePoint<2>) {
        for place in &self.places {
            for node in elements.grid.corners(*place) {
                matrix.copy_row_from(node, other);
            }
        }
    }
}

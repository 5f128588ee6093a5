//! State of a lattice.

use std::slice::from_mut;

use super::equilibrium::Balanced;
use crate::state::{Field, Fields, Per};

/// Everything that changes; displacements and damage come first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LatticeState {
    /// Displacements of the unknowns [m, rad].
    pub displacement: Vec<f64>,
    /// ω of each link [1].
    pub damage: Vec<f64>,
    /// Load [N].
    pub force: f64,
    /// Value of what is prescribed [m].
    pub prescribed: f64,
    /// Work of the load, energy that damage dissipated and energy that sudden breaks released [J].
    pub work: f64,
    pub dissipated: f64,
    pub released: f64,
}

/// Sums over a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LatticeTotals {
    /// Displacement of the load [m].
    pub displacement: f64,
    /// Opening of the notch at the lower face [m].
    pub opening: Option<f64>,
    /// [J]
    pub elastic_energy: f64,
    /// [1]
    pub max_damage: f64,
    /// Number of links without force.
    pub broken_links: usize,
    /// Length of the facets of broken links [m].
    pub crack_length: f64,
}

impl LatticeState {
    pub(super) fn balanced(&self) -> Balanced {
        Balanced { displacement: self.displacement.clone(), force: self.force }
    }
}

impl Fields for LatticeState {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, per| Field { name, words, per, width: 1 };
        let body = |name, words| of(name, words, Per::Body);
        vec![
            (
                of("displacement", "displacements and rotations [m, rad]", Per::Node),
                &mut self.displacement,
            ),
            (of("damage", "damage [1]", Per::Link), &mut self.damage),
            (body("force", "load [N]"), from_mut(&mut self.force)),
            (body("prescribed", "prescribed value [m]"), from_mut(&mut self.prescribed)),
            (body("work", "work of the load [J]"), from_mut(&mut self.work)),
            (
                body("dissipated", "energy that damage dissipated [J]"),
                from_mut(&mut self.dissipated),
            ),
            (body("released", "energy of sudden breaks [J]"), from_mut(&mut self.released)),
        ]
    }
}

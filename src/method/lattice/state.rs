//! State of a lattice.

use std::slice::from_mut;

use super::Particles;
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
    pub broken: Broken,
}

/// Extent of the damage of a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Broken {
    /// [1]
    pub max_damage: f64,
    /// Number of links without force.
    pub links: usize,
    /// Length of their facets [m].
    pub length: f64,
}

impl Broken {
    pub fn of(particles: &Particles, damage: &[f64]) -> Self {
        let damaged = damage.iter().zip(&particles.pairs);
        let broken = damaged.filter(|(damage, _)| **damage >= 1.0).map(|(_, pair)| pair.facet);
        Self {
            max_damage: damage.iter().copied().fold(0.0, f64::max),
            links: broken.clone().count(),
            // From zero: a sum of nothing is negative zero.
            length: broken.fold(0.0, |sum, facet| sum + facet),
        }
    }
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

//! A body that cracks, in a section or in space alike.

use super::DamageError;
use super::breaking::BreakingOrder;
use super::broken::{Cracks, Side, Sides};
use super::domain::{Kinematics, Point};
use super::elements::Energies;
use super::problem::{DamageProblem, DamageState, Effort};
use crate::laws::fracture::GradientDamage;
use crate::runtime::allowance::Allowance;

/// A damage problem of either dimension. States are those of one model; damage is that of its nodes.
pub trait DamageModel: Send + Sync {
    /// Coordinates of nodes along each axis [m].
    fn axes(&self) -> &[Vec<f64>];

    fn law(&self) -> &GradientDamage;

    fn initial_state(&self) -> DamageState;

    /// See [`DamageProblem::advance_noting`].
    fn advance(
        &self,
        state: &mut DamageState,
        loads: (&[f64], &[f64]),
        allowance: &Allowance,
        order: &mut BreakingOrder,
    ) -> Result<Effort, DamageError>;

    /// Energies of a state [J].
    fn energies(&self, state: &DamageState) -> Energies;

    /// See [`DamageProblem::stress`].
    fn stress(&self, state: &DamageState) -> Vec<[f64; 6]>;

    /// Place of a node along each axis [m].
    fn place(&self, node: usize) -> Vec<f64>;

    /// Counts cracks and measures their depth, with the kinds of both sides along each axis.
    fn cracks(&self, damage: &[f64], sides: &[[Side; 2]]) -> Cracks;

    /// Nodes of cracks that are not among those broken from the start.
    fn grown(&self, damage: &[f64], from_start: &[bool]) -> Vec<usize>;

    /// Returns true if a crack at later damage is not part of one at earlier damage.
    fn has_new_crack(&self, before: &[f64], after: &[f64]) -> bool;

    /// Nodes that are farther than a distance [m] along one of the axes from all broken ones.
    fn away_from_broken(&self, damage: &[f64], distance: f64) -> Vec<usize>;

    /// Width of the widest crack over the size of its elements [1].
    fn opening(&self, displacement: &[f64], damage: &[f64]) -> f64;
}

impl<const D: usize, const C: usize, const V: usize> DamageModel for DamageProblem<D, C, V>
where
    Point<D, C>: Kinematics<D, C, V>,
{
    fn axes(&self) -> &[Vec<f64>] {
        &self.elements.domain.axes
    }

    fn law(&self) -> &GradientDamage {
        &self.elements.law
    }

    fn initial_state(&self) -> DamageState {
        self.initial_state()
    }

    fn advance(
        &self,
        state: &mut DamageState,
        loads: (&[f64], &[f64]),
        allowance: &Allowance,
        order: &mut BreakingOrder,
    ) -> Result<Effort, DamageError> {
        self.advance_noting(state, loads, allowance, order)
    }

    fn energies(&self, state: &DamageState) -> Energies {
        self.energies(state)
    }

    fn stress(&self, state: &DamageState) -> Vec<[f64; 6]> {
        self.stress(state)
    }

    fn place(&self, node: usize) -> Vec<f64> {
        self.elements.domain.place(node).to_vec()
    }

    fn cracks(&self, damage: &[f64], sides: &[[Side; 2]]) -> Cracks {
        let sides: Sides<D> = std::array::from_fn(|axis| sides[axis]);
        self.elements.domain.cracks(damage, sides, self.elements.law.length)
    }

    fn grown(&self, damage: &[f64], from_start: &[bool]) -> Vec<usize> {
        self.elements.domain.grown(damage, from_start)
    }

    fn has_new_crack(&self, before: &[f64], after: &[f64]) -> bool {
        self.elements.domain.has_new_crack(before, after)
    }

    fn away_from_broken(&self, damage: &[f64], distance: f64) -> Vec<usize> {
        self.elements.domain.away_from_broken(damage, distance)
    }

    fn opening(&self, displacement: &[f64], damage: &[f64]) -> f64 {
        self.elements.domain.opening(displacement, damage)
    }
}

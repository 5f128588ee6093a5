//! Damage and displacement of a domain, from one state to the next.

use std::sync::OnceLock;

use super::DamageError;
use super::acceleration::{Acceleration, Alternated};
use super::balance::{Balance, Unknowns};
use super::bounded::minimise;
use super::breaking::BreakingOrder;
use super::domain::{Kinematics, Point};
use super::elements::{Elements, Energies, Nodal, Released};
use crate::math::grid_matrix::{GridMatrix, Padded};
use crate::math::separable::dot;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Largest number of alternations of a step.
const MOST_ALTERNATIONS: usize = 3000;
/// Change of damage in an alternation below which a step has converged, and part of the forces that may be left then;
/// before, it may be more in proportion to the change, up to `LARGEST_TOLERANCE`.
/// Damage at the tip of a crack is far more sensitive to these than the energy: with 1e-4 of the forces the edge
/// crack of `benches/cracks.rs` grows by less than half of what it grows with 1e-6.
const TOLERANCE: f64 = 1e-4;
const TOLERANCE_OF_FORCES: f64 = 1e-6;
const LARGEST_TOLERANCE: f64 = 1e-3;
/// Part of the forces that may be left where Newton's method came to no smaller one.
const MOST_LEFT: f64 = 1e-3;

/// Equilibrium of a domain that cracks.
pub struct DamageProblem<const D: usize, const C: usize, const V: usize> {
    pub elements: Elements<D, C, V>,
    unknowns: Unknowns<D>,
    /// Stiffness without damage, once known.
    intact: OnceLock<GridMatrix<D, D>>,
    threads: usize,
}

/// That of a section.
pub type SectionProblem = DamageProblem<2, 4, 4>;

/// State of a domain.
#[derive(Debug, Clone, PartialEq)]
pub struct DamageState {
    /// [m], all components of a node together.
    pub displacement: Vec<f64>,
    /// [1], 0 intact to 1 broken.
    pub damage: Vec<f64>,
    /// Temperature above the stress-free one [K].
    pub rise: Vec<f64>,
    /// Work that loads and thermal strain have done [J].
    pub work: f64,
}

/// Effort of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effort {
    pub alternations: usize,
    pub iterations: usize,
    pub factorings: usize,
}

impl<const D: usize, const C: usize, const V: usize> DamageProblem<D, C, V>
where
    Point<D, C>: Kinematics<D, C, V>,
{
    /// `held` marks prescribed displacements, all components of a node together.
    pub fn new(elements: Elements<D, C, V>, held: Vec<bool>, threads: usize) -> Self {
        let unknowns = Unknowns::new(elements.grid, held);
        Self { elements, unknowns, intact: OnceLock::new(), threads }
    }

    pub fn initial_state(&self) -> DamageState {
        let nodes = self.elements.grid.nodes();
        DamageState {
            displacement: vec![0.0; D * nodes],
            damage: vec![0.0; nodes],
            rise: vec![0.0; nodes],
            work: 0.0,
        }
    }

    /// Advances a state to a minimum of the energy at nodal temperatures above the stress-free one [K] under nodal
    /// forces [N], by alternating minimisation in displacement and damage. Displacements that are held have their
    /// values already. After an error the state is unusable.
    pub fn advance(
        &self,
        state: &mut DamageState,
        (rise, forces): (&[f64], &[f64]),
        allowance: &Allowance,
    ) -> Result<Effort, DamageError> {
        self.advance_noting(state, (rise, forces), allowance, &mut BreakingOrder::default())
    }

    /// The same, noting the order in which places break.
    pub fn advance_noting(
        &self,
        state: &mut DamageState,
        (rise, forces): (&[f64], &[f64]),
        allowance: &Allowance,
        order: &mut BreakingOrder,
    ) -> Result<Effort, DamageError> {
        let team = Team::new(self.threads);
        let before = state.clone();
        let intact = self.intact.get_or_init(|| self.elements.intact_stiffness(&team));
        let domain = (&self.elements, intact, &self.unknowns);
        let mut balance = Balance::new(domain, &team, allowance);
        let effort = self.minimise(state, (rise, forces), &mut balance, order)?;
        state.rise.copy_from_slice(rise);
        state.work += self.work([&before, state], &team);
        Ok(effort)
    }

    /// Work that loads and thermal strain do between two states [J], by their mean forces and stresses. Where a crack
    /// jumps, these are those before and after it.
    fn work(&self, [first, last]: [&DamageState; 2], team: &Team) -> f64 {
        let moved: Vec<f64> =
            first.displacement.iter().zip(&last.displacement).map(|(old, new)| new - old).collect();
        let warmed: Vec<f64> = first.rise.iter().zip(&last.rise).map(|(a, b)| b - a).collect();
        let of_state = |state: &DamageState| {
            let forces = self.elements.forces(&state.nodal(), team);
            dot(&forces, &moved) + self.elements.thermal_work(&state.nodal(), &warmed, team)
        };
        0.5 * (of_state(first) + of_state(last))
    }

    fn minimise(
        &self,
        state: &mut DamageState,
        (rise, forces): (&[f64], &[f64]),
        balance: &mut Balance<D, C, V>,
        order: &mut BreakingOrder,
    ) -> Result<Effort, DamageError> {
        let team = balance.team;
        let low = state.damage.clone();
        let grid = self.elements.grid;
        let mut matrix = GridMatrix::<D, 1>::zeros(grid);
        let mut damage = Padded::<1>::zeros(grid);
        damage.inner_mut().copy_from_slice(&state.damage);
        let mut acceleration = Acceleration::new();
        let mut change = 1.0_f64;
        for alternation in 1..=MOST_ALTERNATIONS {
            let fields = (damage.inner(), rise);
            let in_proportion = TOLERANCE_OF_FORCES * change / TOLERANCE;
            let tolerance = in_proportion.clamp(TOLERANCE_OF_FORCES, LARGEST_TOLERANCE);
            let settled = balance.settle(&mut state.displacement, fields, forces, tolerance)?;
            let before = damage.inner().to_vec();
            let margin = self.elements.reach_of_damage();
            let gradient =
                self.soften((&settled.released, margin), &low, &mut damage, &mut matrix, team);
            let after = damage.inner();
            order.note(alternation, after);
            change = after.iter().zip(&before).fold(0.0, |most, (a, b)| most.max((a - b).abs()));
            if change <= TOLERANCE && tolerance <= TOLERANCE_OF_FORCES {
                if settled.left > MOST_LEFT {
                    let residual = settled.left;
                    return Err(DamageError::NoEquilibrium { residual, tolerance: MOST_LEFT });
                }
                state.damage.copy_from_slice(damage.inner());
                return Ok(Effort {
                    alternations: alternation,
                    iterations: balance.iterations,
                    factorings: balance.factorings,
                });
            }
            let alternated = Alternated { before: &before, after, gradient: &gradient, change };
            let next = acceleration.next(&alternated, &low);
            damage.inner_mut().copy_from_slice(&next);
        }
        Err(DamageError::NoMinimum { alternations: MOST_ALTERNATIONS, change })
    }

    /// Moves damage to the minimum of the energy under energies that cracks release; returns the gradient before. Only
    /// nodes within a margin of those that may be damaged are moved at first, and more of them if damage spreads.
    pub(super) fn soften(
        &self,
        (released, mut margin): (&Released<C>, usize),
        low: &[f64],
        damage: &mut Padded<1>,
        matrix: &mut GridMatrix<D, 1>,
        team: &Team,
    ) -> Vec<f64> {
        let before = damage.clone();
        loop {
            let wanted = self.elements.endangered(released, before.inner(), margin);
            let load = self.elements.damage_system(released, &wanted, matrix, team);
            let nodes: Vec<u32> =
                (0..wanted.len() as u32).filter(|&n| wanted[n as usize]).collect();
            let system = (&*matrix, &load[..]);
            let gradient = minimise(system, &nodes, low, damage, 0.1 * TOLERANCE, team);
            // Damage that comes near the others may spread to them.
            let is_damaged: Vec<bool> = damage.inner().iter().map(|d| *d > 0.0).collect();
            let around = self.elements.grid.dilated(&is_damaged);
            if around.iter().zip(&wanted).all(|(around, wanted)| *wanted || !around) {
                return gradient;
            }
            damage.clone_from(&before);
            margin *= 4;
        }
    }

    /// Energies of a state [J].
    pub fn energies(&self, state: &DamageState) -> Energies {
        self.elements.energies(&state.nodal(), &Team::new(self.threads))
    }

    /// Forces of the stresses on all nodes [N].
    pub fn forces(&self, state: &DamageState) -> Vec<f64> {
        self.elements.forces(&state.nodal(), &Team::new(self.threads))
    }

    /// Stress at the nodes as xx, yy, zz, xy, yz and xz, where the normal of a section is y [Pa].
    pub fn stress(&self, state: &DamageState) -> Vec<[f64; 6]> {
        self.elements.nodal_stress(&state.nodal())
    }
}

impl DamageState {
    fn nodal(&self) -> Nodal<'_> {
        Nodal { displacement: &self.displacement, damage: &self.damage, rise: &self.rise }
    }
}

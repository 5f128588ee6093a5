//! Correction of a factored stiffness where the present one differs from it: a patch of nodes with a factor of its own.
//!
//! Elements that break, open or close between two linear systems change a few rows by orders of magnitude, each of
//! which costs conjugate gradients an iteration or more. Solving with the present stiffness inside the patch, then with
//! the earlier factor everywhere, and once more inside the patch (a symmetric multiplicative Schwarz method; J. Xu 1992,
//! doi 10.1137/1034116) leaves them the smooth rest.

use super::balance::Unknowns;
use crate::math::cholesky::{SolverError, SparseCholesky};
use crate::math::nine_point::{Grid, NinePoint, Padded};
use crate::runtime::parallel::Team;

/// Relative change of a diagonal entry from which on a node belongs to the patch.
const CHANGED: f64 = 0.02;
/// Layers of nodes around changed ones.
const OVERLAP: usize = 2;
/// Largest part of all nodes in a patch.
const LARGEST: f64 = 0.1;

/// A part of a section whose equilibrium is solved for itself.
pub struct Patch {
    /// Its nodes, and those whose forces depend on its displacements, by number.
    nodes: Vec<u32>,
    reached: Vec<u32>,
    /// Places of its unknowns among all components.
    places: Vec<usize>,
    factor: SparseCholesky,
}

/// Extent of the change of a stiffness.
pub enum Extent {
    Nothing,
    Patch(Patch),
    /// So much that a new factor of the whole is worth more.
    TooMuch,
}

impl Patch {
    /// Finds where a stiffness differs from that of an earlier factor, of which the diagonal is known.
    pub fn between(
        stiffness: &NinePoint<2>,
        diagonal: &[[f64; 2]],
        unknowns: &Unknowns,
        threads: usize,
    ) -> Result<Extent, SolverError> {
        let grid = stiffness.grid();
        let has_changed = |node: usize| {
            let now = stiffness.diagonal(node);
            (0..2).any(|i| {
                (now[i] - diagonal[node][i]).abs() > CHANGED * diagonal[node][i].min(now[i])
            })
        };
        let mut inside: Vec<bool> = (0..grid.nodes()).map(has_changed).collect();
        if !inside.contains(&true) {
            return Ok(Extent::Nothing);
        }
        (0..OVERLAP).for_each(|_| inside = dilated(&inside, grid));
        let nodes = numbers(&inside);
        if nodes.len() as f64 > LARGEST * grid.nodes() as f64 {
            return Ok(Extent::TooMuch);
        }
        let (places, number, order) = unknowns.within(&inside);
        let factor = SparseCholesky::factor(&stiffness.lower_triangle(&number), &order, threads)?;
        let reached = numbers(&dilated(&inside, grid));
        Ok(Extent::Patch(Self { nodes, reached, places, factor }))
    }

    /// Adds the displacements of the patch under the forces in it, all else at rest.
    pub fn solve(&self, force: &[f64], displacement: &mut Padded<2>) {
        let mut values: Vec<f64> = self.places.iter().map(|&place| force[place]).collect();
        self.factor.solve_in_place(&mut values);
        let all = displacement.inner_mut();
        self.places.iter().zip(values).for_each(|(&place, value)| all[place] += value);
    }

    /// Subtracts from a force what displacements of the patch alone take, wherever they do.
    pub fn balance_around(&self, force: &mut [f64], displacement: &Padded<2>, system: &System) {
        subtract(&self.reached, force, displacement, system);
    }

    /// Subtracts from a force what displacements take inside the patch.
    pub fn balance_inside(&self, force: &mut [f64], displacement: &Padded<2>, system: &System) {
        subtract(&self.nodes, force, displacement, system);
    }
}

/// A stiffness, and the components whose displacements are prescribed.
pub struct System<'a> {
    pub stiffness: &'a NinePoint<2>,
    pub held: &'a [bool],
    pub team: &'a Team,
}

fn subtract(nodes: &[u32], force: &mut [f64], displacement: &Padded<2>, system: &System) {
    let mut product = vec![0.0; 2 * nodes.len()];
    system.stiffness.product_of(nodes, displacement, &mut product, system.team);
    for (&node, product) in nodes.iter().zip(product.chunks_exact(2)) {
        let own = (2 * node as usize..).zip(product);
        own.filter(|(place, _)| !system.held[*place]).for_each(|(place, p)| force[place] -= p);
    }
}

/// Nodes within one layer of others, these included.
fn dilated(inside: &[bool], grid: Grid) -> Vec<bool> {
    let [columns, rows] = grid.counts;
    let mut wider = vec![false; inside.len()];
    for node in (0..inside.len()).filter(|&node| inside[node]) {
        let (i, j) = (node % columns, node / columns);
        for row in j.saturating_sub(1)..(j + 2).min(rows) {
            wider[row * columns + i.saturating_sub(1)..row * columns + (i + 2).min(columns)]
                .fill(true);
        }
    }
    wider
}

fn numbers(inside: &[bool]) -> Vec<u32> {
    (0..inside.len() as u32).filter(|&node| inside[node as usize]).collect()
}

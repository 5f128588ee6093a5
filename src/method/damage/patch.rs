//! Correction of a factored stiffness where the present one differs from it: a patch of nodes with a factor of its own.
//!
//! Elements that break, open or close between two linear systems change a few rows by orders of magnitude, each of
//! which costs conjugate gradients an iteration or more. Solving with the present stiffness inside the patch, then with
//! the earlier factor everywhere, and once more inside the patch (a symmetric multiplicative Schwarz method; J. Xu
//! 1992, doi 10.1137/1034116) leaves them the smooth rest.

use super::balance::Unknowns;
use crate::math::cholesky::{Elimination, SolverError, SparseCholesky};
use crate::math::grid_matrix::{GridMatrix, Padded};
use crate::runtime::parallel::Team;

/// Relative change of a diagonal entry from which on a node belongs to the patch, in a section and in space, where a
/// factor costs many iterations.
const CHANGED: f64 = 0.02;
const CHANGED_IN_SPACE: f64 = 0.3;
/// Layers of nodes around changed ones.
const OVERLAP: usize = 2;
/// Largest part of all nodes in a patch, in a section and in space.
const LARGEST: f64 = 0.1;
const LARGEST_IN_SPACE: f64 = 0.3;

/// A part of a domain whose equilibrium is solved for itself.
pub struct Patch<const D: usize> {
    part: Part,
    factor: SparseCholesky,
    /// Diagonal of the stiffness that was factored, by node of the part.
    diagonal: Vec<[f64; D]>,
}

/// Some nodes of a domain, and the elimination of their displacements.
struct Part {
    inside: Vec<bool>,
    /// The nodes, and those whose forces depend on their displacements, by number.
    nodes: Vec<u32>,
    reached: Vec<u32>,
    /// Places of the unknowns among all components, and the number of each component; `usize::MAX` for others.
    places: Vec<usize>,
    number: Vec<usize>,
    elimination: Elimination,
}

/// Extent of the change of a stiffness.
pub enum Extent<const D: usize> {
    Nothing,
    Patch(Patch<D>),
    /// So much that a new factor of the whole is worth more.
    TooMuch,
}

impl Part {
    fn new<const D: usize>(
        inside: Vec<bool>,
        stiffness: &GridMatrix<D, D>,
        unknowns: &Unknowns<D>,
    ) -> Result<Self, SolverError> {
        let nodes = numbers(&inside);
        let reached = numbers(&stiffness.grid().dilated(&inside));
        let (places, number, order) = unknowns.within(&inside);
        let elimination = Elimination::new(&stiffness.lower_triangle(&number), &order)?;
        Ok(Self { inside, nodes, reached, places, number, elimination })
    }

    fn factor<const D: usize>(
        self,
        stiffness: &GridMatrix<D, D>,
        threads: usize,
    ) -> Result<Patch<D>, SolverError> {
        let lower = stiffness.lower_triangle(&self.number);
        let factor = self.elimination.factor(&lower, threads)?;
        let diagonal = self.nodes.iter().map(|&node| stiffness.diagonal(node as usize)).collect();
        Ok(Patch { part: self, factor, diagonal })
    }
}

impl<const D: usize> Patch<D> {
    /// Finds where a stiffness differs from that of an earlier factor, of which the diagonal is known. The last patch
    /// serves again as far as it can.
    pub fn between(
        stiffness: &GridMatrix<D, D>,
        diagonal: &[[f64; D]],
        unknowns: &Unknowns<D>,
        threads: usize,
        last: Option<Self>,
    ) -> Result<Extent<D>, SolverError> {
        let grid = stiffness.grid();
        let has_changed = |node: usize| differs(stiffness.diagonal(node), diagonal[node]);
        let mut inside: Vec<bool> = (0..grid.nodes()).map(has_changed).collect();
        let covers =
            |patch: &Self| patch.part.inside.iter().zip(&inside).all(|(own, now)| *own || !now);
        let last = match last {
            Some(last) if covers(&last) && last.is_of(stiffness) => return Ok(Extent::Patch(last)),
            last => last,
        };
        if !inside.contains(&true) {
            return Ok(Extent::Nothing);
        }
        (0..OVERLAP).for_each(|_| inside = grid.dilated(&inside));
        let count = inside.iter().filter(|inside| **inside).count();
        let most = if D == 2 { LARGEST } else { LARGEST_IN_SPACE };
        if count as f64 > most * grid.nodes() as f64 {
            return Ok(Extent::TooMuch);
        }
        let part = match last {
            Some(last) if last.part.inside == inside => last.part,
            _ => Part::new(inside, stiffness, unknowns)?,
        };
        Ok(Extent::Patch(part.factor(stiffness, threads)?))
    }

    /// Returns true if its factor is that of a stiffness, nearly.
    fn is_of(&self, stiffness: &GridMatrix<D, D>) -> bool {
        let mut own = self.part.nodes.iter().zip(&self.diagonal);
        own.all(|(&node, then)| !differs(stiffness.diagonal(node as usize), *then))
    }

    /// Adds the displacements of the patch under the forces in it, all else at rest.
    pub fn solve(&self, force: &[f64], displacement: &mut Padded<D>) {
        let mut values: Vec<f64> = self.part.places.iter().map(|&place| force[place]).collect();
        self.factor.solve_in_place(&mut values);
        let all = displacement.inner_mut();
        self.part.places.iter().zip(values).for_each(|(&place, value)| all[place] += value);
    }

    /// Subtracts from a force what displacements of the patch alone take, wherever they do.
    pub fn balance_around(&self, force: &mut [f64], displacement: &Padded<D>, system: &System<D>) {
        subtract(&self.part.reached, force, displacement, system);
    }

    /// Subtracts from a force what displacements take inside the patch.
    pub fn balance_inside(&self, force: &mut [f64], displacement: &Padded<D>, system: &System<D>) {
        subtract(&self.part.nodes, force, displacement, system);
    }
}

/// Returns true if the diagonal of a node belongs to another stiffness.
fn differs<const D: usize>(now: [f64; D], then: [f64; D]) -> bool {
    let changed = if D == 2 { CHANGED } else { CHANGED_IN_SPACE };
    (0..D).any(|i| (now[i] - then[i]).abs() > changed * then[i].min(now[i]))
}

/// A stiffness, and the components whose displacements are prescribed.
pub struct System<'a, const D: usize> {
    pub stiffness: &'a GridMatrix<D, D>,
    pub held: &'a [bool],
    pub team: &'a Team,
}

fn subtract<const D: usize>(
    nodes: &[u32],
    force: &mut [f64],
    displacement: &Padded<D>,
    system: &System<D>,
) {
    let mut product = vec![0.0; D * nodes.len()];
    system.stiffness.product_of(nodes, displacement, &mut product, system.team);
    for (&node, product) in nodes.iter().zip(product.chunks_exact(D)) {
        let own = (D * node as usize..).zip(product);
        own.filter(|(place, _)| !system.held[*place]).for_each(|(place, p)| force[place] -= p);
    }
}

fn numbers(inside: &[bool]) -> Vec<u32> {
    (0..inside.len() as u32).filter(|&node| inside[node as usize]).collect()
}

//! Quasi-brittle bodies as a lattice of particles, joined by links that soften and break.

mod arrangement;
mod equilibrium;
mod frame;
mod link;
mod order;
mod problem;
mod state;
mod stiffness;
mod tangent;
mod voronoi;
#[cfg(test)]
mod tests;

pub use arrangement::{Arrangement, Notch, Pair, Particles, Strip};
pub use frame::Support;
pub use link::{Link, Sheet};
pub use problem::{Control, Lattice, LatticePlan};
pub use state::{LatticeState, LatticeTotals};

use crate::math::cholesky::SolverError;
use crate::runtime::allowance::Halt;

/// Reasons why a lattice cannot be built or moved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LatticeError {
    #[error(
        "no particles are at both sides of the notch (allowed: a notch inside the strip, or a smaller `spacing`)"
    )]
    NoMouth,
    #[error(
        "links break suddenly, and after {relaxations} relaxations the forces do not balance (allowed: shorter \
         communication steps, a smaller `spacing`, or `control = \"opening\"`)"
    )]
    NoEquilibrium { relaxations: usize },
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error(transparent)]
    Solver(#[from] SolverError),
}

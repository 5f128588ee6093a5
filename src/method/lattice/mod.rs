//! Quasi-brittle bodies as a lattice of particles, joined by links that soften and break.

mod arrangement;
mod dynamics;
mod equilibrium;
mod fragments;
mod frame;
mod frequency;
mod held;
mod link;
mod member;
mod motion;
#[cfg(test)]
mod motion_tests;
mod order;
mod problem;
mod settling;
mod state;
mod stiffness;
mod tangent;
mod voronoi;
#[cfg(test)]
mod tests;

pub use arrangement::{Arrangement, Notch, Pair, Particles, Strip};
pub use dynamics::{Inertia, MovingLattice};
pub use frame::Support;
pub use link::{Link, Sheet};
pub use motion::{LatticeMotion, MotionTotals};
pub use problem::{Control, Lattice, LatticePlan};
pub use state::{Broken, LatticeState, LatticeTotals};

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
        "links break suddenly, and after {relaxations} relaxations the forces do not balance (allowed: an input that \
         rises in small steps, a smaller `spacing`, or `control = \"opening\"`)"
    )]
    NoEquilibrium { relaxations: usize },
    #[error(
        "links break suddenly, and after {steps} time steps the strip still moves (allowed: an input that rises \
         in small steps, a smaller `spacing`, or `inertia = true`)"
    )]
    NotSettled { steps: usize },
    #[error(
        "the load moves at {speed:.2e} m/s, faster than waves in the strip (allowed: up to {most:.2e} m/s, by smaller \
         changes of the input or longer communication steps)"
    )]
    TooFast { speed: f64, most: f64 },
    #[error(
        "{missing:.1e} J of the energy have no cause: links are crushed in less than a time step (allowed: slower \
         changes of the input, or a stronger material)"
    )]
    Unbalanced { missing: f64 },
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error(transparent)]
    Solver(#[from] SolverError),
}

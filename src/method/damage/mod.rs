//! Cracks as gradient damage: solids, in a section or in space, that minimise elastic energy and that of cracks.

mod acceleration;
mod balance;
mod bounded;
mod breaking;
mod broken;
mod damaged;
mod domain;
mod elements;
mod model;
mod patch;
mod problem;
#[cfg(test)]
mod tests;

pub use breaking::BreakingOrder;
pub use broken::{Cracks, Section, Side, broken};
pub use domain::{Domain, Form};
pub use elements::{Bricks, Elements, Energies, PlaneElements};
pub use model::DamageModel;
pub use problem::{DamageProblem, DamageState, Effort, SectionProblem};

use crate::math::cholesky::SolverError;
use crate::runtime::allowance::Halt;

/// Reasons why a step failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DamageError {
    #[error(
        "no equilibrium at given damage: {residual:.1e} of the forces are left, where {tolerance:.0e} is wanted; loads may \
         be more than the body bears once it is cracked (allowed: smaller loads, or supports that hold each part)"
    )]
    NoEquilibrium { residual: f64, tolerance: f64 },
    #[error(
        "{alternations} alternations of displacement and damage found no minimum of the energy: damage still changes \
         by {change:.1e} (allowed: shorter communication steps, or smaller loads)"
    )]
    NoMinimum { alternations: usize, change: f64 },
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error(transparent)]
    Solver(#[from] SolverError),
}

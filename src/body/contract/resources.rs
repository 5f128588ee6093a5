//! Resources that a body takes from its host, and data shared between bodies.

use std::sync::Arc;

use crate::body::contract::Memo;
use crate::body::{BodyError, KeptReduction, Reading};
use crate::method::fem::ElasticProblem;
use crate::runtime::allowance::Allowance;

/// Work, stack, threads and memory; the defaults are those of a small body.
pub trait Resources {
    /// Refuses a step of `dt` [s] that would exceed the allowed work.
    fn foresee(&self, _state: &[f64], _dt: f64, _: &Allowance) -> Result<(), BodyError> {
        Ok(())
    }

    /// Approximate number of updates of unknowns in `dt` [s]; zero if all steps take the same work.
    fn updates(&self, _dt: f64) -> f64 {
        0.0
    }

    /// Returns true if a reading needs more stack than a host's thread has to provide. Without a memo nothing is
    /// cached.
    fn is_deep(&self, _memo: Option<&Memo>, _reading: &Reading) -> bool {
        false
    }

    /// Returns the data from which a reduced body is made, shared by equal bodies.
    fn reduction(&self) -> Option<KeptReduction> {
        None
    }

    /// Returns the elastic problem, shared by bodies that differ only in thermal data.
    fn stiffness(&self) -> Option<Arc<ElasticProblem>> {
        None
    }

    /// Number of stored entries of all factorisations so far.
    fn factor_entries(&self) -> usize {
        0
    }

    /// Number of threads that the body may use.
    fn threads(&self) -> usize {
        1
    }

    /// Returns true if steps need more stack than a host's thread has to provide.
    fn steps_are_deep(&self) -> bool {
        false
    }
}

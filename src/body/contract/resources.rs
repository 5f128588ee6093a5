//! What a body takes from its host, and what bodies share.

use std::sync::Arc;

use crate::body::contract::Memo;
use crate::body::{BodyError, KeptReduction, Reading};
use crate::method::fem::ElasticProblem;
use crate::runtime::allowance::Allowance;

/// Work, stack, threads and memory; the defaults are those of a body that takes little.
pub trait Resources {
    /// Ends a step of `dt` [s] that is known to take too long.
    fn foresee(&self, _state: &[f64], _dt: f64, _: &Allowance) -> Result<(), BodyError> {
        Ok(())
    }

    /// Updates of unknowns that `dt` [s] take, about; nothing where any step takes the same.
    fn updates(&self, _dt: f64) -> f64 {
        0.0
    }

    /// Whether a reading takes more stack than a host's thread need have; nothing is remembered yet without a memo.
    fn is_deep(&self, _memo: Option<&Memo>, _reading: &Reading) -> bool {
        false
    }

    /// What a reduced body follows from, for those that are equal.
    fn reduction(&self) -> Option<KeptReduction> {
        None
    }

    /// What bodies that differ in what concerns heat alone share.
    fn stiffness(&self) -> Option<Arc<ElasticProblem>> {
        None
    }

    /// Stored entries of all factorisations made so far.
    fn factor_entries(&self) -> usize {
        0
    }

    /// Threads that the body may use.
    fn threads(&self) -> usize {
        1
    }

    /// Whether steps take more stack than a host's thread need have.
    fn steps_are_deep(&self) -> bool {
        false
    }
}

//! Derivatives of bodies that are linear between steps.

use crate::body::contract::Memo;
use crate::body::{BodyError, Reading};

/// A body that is linear between steps: its outputs are linear in its unknowns and loads.
pub trait Linear {
    /// Returns a memo of the changes of all loads while the inputs change at `rates`.
    fn change(&self, inputs: &[f64], rates: &[f64]) -> Memo;

    /// Returns the time derivative of the state under the loads and their change.
    fn rates(&self, state: &[f64], memo: &Memo, change: &Memo) -> Vec<f64>;

    /// Returns the change of a value. At kinks it is one-sided, in the direction of the change: where stress vanishes,
    /// where principal stresses meet, and at extremes of a body. An extreme follows its node; among several such nodes,
    /// the one that changes fastest.
    fn read_rate(
        &self,
        now: (&[f64], &mut Memo),
        change: (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError>;
}

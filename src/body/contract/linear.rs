//! Derivatives of bodies that are linear between steps.

use crate::body::contract::Memo;
use crate::body::{BodyError, Reading};

/// A body that is linear between steps: unknowns and what acts on it go into its outputs as sums.
pub trait Linear {
    /// What acts, as it changes when the inputs change at `rates`: a memo in which all is a change.
    fn change(&self, inputs: &[f64], rates: &[f64]) -> Memo;

    /// Time derivative of the state under what acts and its change.
    fn rates(&self, state: &[f64], memo: &Memo, change: &Memo) -> Vec<f64>;

    /// The change of a value. At kinks it is one-sided, in the direction of the change: where stress vanishes or
    /// principal stresses meet, and for extremes of a body, which follow the node that has the extreme, of several
    /// the fastest.
    fn read_rate(
        &self,
        now: (&[f64], &mut Memo),
        change: (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError>;
}

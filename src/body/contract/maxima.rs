//! Running maxima of a body.

use crate::body::BodyError;
use crate::body::contract::Memo;
use crate::method::fem::Extreme;

/// Maxima that are updated as steps begin and end; by default there are none.
pub trait Maxima {
    /// Returns the number of running maxima of the body.
    fn peaks(&self) -> usize {
        0
    }

    /// Returns the present value of the quantity behind a running maximum. The memo belongs to the state and its loads.
    fn observe(
        &self,
        _state: &[f64],
        _memo: &mut Memo,
        _which: usize,
    ) -> Result<Extreme, BodyError> {
        Err(BodyError::NoSuchReading)
    }

    /// Returns the highest value that the quantity behind a running maximum has when a step begins, under inputs that
    /// may have jumped; `so_far` is the maximum noted before.
    fn observe_at_beginning(
        &self,
        (state, _inputs): (&[f64], &[f64]),
        memo: &mut Memo,
        which: usize,
        _so_far: Option<Extreme>,
    ) -> Result<Extreme, BodyError> {
        self.observe(state, memo, which)
    }

    /// Returns true if the quantity behind a running maximum is right when a step begins. Stress is not where
    /// temperatures have just been prescribed: only the nodes of the face have jumped, which strains those next to them
    /// by what no body has. As the first step begins, such a quantity is that before the jump.
    fn holds_at_beginning(&self, _which: usize) -> bool {
        true
    }

    /// Returns true if the state holds running maxima of a field.
    fn keeps_field(&self) -> bool {
        false
    }

    /// Returns true if that field is to be noted when a step begins.
    fn field_holds_at_beginning(&self, _state: &[f64]) -> bool {
        true
    }

    /// Returns true if a number of the state belongs to that field, so that the check of the body alone decides on its
    /// size: before anything is noted it is a mark.
    fn is_of_field(&self, _state: &[f64], _at: usize) -> bool {
        false
    }

    /// Computes the present values of that field and keeps them in the memo of the state and its loads, at the end of a
    /// step of a duration [s], or as one begins.
    fn observe_field(
        &self,
        _state: &[f64],
        _memo: &mut Memo,
        _duration: Option<f64>,
    ) -> Result<(), BodyError> {
        Ok(())
    }

    /// Updates the running maxima of that field to the values observed then.
    fn note_field(&self, _state: &mut [f64], _memo: &mut Memo, _duration: Option<f64>) {}

    /// Refuses a running maximum that no run of this body produces, with the reason.
    fn check_peak(&self, _which: usize, _peak: &Extreme) -> Result<(), String> {
        Ok(())
    }
}

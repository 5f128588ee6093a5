//! Running maxima of a body.

use crate::body::BodyError;
use crate::body::contract::Memo;
use crate::method::fem::Extreme;

/// Maxima that are noted as steps begin and end; most bodies keep none.
pub trait Maxima {
    /// How many running maxima are kept of the body.
    fn peaks(&self) -> usize {
        0
    }

    /// What the running maximum of a number is of, as it is now, where the memo is that of what acts and of the state.
    fn observe(
        &self,
        _state: &[f64],
        _memo: &mut Memo,
        _which: usize,
    ) -> Result<Extreme, BodyError> {
        Err(BodyError::NoSuchReading)
    }

    /// Refuses a running maximum that no run of this body leads to, with what is wrong with it.
    fn check_peak(&self, _which: usize, _peak: &Extreme) -> Result<(), String> {
        Ok(())
    }
}

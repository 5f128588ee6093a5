//! Lengths of steps.

use super::ModelError;
use crate::limits;

/// Refuses a step of `step` [s] that is outside the limits of the arithmetic.
pub fn check_step_length(step: f64) -> Result<(), ModelError> {
    let bounds = limits::step().bounds();
    match bounds.side(step) {
        Some(side) => {
            Err(ModelError::StepLength { step, requirement: bounds.requirement(side), bounds })
        }
        None => Ok(()),
    }
}

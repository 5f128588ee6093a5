//! Inputs that a body follows evenly.

use crate::inputs::InputPath;

/// Inputs that are approached over a step where a host gives no derivatives; by default all jump at its beginning.
pub trait Approach {
    /// Returns the inputs that the body approaches: the place of each, with its value at the beginning and its slope.
    /// Marks the state if there are any. The step lasts for `dt` [s], and its inputs are reached after `ahead` [s],
    /// later than at its end if it is a part of a longer one.
    fn approached(
        &self,
        _: &mut Vec<f64>,
        _: &InputPath,
        (_dt, _ahead): (f64, f64),
    ) -> Vec<(usize, [f64; 2])> {
        Vec::new()
    }
}

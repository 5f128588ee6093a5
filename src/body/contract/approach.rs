//! Inputs that a body follows evenly.

use crate::inputs::InputPath;

/// Inputs that are approached over a step where a host gives no derivatives; by default all jump at its beginning.
pub trait Approach {
    /// Returns the inputs that the body approaches over a step of a duration [s]: the place of each, with its value at
    /// the beginning and its slope. Marks the state if there are any.
    fn approached(
        &self,
        _: &mut Vec<f64>,
        _: &InputPath,
        _duration: f64,
    ) -> Vec<(usize, [f64; 2])> {
        Vec::new()
    }
}

//! Inputs that a body follows evenly.

use crate::inputs::InputPath;

/// Inputs that are approached over a step where a host gives no derivatives; by default all jump at its beginning.
pub trait Approach {
    /// Returns the inputs that the body approaches: the place of each, with its value at the beginning and its slope.
    /// Marks the state if there are any. The step lasts for `dt` [s], and its inputs are reached after `ahead` [s],
    /// later than at its end if it is a part of a longer one.
    fn approached(
        &self,
        state: &mut Vec<f64>,
        path: &InputPath,
        (dt, ahead): (f64, f64),
    ) -> Vec<(usize, [f64; 2])> {
        // A whole step takes all of the way.
        if dt == ahead {
            return Vec::new();
        }
        let shared = self.shared_by_parts(state).into_iter();
        shared.filter_map(|(place, from)| path.approach(place, from, ahead)).collect()
    }

    /// Inputs, each with its value at the end of the last step, to which a part of a longer step takes the body by its
    /// share of the way; by default none.
    fn shared_by_parts(&self, _state: &[f64]) -> Vec<(usize, f64)> {
        Vec::new()
    }
}

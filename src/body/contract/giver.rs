//! What a body gives to another below it.

use crate::inputs::InputPath;

/// A body that may stand on another; by default it gives nothing.
pub trait Giver {
    /// Moments within a step of this length [s] at which a body below should be asked anew, as what this one gives
    /// changes fast there.
    fn moments(&self, _state: &[f64], _path: &InputPath, _duration: f64) -> Vec<f64> {
        Vec::new()
    }

    /// Counts what is told as of the last step over that from the state `before`, too.
    fn join_steps(&self, _before: &[f64], _state: &mut Vec<f64>) {}

    /// What was given through the port below during the last step.
    fn given(&self, _state: &[f64]) -> Option<Given> {
        None
    }
}

/// What a body gave to another through the cells of a port.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Given {
    /// Of the advance [s].
    pub duration: f64,
    /// Of each cell [J].
    pub heat: Vec<f64>,
    /// Flow of heat above its mean at the beginning of the advance, from where it falls evenly to its opposite, of
    /// each cell [W]; empty if it is even.
    pub falling: Vec<f64>,
    /// Of each cell along x, y, z (r, –, z in axisymmetry) [N s]; empty where forces do not pass.
    pub impulse: Vec<[f64; 3]>,
    /// Planes x = 0 and y = 0 about which all this is symmetric.
    pub symmetric: [bool; 2],
}

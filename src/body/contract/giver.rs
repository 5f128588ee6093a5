//! Transfer of heat and impulse from a body to the one below.

use crate::inputs::InputPath;

/// A body that may stand on another; by default it transfers nothing.
pub trait Giver {
    /// Returns moments within a step of this length [s] at which the body below should be evaluated anew, because the
    /// transfer changes fast there.
    fn moments(&self, _state: &[f64], _path: &InputPath, _duration: f64) -> Vec<f64> {
        Vec::new()
    }

    /// Adds the transfer of the step from the state `before` to that of the last step.
    fn join_steps(&self, _before: &[f64], _state: &mut Vec<f64>) {}

    /// Returns the amounts transferred through the port below during the last step.
    fn given(&self, _state: &[f64]) -> Option<Given> {
        None
    }
}

/// Amounts that a body transferred to another through the cells of a port.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Given {
    /// Duration of the transfer [s].
    pub duration: f64,
    /// Heat of each cell [J].
    pub heat: Vec<f64>,
    /// Excess heat flow of each cell over its mean at the beginning of the transfer [W], from which it falls linearly
    /// to the opposite value; empty if the flow is constant.
    pub falling: Vec<f64>,
    /// Impulse of each cell along x, y, z (r, –, z in axisymmetry) [N s]; empty where forces are not transferred.
    pub impulse: Vec<[f64; 3]>,
    /// Planes x = 0 and y = 0 about which the transfer is symmetric.
    pub symmetric: [bool; 2],
}

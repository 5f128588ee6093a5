//! What every transfer between the nodes of a face and the cells of its port answers to.

use crate::port::WallCells;

/// Conservative transfer between the nodes of the top or the bottom of a solid and the cells through which others
/// exchange with it. Nodal values and vectors stand class by class of the planes of symmetry; a class that is zero is
/// empty.
pub trait Transfer: Send + Sync {
    /// The cells through which others exchange with the face.
    fn cells(&self) -> WallCells;

    /// Values at each cell, those of a cell together, of `count` planes of nodes.
    fn at_cells(&self, planes: &[Vec<f64>], count: usize) -> Vec<f64>;

    /// Nodal vectors of the heat of each cell. What is given is `symmetric` about the planes x = 0 and y = 0, or not.
    fn heat(&self, amounts: &[f64], symmetric: [bool; 2]) -> Vec<Vec<f64>>;

    /// Nodal vectors of the forces on each cell, each with the component of displacement that it acts on. `along` gives
    /// the components along x, y and z; of radial cells the first points outward.
    fn forces(
        &self,
        along: &dyn Fn(usize) -> Vec<f64>,
        symmetric: [bool; 2],
    ) -> Vec<(usize, Vec<Vec<f64>>)>;
}

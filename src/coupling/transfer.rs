//! Interface of transfers between the nodes of a face and the cells of its port.

use crate::port::WallCells;

/// Conservative transfer between the nodes of the top or the bottom of a solid and the cells through which other bodies
/// exchange with it. Nodal values and vectors are listed class by class of the planes of symmetry; a class that is zero
/// is empty.
pub trait Transfer: Send + Sync {
    /// The cells through which other bodies exchange with the face.
    fn cells(&self) -> WallCells;

    /// Values at each cell, with those of a cell together, of `count` planes of nodes.
    fn at_cells(&self, planes: &[Vec<f64>], count: usize) -> Vec<f64>;

    /// Nodal vectors of the heat of each cell; `symmetric` states whether the heat is symmetric about the planes x = 0
    /// and y = 0.
    fn heat(&self, amounts: &[f64], symmetric: [bool; 2]) -> Vec<Vec<f64>>;

    /// Nodal vectors of the forces on each cell, each with its displacement component. `along` returns the components
    /// along x, y and z; of radial cells the first one is radial.
    fn forces(
        &self,
        along: &dyn Fn(usize) -> Vec<f64>,
        symmetric: [bool; 2],
    ) -> Vec<(usize, Vec<Vec<f64>>)>;
}

//! Functions of nodes with their gradients at points, as sparse rows: what a discretisation is to a mechanics that does
//! not ask how it was made. Finite elements, reproducing kernels and smoothed particles fill the same [`Space`].

mod bins;
mod cloud;
mod factor;
mod finite_elements;
mod given;
mod mesh;
mod particles;
mod places;
mod reach;
mod reproducing;
mod samples;
mod shares;
mod sharing;

pub use bins::Bins;
pub use cloud::{BadCloud, Cloud, Patch};
pub use finite_elements::finite_elements;
pub use given::BadMesh;
pub use mesh::{BadPath, Mesh, Side, Sweep, cells_along};
pub use particles::{particles, particles_of_cloud};
pub use places::{contains, fit, row_of_mesh};
pub use reach::Supports;
pub use reproducing::{
    Functions, Integration, Kernel, Refused, Reproducing, Row, Shape, Sides, reproducing,
};
pub use samples::{Samples, Value};
pub use sharing::{Shared, Sharing};

use std::ops::Range;

/// Number of coordinates of a model, and what the missing ones mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// x and z, a metre deep; plane strain, or a sheet.
    Plane,
    /// The radius x and z.
    Axisymmetric,
    /// x, y and z.
    Solid,
}

impl Form {
    /// The coordinates in which nodes move.
    pub fn axes(self) -> &'static [usize] {
        match self {
            Form::Plane | Form::Axisymmetric => &[0, 2],
            Form::Solid => &[0, 1, 2],
        }
    }

    /// Length or circumference across the plane of a model per area in it, at a place.
    pub fn depth(self, at: [f64; 3]) -> f64 {
        match self {
            Form::Plane | Form::Solid => 1.0,
            Form::Axisymmetric => 2.0 * std::f64::consts::PI * at[0],
        }
    }
}

/// A discretised body in its reference configuration.
#[derive(Debug, Clone)]
pub struct Space {
    pub form: Form,
    /// Order of finite elements; 1 of other functions.
    pub order: usize,
    /// X of each node [m].
    pub nodes: Vec<[f64; 3]>,
    /// Points of the volume.
    pub volume: Samples,
    /// Points of the volume that share a dilatation, in their order; none shared if each is alone.
    pub groups: Vec<Range<usize>>,
    /// How the dilatation that the points of a group share follows from their own.
    pub sharing: Sharing,
    /// Points of the boundary.
    pub boundary: Boundary,
    /// Functions at the nodes; `None` if each is one at its own node and zero at the others.
    pub at_nodes: Option<Samples>,
    /// Fraction of the volume that each node represents, by which mass is lumped [m³].
    pub shares: Vec<f64>,
    /// Nodes that share an edge of the mesh, each pair once or more.
    pub links: Vec<[u32; 2]>,
}

impl Space {
    /// Weight of a point in the mean about a node, from the node's function there: positive, also where functions of
    /// quadratic elements are not.
    pub fn influence(&self, value: f64) -> f64 {
        if self.order == 1 { value } else { value * value }
    }

    /// The same with one dilatation for as many consecutive points, those of a cell.
    pub fn with_points_together(mut self, of_cell: usize) -> Self {
        let cells = self.volume.len() / of_cell;
        self.groups = (0..cells).map(|n| of_cell * n..of_cell * (n + 1)).collect();
        self.sharing = Sharing::Mean;
        self
    }

    /// The same with a dilatation of its own at each point.
    pub fn with_points_alone(mut self) -> Self {
        self.groups = (0..self.volume.len()).map(|point| point..point + 1).collect();
        self.sharing = Sharing::Mean;
        self
    }
}

/// Points of a boundary; their weights are areas.
#[derive(Debug, Clone, Default)]
pub struct Boundary {
    pub samples: Samples,
    /// Outward unit normal of each.
    pub normals: Vec<[f64; 3]>,
    /// Side to which each belongs.
    pub sides: Vec<Side>,
}

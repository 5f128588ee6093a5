//! Structured meshes: products of three axes, with layers along the last.

mod axis;
mod layering;

use std::ops::Range;

pub use axis::{Axis, ShapeAt, Weight};
pub use layering::Layering;

use crate::scene::FaceName;

/// A structured mesh as the product of three axes; the x index of a node runs fastest.
///
/// In axisymmetry the axes are the radius, a point and z. Where an axis is `mirrored`, the mesh
/// covers the half from its symmetry plane at 0 to the high end of the body. Displacements belong
/// to nodes. Temperatures and stresses belong to sided nodes: nodes on interfaces between layers
/// are doubled, the one of the layer below first.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    pub axes: [Axis; 3],
    pub mirrored: [bool; 2],
    pub geometry: Geometry,
    pub layering: Layering,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Geometry {
    Box,
    Axisymmetric,
}

impl Geometry {
    /// Displacement components of a node: 3 in a box, 2 (r, z) in axisymmetry.
    pub fn degrees(self) -> usize {
        match self {
            Geometry::Box => 3,
            Geometry::Axisymmetric => 2,
        }
    }
}

/// An end of an axis of the mesh, on which faces of the body lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshFace {
    pub axis: usize,
    pub high: bool,
}

/// Symmetry class of a part of the solution: antisymmetric (odd) or symmetric (even) about the
/// planes x = 0 and y = 0.
///
/// Even means equal to the mirror image: scalars equal, the normal component of vectors opposite.
/// Odd is minus that. Every field is the sum of its parts, and linear physics does not couple them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Parity {
    pub odd: [bool; 2],
}

impl Mesh {
    pub fn node_counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|a| self.axes[a].len())
    }

    pub fn nodes(&self) -> usize {
        self.node_counts().into_iter().fold(1, usize::saturating_mul)
    }

    /// Number of sided nodes along each axis.
    pub fn sided_counts(&self) -> [usize; 3] {
        let [nx, ny, nz] = self.node_counts();
        [nx, ny, nz + self.layering.interfaces()]
    }

    /// Number of sided nodes.
    pub fn sided_nodes(&self) -> usize {
        self.sided_counts().into_iter().fold(1, usize::saturating_mul)
    }

    /// Node along z of each sided node, ascending.
    pub fn nodes_of_sided(&self) -> Vec<usize> {
        let order = self.axes[2].order;
        let of_layer = |layer: usize| {
            let elements = self.layer_elements(layer);
            elements.start * order..elements.end * order + 1
        };
        (0..self.layering.count()).flat_map(of_layer).collect()
    }

    /// Elements along z of a layer, counted from the lowest.
    pub fn layer_elements(&self, layer: usize) -> Range<usize> {
        self.layering.elements(layer, self.axes[2].elements())
    }

    /// The axis along z within a layer.
    pub fn layer_axis(&self, layer: usize) -> Axis {
        let Range { start, end } = self.layer_elements(layer);
        let order = self.axes[2].order;
        let nodes = self.axes[2].nodes[start * order..=end * order].to_vec();
        Axis { nodes, order, weight: Weight::Uniform }
    }

    /// The mesh of a layer alone.
    pub fn layer_mesh(&self, layer: usize) -> Self {
        let [x, y, _] = self.axes.clone();
        let axes = [x, y, self.layer_axis(layer)];
        Self { axes, layering: Layering::default(), ..*self }
    }

    /// Shape functions along z of the sided nodes, in one element.
    pub fn sided_shape_in(&self, element: usize, z: f64) -> ShapeAt {
        let shape = self.axes[2].shape_in(element, z);
        ShapeAt { first: shape.first + self.layering.layer_of(element), ..shape }
    }

    /// Shape functions along z of the sided nodes at a place; on an interface those of the layer
    /// above.
    pub fn sided_shape_at(&self, z: f64) -> ShapeAt {
        let shape = self.axes[2].shape_at(z);
        let element = shape.first / self.axes[2].order;
        ShapeAt { first: shape.first + self.layering.layer_of(element), ..shape }
    }

    pub fn element_counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|a| self.axes[a].elements())
    }

    pub fn order(&self) -> usize {
        self.axes[0].order
    }

    /// Number of copies of the mesh that form the body.
    pub fn copies(&self) -> f64 {
        self.mirrored.iter().map(|&m| if m { 2.0 } else { 1.0 }).product()
    }

    /// The symmetry classes of a solution: one, two or four.
    pub fn parities(&self) -> Vec<Parity> {
        let choices = |mirrored: bool| if mirrored { vec![false, true] } else { vec![false] };
        let mut list = Vec::new();
        for odd_y in choices(self.mirrored[1]) {
            for odd_x in choices(self.mirrored[0]) {
                list.push(Parity { odd: [odd_x, odd_y] });
            }
        }
        list
    }

    /// Nodes along x (0) or y (1) over the whole body, as `(node, is_image)`, by ascending
    /// coordinate.
    pub fn unfolded(&self, axis: usize) -> Vec<(usize, bool)> {
        let own = (0..self.axes[axis].len()).map(|i| (i, false));
        if !self.mirrored[axis] {
            return own.collect();
        }
        (1..self.axes[axis].len()).rev().map(|i| (i, true)).chain(own).collect()
    }

    /// Position of a face of the body on the mesh, and whether it is the mirror image of that
    /// position.
    pub fn place(&self, face: FaceName) -> (MeshFace, bool) {
        let (axis, high) = match face {
            FaceName::Left => (0, false),
            FaceName::Right | FaceName::Sides => (0, true),
            FaceName::Front => (1, false),
            FaceName::Back => (1, true),
            FaceName::Bottom => (2, false),
            FaceName::Top => (2, true),
        };
        let image = axis < 2 && self.mirrored[axis] && !high;
        (MeshFace { axis, high: high || image }, image)
    }

    /// Position of a point of the body on the mesh, and the axes along which it was mirrored. In
    /// axisymmetry the first coordinate is the radius.
    pub fn locate(&self, point: [f64; 3]) -> ([f64; 3], [bool; 2]) {
        let [x, y, z] = point;
        match self.geometry {
            Geometry::Axisymmetric => ([x.hypot(y), 0.0, z], [false; 2]),
            Geometry::Box => {
                let image = [self.mirrored[0] && x < 0.0, self.mirrored[1] && y < 0.0];
                let fold = |value: f64, mirrored: bool| if mirrored { value.abs() } else { value };
                ([fold(x, self.mirrored[0]), fold(y, self.mirrored[1]), z], image)
            }
        }
    }
}

impl Parity {
    /// Sign of a scalar of this class at the image of a point.
    pub fn sign(&self, image: [bool; 2]) -> f64 {
        (0..2).map(|a| if self.odd[a] && image[a] { -1.0 } else { 1.0 }).product()
    }

    /// Sign of the component `i` of a vector of this class at the image of a point.
    pub fn vector_sign(&self, image: [bool; 2], i: usize) -> f64 {
        let flip = if i < 2 && image[i] { -1.0 } else { 1.0 };
        self.sign(image) * flip
    }

    /// Sign of a tensor component (xx, yy, zz, xy, yz, xz) of this class at the image of a point.
    pub fn tensor_sign(&self, image: [bool; 2], component: usize) -> f64 {
        let (i, j) = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)][component];
        self.sign(image) * self.vector_sign(image, i) * self.vector_sign(image, j)
    }

    pub fn is_even(&self) -> bool {
        self.odd == [false; 2]
    }
}

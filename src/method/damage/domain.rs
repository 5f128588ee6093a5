//! Multilinear quadrilaterals of a section, or hexahedra in space, with two Gauss points along each axis.

use std::f64::consts::TAU;

use crate::laws::fracture::{InPlane, InSpace, PrincipalAxes};
use crate::math::grid_matrix::Grid;

/// Places of the two-point Gauss rule on [0, 1]: ½ ∓ 1/√12.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Body that a domain represents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// No strain along the normal of a plane section; thickness [m].
    PlaneStrain { thickness: f64 },
    /// No stress along that normal.
    PlaneStress { thickness: f64 },
    /// A meridian section, whose first axis is the radius.
    Axisymmetric,
    /// A body in space.
    Space,
}

/// A plane section (`D = 2`) or a body in space (`D = 3`): the product of its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain<const D: usize> {
    /// Coordinates of nodes along x (or r) and z, or along x, y and z [m], ascending.
    pub axes: [Vec<f64>; D],
    pub form: Form,
    /// True for axes that begin at a plane of symmetry; their first element is half of one that stands across it.
    pub mirrored: [bool; D],
}

/// A quadrature point of an element of `C` corners.
#[derive(Debug, Clone, Copy)]
pub struct Point<const D: usize, const C: usize> {
    /// Volume that it represents [m³].
    pub volume: f64,
    /// Values of the shape functions, and their derivatives along all axes [1/m].
    pub shape: [f64; C],
    pub slopes: [[f64; C]; D],
    /// `1/r` of a meridian section, otherwise 0 [1/m].
    pub curvature: f64,
}

/// Strain with engineering shear, of `V` components, from displacements.
pub trait Kinematics<const D: usize, const C: usize, const V: usize> {
    type Axes: PrincipalAxes<V>;

    /// Strain of displacements of the corners.
    fn strain(&self, u: &[[f64; D]; C]) -> [f64; V];

    /// Strains of a unit displacement of a corner along each axis.
    fn unit_strains(&self, corner: usize) -> [[f64; V]; D];

    /// Stress as xx, yy, zz, xy, yz and xz, where the normal of a section is y.
    fn in_space(stress: [f64; V]) -> [f64; 6];
}

impl<const D: usize, const C: usize> Point<D, C> {
    /// Value of a nodal field.
    pub fn interpolate(&self, nodal: &[f64; C]) -> f64 {
        (0..C).map(|a| self.shape[a] * nodal[a]).sum()
    }

    /// Gradient of a nodal field.
    pub fn gradient(&self, nodal: &[f64; C]) -> [f64; D] {
        self.slopes.map(|slopes| (0..C).map(|a| slopes[a] * nodal[a]).sum())
    }
}

impl Kinematics<2, 4, 4> for Point<2, 4> {
    type Axes = InPlane;

    fn strain(&self, u: &[[f64; 2]; 4]) -> [f64; 4] {
        let mut strain = [0.0; 4];
        for (a, [ux, uz]) in u.iter().enumerate() {
            let [dx, dz] = [self.slopes[0][a], self.slopes[1][a]];
            strain[0] += dx * ux;
            strain[1] += dz * uz;
            strain[2] += self.curvature * self.shape[a] * ux;
            strain[3] += dz * ux + dx * uz;
        }
        strain
    }

    fn unit_strains(&self, corner: usize) -> [[f64; 4]; 2] {
        let [dx, dz] = [self.slopes[0][corner], self.slopes[1][corner]];
        [[dx, 0.0, self.curvature * self.shape[corner], dz], [0.0, dz, 0.0, dx]]
    }

    /// The normal of a plane section is y, that of a meridian section the hoop.
    fn in_space([first, second, third, shear]: [f64; 4]) -> [f64; 6] {
        [first, third, second, 0.0, 0.0, shear]
    }
}

impl Kinematics<3, 8, 6> for Point<3, 8> {
    type Axes = InSpace;

    fn strain(&self, u: &[[f64; 3]; 8]) -> [f64; 6] {
        let mut strain = [0.0; 6];
        for (a, [ux, uy, uz]) in u.iter().enumerate() {
            let [dx, dy, dz] = self.slopes.map(|slopes| slopes[a]);
            strain[0] += dx * ux;
            strain[1] += dy * uy;
            strain[2] += dz * uz;
            strain[3] += dy * ux + dx * uy;
            strain[4] += dz * uy + dy * uz;
            strain[5] += dz * ux + dx * uz;
        }
        strain
    }

    fn unit_strains(&self, corner: usize) -> [[f64; 6]; 3] {
        let [dx, dy, dz] = self.slopes.map(|slopes| slopes[corner]);
        [[dx, 0.0, 0.0, dy, 0.0, dz], [0.0, dy, 0.0, dx, dz, 0.0], [0.0, 0.0, dz, 0.0, dy, dx]]
    }

    fn in_space(stress: [f64; 6]) -> [f64; 6] {
        stress
    }
}

impl<const D: usize> Domain<D> {
    pub fn grid(&self) -> Grid<D> {
        Grid { counts: self.axes.each_ref().map(Vec::len) }
    }

    /// Lengths of the edges of an element [m].
    pub fn size(&self, element: [usize; D]) -> [f64; D] {
        std::array::from_fn(|axis| {
            let nodes: &[f64] = &self.axes[axis];
            nodes[element[axis] + 1] - nodes[element[axis]]
        })
    }

    /// Size of an element across a crack [m]: the geometric mean of its edges, which planes of symmetry do not halve.
    pub fn mean_size(&self, element: [usize; D]) -> f64 {
        let is_half = |axis: &usize| self.mirrored[*axis] && element[*axis] == 0;
        let parts = 1 << (0..D).filter(is_half).count();
        let volume = f64::from(parts) * self.size(element).iter().product::<f64>();
        if D == 2 { volume.sqrt() } else { volume.cbrt() }
    }

    /// Place of a node [m].
    pub fn place(&self, node: usize) -> [f64; D] {
        let position = self.grid().position(node);
        std::array::from_fn(|axis| self.axes[axis][position[axis]])
    }

    pub fn points<const C: usize>(&self, element: [usize; D]) -> [Point<D, C>; C] {
        let size = self.size(element);
        let per_length = size.map(|size| 1.0 / size);
        let start = self.axes[0][element[0]];
        let area: f64 = size.iter().map(|size| 0.5 * size).product();
        std::array::from_fn(|q| {
            let radius = start + GAUSS[q & 1] * size[0];
            let (depth, curvature) = match self.form {
                Form::PlaneStrain { thickness } | Form::PlaneStress { thickness } => {
                    (thickness, 0.0)
                }
                Form::Axisymmetric => (TAU * radius, 1.0 / radius),
                Form::Space => (1.0, 0.0),
            };
            Point {
                volume: area * depth,
                shape: Unit::<D, C>::SHAPE[q],
                slopes: std::array::from_fn(|axis| {
                    Unit::<D, C>::SLOPES[q][axis].map(|slope| per_length[axis] * slope)
                }),
                curvature,
            }
        })
    }
}

/// The element whose edges have the length 1.
struct Unit<const D: usize, const C: usize>;

impl<const D: usize, const C: usize> Unit<D, C> {
    /// Values of the functions of all corners at each point, and their derivatives along each axis.
    const SHAPE: [[f64; C]; C] = {
        let mut shape = [[1.0; C]; C];
        let mut place = 0;
        while place < C * C * D {
            let (q, a, axis) = (place / (C * D), place / D % C, place % D);
            shape[q][a] *= Self::along(q, a, axis);
            place += 1;
        }
        shape
    };
    const SLOPES: [[[f64; C]; D]; C] = {
        let mut slopes = [[[1.0; C]; D]; C];
        let mut place = 0;
        while place < C * C * D * D {
            let (q, a) = (place / (C * D * D), place / (D * D) % C);
            let (axis, other) = (place / D % D, place % D);
            slopes[q][axis][a] *= match (axis == other, a >> axis & 1) {
                (false, _) => Self::along(q, a, other),
                (true, 1) => 1.0,
                (true, _) => -1.0,
            };
            place += 1;
        }
        slopes
    };

    /// Value of the function of a corner along an axis, at a point.
    const fn along(point: usize, corner: usize, axis: usize) -> f64 {
        let at = GAUSS[point >> axis & 1];
        if corner >> axis & 1 == 1 { at } else { 1.0 - at }
    }
}

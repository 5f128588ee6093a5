//! Bilinear quadrilaterals of a section, with four Gauss points each.

use std::f64::consts::TAU;

use crate::laws::fracture::Components;
use crate::math::nine_point::Grid;

/// Number of quadrature points of an element.
pub const POINTS: usize = 4;

/// Places of the two-point Gauss rule on [0, 1]: ½ ∓ 1/√12.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Body that a section represents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// No strain along the normal of a plane section; thickness [m].
    PlaneStrain { thickness: f64 },
    /// No stress along that normal.
    PlaneStress { thickness: f64 },
    /// A meridian section, whose first axis is the radius.
    Axisymmetric,
}

/// A section: the product of two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Coordinates of nodes along the first axis (x or r) and along z [m], ascending.
    pub axes: [Vec<f64>; 2],
    pub form: Form,
}

/// A quadrature point of an element.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Volume that it represents [m³].
    pub volume: f64,
    /// Values of the four shape functions, and their derivatives along both axes [1/m].
    pub shape: [f64; 4],
    pub slopes: [[f64; 4]; 2],
    /// `1/r` of a meridian section, otherwise 0 [1/m].
    pub curvature: f64,
}

impl Point {
    /// Value of a nodal field.
    pub fn interpolate(&self, nodal: &[f64; 4]) -> f64 {
        (0..4).map(|a| self.shape[a] * nodal[a]).sum()
    }

    /// Gradient of a nodal field.
    pub fn gradient(&self, nodal: &[f64; 4]) -> [f64; 2] {
        self.slopes.map(|slopes| (0..4).map(|a| slopes[a] * nodal[a]).sum())
    }

    /// Strain with engineering shear of displacements, whose two components of a corner are together.
    pub fn strain(&self, u: &[f64; 8]) -> Components {
        let mut strain = [0.0; 4];
        for a in 0..4 {
            let ([dx, dz], [ux, uz]) =
                ([self.slopes[0][a], self.slopes[1][a]], [u[2 * a], u[2 * a + 1]]);
            strain[0] += dx * ux;
            strain[1] += dz * uz;
            strain[2] += self.curvature * self.shape[a] * ux;
            strain[3] += dz * ux + dx * uz;
        }
        strain
    }

    /// Strain of a unit displacement of a corner along each axis.
    pub fn unit_strains(&self, corner: usize) -> [Components; 2] {
        let [dx, dz] = [self.slopes[0][corner], self.slopes[1][corner]];
        [[dx, 0.0, self.curvature * self.shape[corner], dz], [0.0, dz, 0.0, dx]]
    }
}

impl Section {
    pub fn grid(&self) -> Grid {
        Grid { counts: [self.axes[0].len(), self.axes[1].len()] }
    }

    /// Lengths of the edges of an element [m].
    pub fn size(&self, element: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let nodes: &[f64] = &self.axes[axis];
            nodes[element[axis] + 1] - nodes[element[axis]]
        })
    }

    pub fn points(&self, element: [usize; 2]) -> [Point; POINTS] {
        let size = self.size(element);
        let per_length = size.map(|size| 1.0 / size);
        let start = self.axes[0][element[0]];
        std::array::from_fn(|q| {
            let at = [GAUSS[q % 2], GAUSS[q / 2]];
            let along = |axis: usize, a: usize| match [a % 2, a / 2][axis] {
                1 => (at[axis], per_length[axis]),
                _ => (1.0 - at[axis], -per_length[axis]),
            };
            let both: [[(f64, f64); 2]; 4] = std::array::from_fn(|a| [along(0, a), along(1, a)]);
            let radius = start + at[0] * size[0];
            let (depth, curvature) = match self.form {
                Form::PlaneStrain { thickness } | Form::PlaneStress { thickness } => {
                    (thickness, 0.0)
                }
                Form::Axisymmetric => (TAU * radius, 1.0 / radius),
            };
            Point {
                volume: 0.25 * size[0] * size[1] * depth,
                shape: both.map(|[x, z]| x.0 * z.0),
                slopes: [both.map(|[x, z]| x.1 * z.0), both.map(|[x, z]| x.0 * z.1)],
                curvature,
            }
        })
    }
}

//! Strains at quadrature points from nodal displacements, and nodal forces from stresses there, for many elements of
//! one row at once.

use faer::{Mat, MatRef};

use super::ring::Ring;
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::{shape, slope};
use crate::math::product::product;
use crate::method::fem::{Geometry, Mesh};

/// Elements with nodes and quadrature points, r or x fastest in both.
///
/// Vectors of elements have all displacements along x (r), then along y, then along z, element after element.
pub struct Shapes {
    /// Number of displacement components of a node.
    pub degrees: usize,
    /// Number of nodes of an element.
    pub nodes: usize,
    /// Number of quadrature points of an element.
    pub points: usize,
    /// Local coordinates and product of weights of each point.
    pub places: Vec<([f64; 3], f64)>,
    /// Lengths of elements along each axis [m]; one of length 1 for a missing axis.
    lengths: [Vec<f64>; 3],
    kind: Kind,
    /// Values of shape functions: a row per point, a column per node.
    values: Mat<f64>,
}

enum Kind {
    Brick(Brick),
    Ring(Ring),
}

/// Derivatives of shape functions along the three local axes: rows 3 q + k of points q, a column per node.
struct Brick {
    slopes: Mat<f64>,
}

/// Work space for strains and forces.
#[derive(Default)]
pub struct Scratch {
    gradients: Vec<f64>,
}

impl Shapes {
    pub fn new(mesh: &Mesh) -> Self {
        let order = mesh.order();
        let n = order + 1;
        let lengths = mesh.axes.each_ref().map(|axis| match axis.elements() {
            0 => vec![1.0],
            count => (0..count).map(|e| axis.bounds(e)).map(|[a, b]| b - a).collect(),
        });
        let is_box = mesh.geometry == Geometry::Box;
        // Because of the weight r, a ring has one more point per direction, as in elasticity.
        let gauss = gauss_legendre(if is_box { n } else { n + 1 });
        let mut places = Vec::new();
        for &(zeta, wz) in &gauss {
            for &(eta, wy) in if is_box { &gauss[..] } else { &[(0.0, 1.0)] } {
                for &(xi, wx) in &gauss {
                    places.push(([xi, eta, zeta], wx * wy * wz));
                }
            }
        }
        let nodes = if is_box { n * n * n } else { n * n };
        let split =
            |a: usize| if is_box { [a % n, a / n % n, a / (n * n)] } else { [a % n, 0, a / n] };
        let along =
            |axis: usize, xi: f64, i: usize, derived: bool| match (is_box || axis != 1, derived) {
                (false, _) => 1.0,
                (true, true) => slope(order, xi)[i],
                (true, false) => shape(order, xi)[i],
            };
        let value = |q: usize, a: usize, derived: Option<usize>| -> f64 {
            let (at, node) = (places[q].0, split(a));
            (0..3).map(|k| along(k, at[k], node[k], derived == Some(k))).product()
        };
        let values = Mat::from_fn(places.len(), nodes, |q, a| value(q, a, None));
        let kind = match is_box {
            true => Kind::Brick(Brick {
                slopes: Mat::from_fn(3 * places.len(), nodes, |row, a| {
                    value(row / 3, a, Some(row % 3))
                }),
            }),
            false => {
                let table = |k| Mat::from_fn(places.len(), nodes, |q, a| value(q, a, Some(k)));
                Kind::Ring(Ring::new(mesh, values.clone(), [table(0), table(2)]))
            }
        };
        let (degrees, points) = (mesh.geometry.degrees(), places.len());
        Self { degrees, nodes, points, places, lengths, kind, values }
    }

    /// Number of elements along each axis.
    pub fn counts(&self) -> [usize; 3] {
        self.lengths.each_ref().map(Vec::len)
    }

    /// Edges of an element [m].
    pub fn size(&self, element: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.lengths[axis][element[axis]])
    }

    /// Volume that each point of an element represents, including whole circles [m³].
    pub fn volumes(&self, element: [usize; 3]) -> Vec<f64> {
        match &self.kind {
            Kind::Brick(_) => {
                let volume: f64 = self.size(element).iter().product();
                self.places.iter().map(|(_, weight)| weight * volume / 8.0).collect()
            }
            Kind::Ring(ring) => {
                let [width, _, height] = self.size(element);
                let circle = |q: usize| ring.circle(element[0], q);
                let weights = self.places.iter().enumerate();
                weights.map(|(q, (_, w))| w * width * height / 4.0 * circle(q)).collect()
            }
        }
    }

    /// Values of a nodal scalar at the points of an element.
    pub fn interpolate(&self, nodal: &[f64], out: &mut [f64]) {
        for (q, value) in out.iter_mut().enumerate() {
            *value = (0..self.nodes).map(|a| self.values[(q, a)] * nodal[a]).sum();
        }
    }

    /// Strains xx, yy, zz, xy, yz, xz (rr, tt, zz, 0, 0, rz) at the points of some elements.
    pub fn strains(
        &self,
        elements: &[[usize; 3]],
        u: &[f64],
        out: &mut [[f64; 6]],
        scratch: &mut Scratch,
    ) {
        match &self.kind {
            Kind::Ring(ring) => {
                for ((element, u), out) in elements
                    .iter()
                    .zip(u.chunks_exact(2 * self.nodes))
                    .zip(out.chunks_exact_mut(self.points))
                {
                    ring.strains(element[0], self.size(*element), u, out);
                }
            }
            Kind::Brick(brick) => {
                let rows = 3 * self.points;
                let gradients = &mut scratch.gradients;
                gradients.resize(rows * 3 * elements.len(), 0.0);
                let u = MatRef::from_column_major_slice(u, self.nodes, 3 * elements.len());
                product(gradients, brick.slopes.as_ref(), u);
                for ((element, g), out) in elements
                    .iter()
                    .zip(gradients.chunks_exact(3 * rows))
                    .zip(out.chunks_exact_mut(self.points))
                {
                    let scale = self.size(*element).map(|h| 2.0 / h);
                    for (q, strain) in out.iter_mut().enumerate() {
                        let d = |c: usize, k: usize| g[c * rows + 3 * q + k] * scale[k];
                        *strain = [
                            d(0, 0),
                            d(1, 1),
                            d(2, 2),
                            d(0, 1) + d(1, 0),
                            d(1, 2) + d(2, 1),
                            d(0, 2) + d(2, 0),
                        ];
                    }
                }
            }
        }
    }

    /// Nodal forces of stresses times volumes at the points of some elements: the adjoint of [`Self::strains`].
    pub fn forces(
        &self,
        elements: &[[usize; 3]],
        stress: &[[f64; 6]],
        out: &mut [f64],
        scratch: &mut Scratch,
    ) {
        match &self.kind {
            Kind::Ring(ring) => {
                for ((element, out), stress) in elements
                    .iter()
                    .zip(out.chunks_exact_mut(2 * self.nodes))
                    .zip(stress.chunks_exact(self.points))
                {
                    ring.forces(element[0], self.size(*element), stress, out);
                }
            }
            Kind::Brick(brick) => {
                let rows = 3 * self.points;
                let gradients = &mut scratch.gradients;
                gradients.resize(rows * 3 * elements.len(), 0.0);
                for ((element, g), stress) in elements
                    .iter()
                    .zip(gradients.chunks_exact_mut(3 * rows))
                    .zip(stress.chunks_exact(self.points))
                {
                    let [x, y, z] = self.size(*element).map(|h| 2.0 / h);
                    for (q, s) in stress.iter().enumerate() {
                        let rows_of = [
                            [s[0] * x, s[3] * y, s[5] * z],
                            [s[3] * x, s[1] * y, s[4] * z],
                            [s[5] * x, s[4] * y, s[2] * z],
                        ];
                        for (c, row) in rows_of.iter().enumerate() {
                            g[c * rows + 3 * q..][..3].copy_from_slice(row);
                        }
                    }
                }
                let g = MatRef::from_column_major_slice(gradients, rows, 3 * elements.len());
                product(out, brick.slopes.transpose(), g);
            }
        }
    }
}

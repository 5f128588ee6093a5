//! Values at points and their recovery at nodes.
//!
//! Values at the quadrature points of an element are fitted by a polynomial of one order less and evaluated at the
//! sampling points. This omits the part in which strains of Lagrange elements are least accurate. From there they are
//! recovered at the nodes like elastic strains (see `recovery` of [`crate::method::fem`]).

use faer::Mat;

use super::element::Given;
use super::grid::{Grid, Iterate};
use super::problem::{InelasticProblem, PointState};
use super::shapes::Scratch;
use crate::laws::{PointConstants, Relaxation};
use crate::math::gauss::gauss_legendre;
use crate::math::separable::{Side, transform};
use crate::method::fem::recovery::{Beyond, Recovery};
use crate::method::fem::{Geometry, Mesh};
use crate::runtime::parallel::Team;

impl Grid {
    /// Returns all points under the displacements of an iterate, with their present histories; `relaxation` is that of
    /// each layer.
    pub fn read(
        &self,
        team: &Team,
        (constants, relaxation): (&[PointConstants], &[Option<&Relaxation>]),
        history: &[f64],
        iterate: &Iterate,
    ) -> Vec<PointState> {
        let (points, modes) = (self.kit.shapes.points, self.kit.treatment.modes());
        let layers = team.map(self.layers(), |layer| {
            let (mut scratch, mut u, mut out) = (Scratch::default(), Vec::new(), Vec::new());
            for (first, elements) in self.batches(layer) {
                self.gather(&elements, &iterate.displacement, &mut u);
                let all = layer * self.per_layer() + first;
                let at = |each: usize| all * each..(all + elements.len()) * each;
                let given = Given {
                    elements: &elements,
                    displacement: &u,
                    amplitudes: &iterate.amplitudes[at(modes)],
                    constants: &constants[at(points)],
                    old: &history[at(points * self.kit.history)],
                    relaxation: relaxation[layer],
                };
                self.kit.read(&given, &mut scratch, &mut out);
            }
            out
        });
        layers.concat()
    }
}

impl InelasticProblem {
    /// Recovers a tensor at the nodes from its values at the points; nodes on interfaces between layers are listed
    /// twice.
    pub(super) fn recover_tensor(&self, values: Vec<[f64; 6]>) -> Vec<[f64; 6]> {
        let is_ring = self.mesh.geometry == Geometry::Axisymmetric;
        // On the axis rr and tt are equal: their mean is even, half their difference vanishes.
        let parted = |values: [f64; 6]| match (is_ring, values) {
            (true, [a, b, zz, xy, yz, xz]) => [0.5 * (a + b), 0.5 * (a - b), zz, xy, yz, xz],
            (false, values) => values,
        };
        let parted: Vec<[f64; 6]> = values.into_iter().map(parted).collect();
        let mut out = vec![[0.0; 6]; self.mesh.sided_nodes()];
        for component in 0..6 {
            if is_ring && (component == 3 || component == 4) {
                continue;
            }
            let values: Vec<f64> = parted.iter().map(|tensor| tensor[component]).collect();
            let beyond = [0, 1].map(|axis| self.beyond(axis, component));
            for (tensor, value) in out.iter_mut().zip(recover(&self.mesh, &values, beyond)) {
                tensor[component] = value;
            }
        }
        if is_ring {
            for tensor in &mut out {
                (tensor[0], tensor[1]) = (tensor[0] + tensor[1], tensor[0] - tensor[1]);
            }
        }
        out
    }

    /// Recovers a scalar, even about planes of symmetry like xx.
    pub(super) fn recover_scalar(&self, values: &[f64]) -> Vec<f64> {
        recover(&self.mesh, values, [0, 1].map(|axis| self.beyond(axis, 0)))
    }

    /// Continuation of a stress component beyond the low end of x or y.
    fn beyond(&self, axis: usize, component: usize) -> Beyond {
        match self.mesh.geometry {
            Geometry::Axisymmetric if axis == 0 && self.mesh.axes[0].start() == 0.0 => {
                match component {
                    1 => Beyond::Vanishing,
                    5 => Beyond::Odd,
                    _ => Beyond::Even,
                }
            }
            Geometry::Box if self.mesh.mirrored[axis] => {
                let shears = [[3, 5], [3, 4]][axis];
                if shears.contains(&component) { Beyond::Odd } else { Beyond::Even }
            }
            _ => Beyond::Nothing,
        }
    }
}

/// Recovers values at the nodes from those at the points of all elements, layer by layer: readings jump between layers.
fn recover(mesh: &Mesh, values: &[f64], beyond: [Beyond; 2]) -> Vec<f64> {
    let per_element = values.len() / mesh.element_counts()[2];
    let of_layer = |layer: usize| {
        let elements = mesh.layer_elements(layer);
        let values = &values[elements.start * per_element..elements.end * per_element];
        recover_layer(&mesh.layer_mesh(layer), values, beyond)
    };
    (0..mesh.layering.count()).flat_map(of_layer).collect()
}

fn recover_layer(mesh: &Mesh, values: &[f64], beyond: [Beyond; 2]) -> Vec<f64> {
    let per_axis = match mesh.geometry {
        Geometry::Box => mesh.order() + 1,
        Geometry::Axisymmetric => mesh.order() + 2,
    };
    let elements = mesh.element_counts();
    let points = elements.map(|count| if count == 0 { 1 } else { per_axis });
    let counts = [0, 1, 2].map(|a| points[a] * elements[a].max(1));
    // Points of the whole mesh in one sequence along each axis.
    let mut ordered = vec![0.0; values.len()];
    let of_element: usize = points.iter().product();
    for (e, values) in values.chunks_exact(of_element).enumerate() {
        let [nx, ny, _] = elements.map(|count| count.max(1));
        let element = [e % nx, e / nx % ny, e / (nx * ny)];
        for (q, value) in values.iter().enumerate() {
            let point = [q % points[0], q / points[0] % points[1], q / (points[0] * points[1])];
            let [i, j, k] = [0, 1, 2].map(|a| element[a] * points[a] + point[a]);
            ordered[i + counts[0] * (j + counts[1] * k)] = *value;
        }
    }
    let matrices = [0, 1, 2].map(|axis| {
        let beyond = if axis < 2 { beyond[axis] } else { Beyond::Nothing };
        let recovery = Recovery::new(&mesh.axes[axis], beyond, [false; 2]).samples;
        match elements[axis] {
            0 => recovery,
            count => through(&recovery, &fit(mesh.order(), per_axis), count),
        }
    });
    transform(&ordered, matrices.each_ref(), Side::Direct)
}

/// Values at the Gauss points of an order from those at more points, by the best-fitting polynomial.
fn fit(order: usize, points: usize) -> Mat<f64> {
    let legendre = |degree: usize, x: f64| if degree == 0 { 1.0 } else { x };
    let (to, from) = (gauss_legendre(order), gauss_legendre(points));
    Mat::from_fn(order, points, |i, j| {
        let (x, (y, w)) = (to[i].0, from[j]);
        (0..order).map(|d| (2 * d + 1) as f64 / 2.0 * legendre(d, x) * legendre(d, y) * w).sum()
    })
}

/// Product of the recovery and the fit of every element.
fn through(recovery: &Mat<f64>, fit: &Mat<f64>, elements: usize) -> Mat<f64> {
    let (order, points) = (fit.nrows(), fit.ncols());
    Mat::from_fn(recovery.nrows(), elements * points, |node, p| {
        let (element, point) = (p / points, p % points);
        (0..order).map(|i| recovery[(node, element * order + i)] * fit[(i, point)]).sum()
    })
}

//! Transpose of the thermal forces: from displacements to the work per kelvin of each nodal temperature.

use super::ElasticProblem;
use crate::method::fem::brick_polynomials::{PolynomialModuli, legendre, moduli, slope_factor};
use crate::method::mesh::Geometry;
use crate::runtime::parallel;

impl ElasticProblem {
    /// Adds `Cᵀλ`, where `C T` are the thermal forces at constant strain. Each layer has temperatures of its own on
    /// interfaces.
    pub(super) fn add_thermal_row(&self, displacement: &[f64], row: &mut [f64]) {
        match self.mesh.geometry {
            Geometry::Box => self.add_rows_of_bricks(displacement, row),
            Geometry::Axisymmetric => self.add_rows_of_rings(displacement, row),
        }
    }

    fn add_rows_of_rings(&self, displacement: &[f64], row: &mut [f64]) {
        let [nx, ny, _] = self.mesh.node_counts();
        let mut rest = row;
        for (layer, matrix) in self.thermal().iter().enumerate() {
            let (own, above) = rest.split_at_mut(matrix.nodes());
            rest = above;
            let first = self.mesh.layer_elements(layer).start * self.mesh.order() * nx * ny;
            let degrees = self.degrees();
            let length = degrees * own.len();
            matrix.add_transposed_product(&displacement[degrees * first..][..length], own);
        }
    }

    /// Computes the rows of bricks without an assembled matrix. In products of Legendre polynomials each temperature
    /// does work only on the divergence of its own degrees (see [`crate::method::fem::brick_polynomials`]).
    fn add_rows_of_bricks(&self, displacement: &[f64], row: &mut [f64]) {
        let order = self.mesh.order();
        let [nx, ny, _] = self.mesh.node_counts();
        let plane = nx * ny;
        let of_layers: Vec<Vec<PolynomialModuli>> =
            self.laws.iter().map(|law| moduli(order, law)).collect();
        let elements = self.mesh.element_counts();
        let slabs = parallel::map(self.threads, elements[2], |k| {
            let layer = self.mesh.layering.layer_of(k);
            self.rows_of_slab(k, &of_layers[layer], displacement)
        });
        for (k, slab) in slabs.into_iter().enumerate() {
            let first = (k * order + self.mesh.layering.layer_of(k)) * plane;
            row[first..].iter_mut().zip(slab).for_each(|(row, own)| *row += own);
        }
    }

    /// Returns the rows of the nodes of a slab of elements along z.
    fn rows_of_slab(
        &self,
        slab: usize,
        moduli: &[PolynomialModuli],
        displacement: &[f64],
    ) -> Vec<f64> {
        let (order, [columns, rows, _]) = (self.mesh.order(), self.mesh.node_counts());
        let [nx, ny, _] = self.mesh.element_counts();
        let length = |axis: usize, e: usize| {
            let [low, high] = self.mesh.axes[axis].bounds(e);
            high - low
        };
        let (n, height) = (order + 1, length(2, slab));
        let base = slab * order * columns * rows;
        let mut out = vec![0.0; n * columns * rows];
        let mut values = vec![0.0; n * n * n];
        for ey in 0..ny {
            for ex in 0..nx {
                let size = [length(0, ex), length(1, ey), height];
                let node = |a: usize| {
                    let [i, j, k] = [a % n, a / n % n, a / (n * n)];
                    ex * order + i + columns * (ey * order + j + rows * k)
                };
                let components = [0, 1, 2].map(|c| {
                    for (a, value) in values.iter_mut().enumerate() {
                        *value = displacement[3 * (base + node(a)) + c];
                    }
                    coefficients(order, &values)
                });
                let work = thermal_work(order, size, moduli, &components);
                for (a, value) in from_coefficients(order, &work).into_iter().enumerate() {
                    out[node(a)] += value;
                }
            }
        }
        out
    }
}

/// Work per kelvin of each product of polynomials on displacements.
fn thermal_work(
    order: usize,
    size: [f64; 3],
    moduli: &[PolynomialModuli],
    displacement: &[Polynomials; 3],
) -> Polynomials {
    let n = order + 1;
    let volume: f64 = size.iter().product();
    let mut out = [0.0; 27];
    for (at, moduli) in moduli.iter().enumerate() {
        let mut divergence = 0.0;
        for (axis, (component, length)) in displacement.iter().zip(size).enumerate() {
            if moduli.degrees[axis] + 1 < n {
                let slope = slope_factor(moduli.degrees, axis) / length;
                divergence += slope * component[at + n.pow(axis as u32)];
            }
        }
        out[at] = moduli.norm * moduli.thermal * volume * divergence;
    }
    out
}

/// Coefficients of products of Legendre polynomials of an element, x fastest.
type Polynomials = [f64; 27];

fn coefficients(order: usize, nodal: &[f64]) -> Polynomials {
    let matrix = legendre(order);
    along_axes(order, nodal, |l, a| matrix[l][a])
}

/// The transpose of [`coefficients`].
fn from_coefficients(order: usize, values: &Polynomials) -> Vec<f64> {
    let (n, matrix) = (order + 1, legendre(order));
    along_axes(order, &values[..n * n * n], |a, l| matrix[l][a])[..n * n * n].to_vec()
}

/// Applies a matrix along each axis of an element.
fn along_axes(order: usize, values: &[f64], matrix: impl Fn(usize, usize) -> f64) -> Polynomials {
    let n = order + 1;
    let mut from = [0.0; 27];
    from[..values.len()].copy_from_slice(values);
    for stride in [1, n, n * n] {
        let mut to = [0.0; 27];
        for (at, target) in to.iter_mut().enumerate().take(n * n * n) {
            let l = at / stride % n;
            let first = at - l * stride;
            *target = (0..n).map(|a| matrix(l, a) * from[first + a * stride]).sum();
        }
        from = to;
    }
    from
}

//! Transpose of the strains at sampling points: from their weights to weights of nodal displacements and temperatures.

use std::collections::{BTreeMap, HashMap};

use super::influence::Gradient;
use super::{ElasticProblem, local};
use crate::method::fem::axisymmetric::QuadrilateralMatrices;
use crate::method::fem::dilatation::{DilatationProjection, POLYNOMIALS};
use crate::method::fem::recovery::sampling_places;
use crate::method::mesh::{Geometry, ShapeAt};

/// Weights of strains at sampling points by their numbers: xx, yy, zz, xy, yz, xz, in a section rr, tt, zz, rz.
pub type StrainWeights = BTreeMap<usize, [f64; 6]>;

impl ElasticProblem {
    /// Adds the derivatives of weighted strains, as computed by [`ElasticProblem::strains`].
    pub fn add_strain_rows(&self, samples: &StrainWeights, out: &mut Gradient) {
        match self.mesh.geometry {
            Geometry::Box => self.add_box_strain_rows(samples, out),
            Geometry::Axisymmetric => self.add_ring_strain_rows(samples, out),
        }
    }

    fn add_box_strain_rows(&self, samples: &StrainWeights, out: &mut Gradient) {
        let places = self.mesh.axes.each_ref().map(sampling_places);
        let [nx, ny, _] = self.mesh.element_counts();
        let mut projections: HashMap<usize, DilatationProjection> = HashMap::new();
        for (&number, weights) in samples {
            let [sx, sy] = [places[0].len(), places[1].len()];
            let at = [number % sx, number / sx % sy, number / (sx * sy)];
            let place = [0, 1, 2].map(|a| places[a][at[a]]);
            let shapes = [0, 1, 2].map(|a| self.mesh.axes[a].shape_in(place[a].0, place[a].1));
            let law = self.law_of(place[2].0);
            let mut strain = *weights;
            let mut rise = -law.layer_strain() * weights[2];
            if self.mesh.order() > 1 {
                let third = (weights[0] + weights[1] + weights[2]) / 3.0;
                strain[..3].iter_mut().for_each(|weight| *weight -= third);
                rise += third * 3.0 * law.expansion;
                let elements = place.map(|(element, _)| element);
                let number = elements[0] + nx * (elements[1] + ny * elements[2]);
                let projection =
                    projections.entry(number).or_insert_with(|| self.projection(elements));
                let [xi, eta, zeta] =
                    [0, 1, 2].map(|a| local(self.mesh.axes[a].bounds(place[a].0), place[a].1));
                let weights = [1.0, xi, eta, zeta].map(|value| third * value);
                self.add_dilatation_rows(elements, projection, weights, out);
            }
            let [x, y, _] = shapes;
            let sided = [x, y, self.mesh.sided_shape_in(place[2].0, place[2].1)];
            add_strain(&shapes, self.mesh.node_counts(), strain, &mut out.displacement);
            add_value(&sided, self.mesh.node_counts(), rise, &mut out.temperature);
        }
    }

    fn projection(&self, element: [usize; 3]) -> DilatationProjection {
        let size = [0, 1, 2].map(|a| {
            let [low, high] = self.mesh.axes[a].bounds(element[a]);
            high - low
        });
        DilatationProjection::new(self.mesh.order(), size)
    }

    /// Adds the derivatives of the projected `tr ε − 3 α ΔT` of an element.
    fn add_dilatation_rows(
        &self,
        element: [usize; 3],
        projection: &DilatationProjection,
        weights: [f64; POLYNOMIALS],
        out: &mut Gradient,
    ) {
        let [columns, rows, _] = self.mesh.node_counts();
        let order = self.mesh.order();
        let n = order + 1;
        let layer = self.mesh.layering.layer_of(element[2]);
        let expansion = 3.0 * self.laws[layer].expansion;
        let weights: [f64; POLYNOMIALS] = std::array::from_fn(|m| weights[m] / projection.norm[m]);
        for (a, (gradient, value)) in projection.gradient.iter().zip(&projection.value).enumerate()
        {
            let at = [a % n, a / n % n, a / (n * n)];
            let [i, j, k] = [0, 1, 2].map(|axis| element[axis] * order + at[axis]);
            let node = i + columns * (j + rows * k);
            let sum = |list: &[f64; POLYNOMIALS]| -> f64 {
                weights.iter().zip(list).map(|(weight, value)| weight * value).sum()
            };
            for (direction, gradient) in gradient.iter().enumerate() {
                out.displacement[3 * node + direction] += sum(gradient);
            }
            out.temperature[node + layer * columns * rows] -= expansion * sum(value);
        }
    }

    fn add_ring_strain_rows(&self, samples: &StrainWeights, out: &mut Gradient) {
        let [radii, _, heights] = &self.mesh.axes;
        let (places_r, places_z) = (sampling_places(radii), sampling_places(heights));
        let counts = self.mesh.node_counts();
        let mut elements: HashMap<[usize; 2], QuadrilateralMatrices> = HashMap::new();
        for (&number, weights) in samples {
            let (er, r) = places_r[number % places_r.len()];
            let (ez, z) = places_z[number / places_r.len()];
            let element = elements.entry([er, ez]).or_insert_with(|| self.ring(er, ez));
            let nodes = self.ring_nodes(er, ez);
            let planes_below = self.mesh.layering.layer_of(ez) * radii.len();
            let (xi, eta) = (local(radii.bounds(er), r), local(heights.bounds(ez), z));
            // Strains are linear: a unit of each unknown gives its column.
            let mut units = vec![0.0; 3 * nodes.len()];
            for unknown in 0..units.len() {
                units[unknown] = 1.0;
                let (u, t) = units.split_at(2 * nodes.len());
                let strain = element.strain(xi, eta, u, t);
                let product: f64 = strain.iter().zip(weights).map(|(e, w)| e * w).sum();
                match unknown.checked_sub(2 * nodes.len()) {
                    None => {
                        out.displacement[2 * nodes[unknown / 2] + unknown % 2] += product;
                    }
                    Some(node) => out.temperature[nodes[node] + planes_below] += product,
                }
                units[unknown] = 0.0;
            }
            let shapes = [
                radii.shape_in(er, r),
                self.mesh.axes[1].shape_at(0.0),
                self.mesh.sided_shape_in(ez, z),
            ];
            let layer = self.law_of(ez).layer_strain();
            add_value(&shapes, counts, -layer * weights[2], &mut out.temperature);
        }
    }
}

/// Adds the derivatives of weighted strains by nodal displacements.
fn add_strain(
    [x, y, z]: &[ShapeAt; 3],
    counts: [usize; 3],
    [xx, yy, zz, xy, yz, xz]: [f64; 6],
    out: &mut [f64],
) {
    let weights = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    for c in 0..z.count {
        for b in 0..y.count {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c));
            for a in 0..x.count {
                let n = [
                    x.slopes[a] * y.values[b] * z.values[c],
                    x.values[a] * y.slopes[b] * z.values[c],
                    x.values[a] * y.values[b] * z.slopes[c],
                ];
                let u = &mut out[3 * (row + x.first + a)..][..3];
                for (target, weights) in u.iter_mut().zip(weights) {
                    *target += (0..3).map(|j| weights[j] * n[j]).sum::<f64>();
                }
            }
        }
    }
}

/// Adds the derivatives of a weighted scalar by its nodal values.
fn add_value([x, y, z]: &[ShapeAt; 3], counts: [usize; 3], weight: f64, out: &mut [f64]) {
    for c in 0..z.count {
        for b in 0..y.count {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c)) + x.first;
            let weight = weight * y.values[b] * z.values[c];
            for a in 0..x.count {
                out[row + a] += weight * x.values[a];
            }
        }
    }
}

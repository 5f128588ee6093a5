//! Recovery of strains: from their most accurate points to a continuous field.
//!
//! Strains of Lagrange elements of order p are one order more accurate at the p Gauss points along
//! each axis (J. Barlow 1976, doi 10.1002/nme.1620100202). On a structured mesh these form a grid of
//! their own. The value at a node is the polynomial through the nearest sampling points along each
//! axis, and values between nodes follow the shape functions, so the field is continuous
//! (cf. O. C. Zienkiewicz and J. Z. Zhu 1992, doi 10.1002/nme.1620330702).
//!
//! While heat has penetrated only a little, temperature and the strain along z vary strongly between sampling points
//! and nearly cancel in σ_zz. Therefore not the strains xx, …, xz are recovered but xx, yy, xy and the stresses zz, yz,
//! xz, which all vary slowly through the depth. The local temperature then determines the remaining components. On a
//! top or bottom these stresses are the traction there. It is known from the loads unless a support holds the face, and
//! the polynomials take that value. On an interface both layers have the same traction. As the small difference of large
//! stresses it is less accurate in the stiffer layer, so the layers' values are averaged with their compliances as
//! weights, and the polynomials of both take the mean.
//!
//! A plane of symmetry is no end: the sampling points continue behind it as images, so half a body recovers the same
//! values as the whole. On the axis of a disc the strains rr and tt are equal. Their mean is recovered as an even
//! function of the radius, half their difference as one that vanishes on the axis.

use faer::Mat;

use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::interpolation_weights;
use crate::method::mesh::Axis;
use crate::method::mesh::Mesh;

/// Number of sampling points: cubic inside; quadratic at an end, where the polynomial is extrapolated.
const INSIDE: usize = 4;
const AT_END: usize = 3;

/// Element and coordinate of each sampling point along an axis.
pub fn sampling_places(axis: &Axis) -> Vec<(usize, f64)> {
    if axis.elements() == 0 {
        return vec![(0, 0.0)];
    }
    let points = gauss_legendre(axis.order);
    (0..axis.elements())
        .flat_map(|element| {
            let [a, b] = axis.bounds(element);
            let place = move |xi: f64| 0.5 * (a + b) + 0.5 * (b - a) * xi;
            points.iter().map(|&(xi, _)| (element, place(xi))).collect::<Vec<_>>()
        })
        .collect()
}

/// Continuation of values beyond the low end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// The end of the body.
    Nothing,
    /// The mirror image, with the same values.
    Even,
    /// The mirror image, with the values' negatives.
    Odd,
    /// The mirror image, with the same values, and zero at the end itself.
    Vanishing,
}

/// Recovery from values at the sampling points of an axis, and from known values at its ends, to its nodes.
#[derive(Debug, Clone)]
pub struct Recovery {
    pub samples: Mat<f64>,
    /// Weights of the known values at the low and the high end, a list with an entry per node; empty if none is known.
    pub ends: [Vec<f64>; 2],
}

/// Value at a place through which a polynomial passes.
#[derive(Clone, Copy)]
enum Source {
    Sample(usize, f64),
    End(usize),
    Zero,
}

impl Recovery {
    /// Creates the recovery of an axis; `known` is set for ends with known values.
    pub fn new(axis: &Axis, beyond: Beyond, known: [bool; 2]) -> Self {
        let own: Vec<f64> = sampling_places(axis).into_iter().map(|(_, x)| x).collect();
        let sources = sources(axis, &own, beyond, known);
        let places: Vec<f64> = sources.iter().map(|source| source.0).collect();
        let mut samples = Mat::zeros(axis.len(), own.len());
        let mut ends = known.map(|known| vec![0.0; if known { axis.len() } else { 0 }]);
        for (node, &x) in axis.nodes.iter().enumerate() {
            let inside = x > places[0] && x < places[places.len() - 1];
            let wanted = if inside { INSIDE } else { AT_END }.min(places.len());
            let first = nearest(&places, x, wanted);
            let weights = interpolation_weights(&places[first..first + wanted], x);
            for (w, &(_, source)) in weights.into_iter().zip(&sources[first..]) {
                match source {
                    Source::Sample(i, sign) => samples[(node, i)] += sign * w,
                    Source::End(end) => ends[end][node] += w,
                    Source::Zero => {}
                }
            }
        }
        Self { samples, ends }
    }
}

impl Recovery {
    /// Creates the recovery along z from the samples of each layer to its own nodes, with nodes on interfaces listed
    /// twice. Each layer has the value on an interface that its own samples give.
    pub fn of_layers(mesh: &Mesh, known: [bool; 2]) -> Self {
        Self::stacked(&Self::parts(mesh, known, false), known)
    }

    /// Like [`Recovery::of_layers`], of a quantity that is continuous across interfaces, though its slope is not: both
    /// layers take the mean of their values there, weighted by `trust` (an entry per layer), as an end takes a known
    /// value.
    pub fn across_layers(mesh: &Mesh, known: [bool; 2], trust: &[f64]) -> Self {
        let apart = Self::of_layers(mesh, known);
        let parts = Self::parts(mesh, known, true);
        let mut whole = Self::stacked(&parts, known);
        let mut first = 0;
        for ((below, above), trust) in parts.iter().zip(parts.iter().skip(1)).zip(trust.windows(2))
        {
            let middle = first + below.samples.nrows();
            let share = trust[1] / (trust[0] + trust[1]);
            let sides = [(middle - 1, 1.0 - share), (middle, share)];
            for (n, &weight) in below.ends[1].iter().enumerate() {
                whole.add_rows(first + n, &apart, sides.map(|(row, share)| (row, weight * share)));
            }
            for (n, &weight) in above.ends[0].iter().enumerate() {
                whole.add_rows(middle + n, &apart, sides.map(|(row, share)| (row, weight * share)));
            }
            first = middle;
        }
        whole
    }

    /// Creates the recovery of each layer; `inner` is set if values on interfaces are known.
    fn parts(mesh: &Mesh, known: [bool; 2], inner: bool) -> Vec<Self> {
        let count = mesh.layering.count();
        let of_layer = |layer: usize| {
            let low = if layer == 0 { known[0] } else { inner };
            let high = if layer + 1 == count { known[1] } else { inner };
            Self::new(&mesh.layer_axis(layer), Beyond::Nothing, [low, high])
        };
        (0..count).map(of_layer).collect()
    }

    /// Joins the recoveries of layers, from the lowest on, without the weights of values on interfaces.
    fn stacked(parts: &[Self], known: [bool; 2]) -> Self {
        let sum = |size: fn(&Mat<f64>) -> usize| parts.iter().map(|part| size(&part.samples)).sum();
        let (nodes, columns): (usize, usize) = (sum(Mat::nrows), sum(Mat::ncols));
        let mut whole = Self {
            samples: Mat::zeros(nodes, columns),
            ends: known.map(|known| vec![0.0; if known { nodes } else { 0 }]),
        };
        let (mut row, mut column) = (0, 0);
        for part in parts {
            let [rows, columns] = [part.samples.nrows(), part.samples.ncols()];
            whole.samples.submatrix_mut(row, column, rows, columns).copy_from(&part.samples);
            (row, column) = (row + rows, column + columns);
        }
        let outer = [(parts.first(), 0), (parts.last(), 1)];
        for (all, (part, end)) in whole.ends.iter_mut().zip(outer) {
            let own = part.map_or(&[][..], |part| &part.ends[end]);
            let first = if end == 0 { 0 } else { nodes - own.len() };
            all.iter_mut().skip(first).zip(own).for_each(|(all, own)| *all = *own);
        }
        whole
    }

    /// Adds weighted rows of another recovery of the same places to a row.
    fn add_rows(&mut self, row: usize, other: &Self, rows: [(usize, f64); 2]) {
        for (from, weight) in rows {
            for column in 0..self.samples.ncols() {
                self.samples[(row, column)] += weight * other.samples[(from, column)];
            }
            for (all, own) in self.ends.iter_mut().zip(&other.ends) {
                if let (Some(value), Some(own)) = (all.get_mut(row), own.get(from)) {
                    *value += weight * own;
                }
            }
        }
    }
}

/// Returns the places in ascending order with their values.
fn sources(axis: &Axis, own: &[f64], beyond: Beyond, known: [bool; 2]) -> Vec<(f64, Source)> {
    let sign = if beyond == Beyond::Odd { -1.0 } else { 1.0 };
    let image = |(i, x): (usize, &f64)| (2.0 * axis.start() - x, Source::Sample(i, sign));
    let images = own.iter().enumerate().rev().map(image).filter(|_| beyond != Beyond::Nothing);
    let mut all: Vec<(f64, Source)> = images.collect();
    if known[0] {
        all.push((axis.start(), Source::End(0)));
    } else if beyond == Beyond::Vanishing {
        all.push((axis.start(), Source::Zero));
    }
    all.extend(own.iter().enumerate().map(|(i, &x)| (x, Source::Sample(i, 1.0))));
    if known[1] {
        all.push((axis.end(), Source::End(1)));
    }
    all
}

/// Index of the first of the `count` consecutive points that best surround `x`.
fn nearest(points: &[f64], x: f64, count: usize) -> usize {
    let above = points.partition_point(|&p| p < x);
    above.saturating_sub(count / 2).min(points.len() - count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Geometry, Layering, Weight};

    /// A mesh of two layers that meet at z = 1.8.
    fn two_layers(order: usize) -> Mesh {
        let axis = |ends: &[f64]| Axis::from_element_ends(ends, order, Weight::Uniform);
        Mesh {
            axes: [axis(&[0.0, 1.0]), axis(&[0.0, 1.0]), axis(&[0.0, 1.0, 1.8, 3.0, 3.5, 5.0])],
            mirrored: [false; 2],
            geometry: Geometry::Box,
            layering: Layering::new(vec![2], vec![0.0]),
        }
    }

    /// Continuous quadratics with a kink at an interface are recovered in both layers, whichever is trusted more; values
    /// that disagree there take that of the layer that is trusted.
    #[test]
    fn layers_share_their_value_on_an_interface() {
        for order in [1, 2] {
            let mesh = two_layers(order);
            let places: Vec<f64> =
                sampling_places(&mesh.axes[2]).into_iter().map(|own| own.1).collect();
            let nodes: Vec<f64> =
                mesh.nodes_of_sided().into_iter().map(|n| mesh.axes[2].nodes[n]).collect();
            let of_samples = |recovery: &Recovery, f: &dyn Fn(f64) -> f64, node: usize| -> f64 {
                let own =
                    places.iter().enumerate().map(|(i, &z)| recovery.samples[(node, i)] * f(z));
                let ends = [0.0, 5.0].into_iter().zip(&recovery.ends);
                let known = |(z, end): (f64, &Vec<f64>)| end.get(node).map_or(0.0, |w| w * f(z));
                own.sum::<f64>() + ends.map(known).sum::<f64>()
            };
            let kinked = |z: f64| {
                let from = z - 1.8;
                if from < 0.0 { 2.0 - from } else { 2.0 + 3.0 * from - 0.4 * from * from }
            };
            for trust in [[1.0, 1.0], [1e-3, 1.0], [1.0, 1e-3]] {
                let recovery = Recovery::across_layers(&mesh, [true; 2], &trust);
                for (node, &z) in nodes.iter().enumerate() {
                    let value = of_samples(&recovery, &kinked, node);
                    assert!((value - kinked(z)).abs() < 1e-12, "order {order} at {z}: {value}");
                }
            }
            let jumps = |z: f64| if z < 1.8 { 1.0 } else { 5.0 };
            let upper = Recovery::across_layers(&mesh, [false; 2], &[1.0, 3.0]);
            for node in [2 * order, 2 * order + 1] {
                assert!((of_samples(&upper, &jumps, node) - 4.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn quadratics_are_recovered_everywhere() {
        for order in [1, 2] {
            let axis =
                Axis::from_element_ends(&[0.0, 1.0, 1.8, 3.0, 3.5, 5.0], order, Weight::Uniform);
            let matrix = Recovery::new(&axis, Beyond::Nothing, [false; 2]).samples;
            let f = |x: f64| 1.0 - 2.0 * x + 0.3 * x * x;
            for (node, &x) in axis.nodes.iter().enumerate() {
                let value: f64 = sampling_places(&axis)
                    .iter()
                    .enumerate()
                    .map(|(i, &(_, p))| matrix[(node, i)] * f(p))
                    .sum();
                assert!((value - f(x)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn single_linear_element_has_one_value() {
        let axis = Axis::from_element_ends(&[0.0, 1.0], 1, Weight::Uniform);
        let matrix = Recovery::new(&axis, Beyond::Nothing, [false; 2]).samples;
        assert_eq!((matrix[(0, 0)], matrix[(1, 0)]), (1.0, 1.0));
    }

    #[test]
    fn known_values_at_ends_are_met_and_quadratics_still_recovered() {
        let f = |x: f64| 1.0 - 2.0 * x + 0.3 * x * x;
        for order in [1, 2] {
            let axis = Axis::from_element_ends(&[0.0, 1.0, 1.8, 3.0, 3.5], order, Weight::Uniform);
            let recovery = Recovery::new(&axis, Beyond::Nothing, [true; 2]);
            for (node, &x) in axis.nodes.iter().enumerate() {
                let places = sampling_places(&axis).into_iter().enumerate();
                let own: f64 = places.map(|(i, (_, p))| recovery.samples[(node, i)] * f(p)).sum();
                let ends = [0.0, 3.5].into_iter().zip(&recovery.ends);
                let value = own + ends.map(|(p, weights)| weights[node] * f(p)).sum::<f64>();
                assert!((value - f(x)).abs() < 1e-12, "order {order} at {x}: {value}");
            }
            let last = axis.len() - 1;
            assert_eq!((recovery.ends[0][0], recovery.ends[1][last]), (1.0, 1.0));
        }
    }

    #[test]
    fn vanishing_quantities_are_recovered_on_the_axis() {
        let axis = Axis::from_element_ends(&[0.0, 1.0, 1.8, 3.0], 2, Weight::Radial);
        let matrix = Recovery::new(&axis, Beyond::Vanishing, [false; 2]).samples;
        for (node, &x) in axis.nodes.iter().enumerate() {
            let places = sampling_places(&axis).into_iter().enumerate();
            let value: f64 = places.map(|(i, (_, p))| matrix[(node, i)] * p * p).sum();
            assert!((value - x * x).abs() < 1e-12, "at {x}: {value}");
        }
    }

    #[test]
    fn half_an_axis_recovers_what_the_whole_does() {
        let half = [0.0, 1.0, 1.8, 3.0, 3.5, 5.0];
        let both: Vec<f64> =
            half.iter().skip(1).rev().map(|x| -x).chain(half.iter().copied()).collect();
        for order in [1, 2] {
            let axis = Axis::from_element_ends(&half, order, Weight::Uniform);
            let whole = Axis::from_element_ends(&both, order, Weight::Uniform);
            let full = Recovery::new(&whole, Beyond::Nothing, [false; 2]).samples;
            for (beyond, f) in
                [(Beyond::Even, f64::cos as fn(f64) -> f64), (Beyond::Odd, f64::sin as _)]
            {
                let matrix = Recovery::new(&axis, beyond, [false; 2]).samples;
                let sum = |axis: &Axis, matrix: &Mat<f64>, node: usize| -> f64 {
                    let places = sampling_places(axis).into_iter().enumerate();
                    places.map(|(i, (_, x))| matrix[(node, i)] * f(x)).sum()
                };
                let middle = axis.len() - 1;
                for node in 0..axis.len() {
                    let (a, b) = (sum(&axis, &matrix, node), sum(&whole, &full, middle + node));
                    assert!((a - b).abs() < 1e-12, "order {order} {beyond:?} node {node}: {a} {b}");
                }
            }
        }
    }
}

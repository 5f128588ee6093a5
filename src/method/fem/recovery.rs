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
//! the polynomials take that value.
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
    /// twice. Strains along interfaces and stresses on them are continuous, but their slopes are not.
    pub fn of_layers(mesh: &Mesh, known: [bool; 2]) -> Self {
        let count = mesh.layering.count();
        let [.., nodes] = mesh.sided_counts();
        let mut whole = Self {
            samples: Mat::zeros(nodes, sampling_places(&mesh.axes[2]).len()),
            ends: known.map(|known| vec![0.0; if known { nodes } else { 0 }]),
        };
        let (mut row, mut column) = (0, 0);
        for layer in 0..count {
            let axis = mesh.layer_axis(layer);
            let outer = [known[0] && layer == 0, known[1] && layer + 1 == count];
            let Self { samples, ends } = Self::new(&axis, Beyond::Nothing, outer);
            for i in 0..samples.nrows() {
                for j in 0..samples.ncols() {
                    whole.samples[(row + i, column + j)] = samples[(i, j)];
                }
            }
            for (all, own) in whole.ends.iter_mut().zip(ends) {
                all.iter_mut().skip(row).zip(own).for_each(|(all, own)| *all = own);
            }
            row += samples.nrows();
            column += samples.ncols();
        }
        whole
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
    use crate::method::mesh::Weight;

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

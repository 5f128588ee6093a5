//! Recovery of strains: from the points where they are most accurate to a continuous field.
//!
//! Strains of Lagrange elements of order p are one order more accurate at the p Gauss points along
//! each axis (J. Barlow 1976, doi 10.1002/nme.1620100202). On a structured mesh these form a grid of
//! their own. The value at a node is the polynomial through the nearest sampling points along each
//! axis, and values between nodes follow the shape functions, so the field is continuous
//! (cf. O. C. Zienkiewicz and J. Z. Zhu 1992, doi 10.1002/nme.1620330702).
//!
//! Where heat has come only little way, temperature and the strain along z vary much from one
//! sampling point to the next and nearly cancel in σ_zz. So the strain that a heated layer would have
//! by itself is taken off before and put back, with the temperature of the place, afterwards. A plane of symmetry is no
//! end: the sampling points go on behind it as images, so half a body recovers what the whole does.

use faer::Mat;

use super::axis::Axis;
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::interpolation_weights;

/// Sampling points inside: cubic; at an end, where the polynomial is extrapolated: quadratic.
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

/// What lies beyond the low end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// The end of the body.
    Nothing,
    /// The mirror image, with the same values.
    Even,
    /// The mirror image, with the values' negatives.
    Odd,
}

/// From sampling points to nodes along one axis, as a dense matrix.
pub fn recovery_matrix(axis: &Axis, beyond: Beyond) -> Mat<f64> {
    let own: Vec<f64> = sampling_places(axis).into_iter().map(|(_, x)| x).collect();
    let image = |(i, x): (usize, &f64)| (2.0 * axis.start() - x, i, beyond);
    let images = own.iter().enumerate().rev().map(image).filter(|_| beyond != Beyond::Nothing);
    // Place, the sampling point it stands for, and how.
    let sources: Vec<(f64, usize, Beyond)> =
        images.chain(own.iter().enumerate().map(|(i, &x)| (x, i, Beyond::Even))).collect();
    let places: Vec<f64> = sources.iter().map(|source| source.0).collect();
    let mut matrix = Mat::zeros(axis.len(), own.len());
    for (node, &x) in axis.nodes.iter().enumerate() {
        let inside = x > places[0] && x < places[places.len() - 1];
        let wanted = if inside { INSIDE } else { AT_END }.min(places.len());
        let first = nearest(&places, x, wanted);
        let weights = interpolation_weights(&places[first..first + wanted], x);
        for (w, &(_, i, how)) in weights.into_iter().zip(&sources[first..]) {
            matrix[(node, i)] += if how == Beyond::Odd { -w } else { w };
        }
    }
    matrix
}

/// First of the `count` consecutive points that surround `x` best.
fn nearest(points: &[f64], x: f64, count: usize) -> usize {
    let above = points.partition_point(|&p| p < x);
    above.saturating_sub(count / 2).min(points.len() - count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::fem::axis::Weight;

    #[test]
    fn quadratics_are_recovered_everywhere() {
        for order in [1, 2] {
            let axis =
                Axis::from_element_ends(&[0.0, 1.0, 1.8, 3.0, 3.5, 5.0], order, Weight::Uniform);
            let matrix = recovery_matrix(&axis, Beyond::Nothing);
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
    fn a_single_linear_element_has_one_value() {
        let axis = Axis::from_element_ends(&[0.0, 1.0], 1, Weight::Uniform);
        let matrix = recovery_matrix(&axis, Beyond::Nothing);
        assert_eq!((matrix[(0, 0)], matrix[(1, 0)]), (1.0, 1.0));
    }
    #[test]
    fn half_an_axis_recovers_what_the_whole_does() {
        let half = [0.0, 1.0, 1.8, 3.0, 3.5, 5.0];
        let both: Vec<f64> =
            half.iter().skip(1).rev().map(|x| -x).chain(half.iter().copied()).collect();
        for order in [1, 2] {
            let axis = Axis::from_element_ends(&half, order, Weight::Uniform);
            let whole = Axis::from_element_ends(&both, order, Weight::Uniform);
            let full = recovery_matrix(&whole, Beyond::Nothing);
            for (beyond, f) in
                [(Beyond::Even, f64::cos as fn(f64) -> f64), (Beyond::Odd, f64::sin as _)]
            {
                let matrix = recovery_matrix(&axis, beyond);
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

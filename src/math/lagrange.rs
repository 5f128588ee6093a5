//! One-dimensional Lagrange shape functions of order 1 and 2 on [−1, 1], nodes equally spaced.

/// Values of the shape functions at `xi`; the third is unused for order 1.
pub fn shape(order: usize, xi: f64) -> [f64; 3] {
    match order {
        1 => [0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0],
        _ => [0.5 * xi * (xi - 1.0), 1.0 - xi * xi, 0.5 * xi * (xi + 1.0)],
    }
}

/// Derivatives of the shape functions with respect to `xi`.
pub fn slope(order: usize, xi: f64) -> [f64; 3] {
    match order {
        1 => [-0.5, 0.5, 0.0],
        _ => [xi - 0.5, -2.0 * xi, xi + 0.5],
    }
}

/// Weights that interpolate from the values at `points` to the place `x`.
pub fn interpolation_weights(points: &[f64], x: f64) -> Vec<f64> {
    let weight = |i: usize| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, &p)| (x - p) / (points[i] - p)).product()
    };
    (0..points.len()).map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_functions_partition_unity_and_match_differences() {
        for order in [1, 2] {
            for xi in [-1.0, -0.3, 0.0, 0.7, 1.0] {
                let h = 1e-6;
                let (above, below) = (shape(order, xi + h), shape(order, xi - h));
                let slopes = slope(order, xi);
                assert!((shape(order, xi).iter().sum::<f64>() - 1.0).abs() < 1e-15);
                assert!(slopes.iter().sum::<f64>().abs() < 1e-15);
                for i in 0..3 {
                    assert!(((above[i] - below[i]) / (2.0 * h) - slopes[i]).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn interpolation_is_exact_for_cubics() {
        let points = [0.0, 0.3, 1.0, 1.7];
        let cubic = |x: f64| 1.0 + x * (2.0 - x * (0.5 + x));
        let value: f64 = points
            .iter()
            .zip(interpolation_weights(&points, 2.1))
            .map(|(&p, w)| w * cubic(p))
            .sum();
        assert!((value - cubic(2.1)).abs() < 1e-13);
    }
}

//! Lateral modes of heat on the common cells of two faces.

use faer::Mat;

use crate::math::eigenvectors::eigenvectors;
use crate::math::separable::{Side, transform};

/// Modes along x and y, or along the radius, of linear elements between places, with insulated
/// ends.
#[derive(Debug, Clone, PartialEq)]
pub struct LateralModes {
    /// Squared wave numbers of the modes' products, x fastest [1/m²].
    pub decay: Vec<f64>,
    to_modes: [Mat<f64>; 2],
    to_places: [Mat<f64>; 2],
}

impl LateralModes {
    /// Modes of places with their lengths or areas, and a weight between two places: 1, or that of
    /// a ring.
    pub fn of(axes: [(&[f64], Vec<f64>); 2], weight: impl Fn(f64) -> f64) -> Self {
        let [x, y] = axes.map(|(places, lengths)| Axis::of(places, &lengths, &weight));
        let decay = y.decay.iter().flat_map(|b| x.decay.iter().map(move |a| a + b)).collect();
        Self { decay, to_modes: [x.to_modes, y.to_modes], to_places: [x.to_places, y.to_places] }
    }

    /// Amplitudes of modes from values at places.
    pub fn amplitudes(&self, values: &[f64]) -> Vec<f64> {
        apply(values, &self.to_modes)
    }

    /// Values at places from amplitudes of modes.
    pub fn values(&self, amplitudes: &[f64]) -> Vec<f64> {
        apply(amplitudes, &self.to_places)
    }
}

fn apply(values: &[f64], [x, y]: &[Mat<f64>; 2]) -> Vec<f64> {
    let one = Mat::from_fn(1, 1, |_, _| 1.0);
    transform(values, [x, y, &one], Side::Direct)
}

struct Axis {
    decay: Vec<f64>,
    to_modes: Mat<f64>,
    to_places: Mat<f64>,
}

impl Axis {
    fn of(places: &[f64], lengths: &[f64], weight: impl Fn(f64) -> f64) -> Self {
        let n = places.len();
        let mut stiffness = Mat::<f64>::zeros(n, n);
        for (i, pair) in places.windows(2).enumerate() {
            let link = weight(0.5 * (pair[0] + pair[1])) / (pair[1] - pair[0]);
            stiffness[(i, i)] += link;
            stiffness[(i + 1, i + 1)] += link;
            stiffness[(i, i + 1)] -= link;
            stiffness[(i + 1, i)] -= link;
        }
        let root: Vec<f64> = lengths.iter().map(|length| length.sqrt()).collect();
        let scaled = Mat::from_fn(n, n, |i, j| stiffness[(i, j)] / (root[i] * root[j]));
        let vectors = eigenvectors(&scaled);
        let quotient = |k: usize| {
            let part = |i: usize, j: usize| vectors[(i, k)] * scaled[(i, j)] * vectors[(j, k)];
            let sum: f64 = (0..n).map(|i| (0..n).map(|j| part(i, j)).sum::<f64>()).sum();
            sum.max(0.0)
        };
        Self {
            decay: (0..n).map(quotient).collect(),
            to_modes: Mat::from_fn(n, n, |k, i| vectors[(i, k)] * root[i]),
            to_places: Mat::from_fn(n, n, |i, k| vectors[(i, k)] / root[i]),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn modes_reproduce_values_and_decay_as_waves() {
        let places: Vec<f64> = (0..41).map(|n| f64::from(n) / 40.0).collect();
        let lengths = (0..41).map(|n| if n % 40 == 0 { 0.0125 } else { 0.025 }).collect();
        let modes = LateralModes::of([(&places, lengths), (&[0.0], vec![1.0])], |_| 1.0);
        for (k, decay) in modes.decay.iter().enumerate().take(4) {
            let wanted = (PI * k as f64).powi(2);
            assert!((decay - wanted).abs() < 0.01 * wanted + 1e-9, "{k} {decay}");
        }
        let values: Vec<f64> = places.iter().map(|x| x.exp()).collect();
        let back = modes.values(&modes.amplitudes(&values));
        values.iter().zip(back).for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
    }
}

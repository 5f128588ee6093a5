//! Average of the tensile normal stress over all directions (S. B. Batdorf and J. G. Crose 1974, doi
//! 10.1115/1.3423310, without shear).
//!
//! `h = (2m + 1)/(4π) ∮ ⟨n·σn⟩^m dΩ` for principal stresses 1, t₂, t₃. With the polar axis along the first one, and
//! `w_i = 1/(2 − t_i)`, a substitution of the azimuth leaves
//!
//! `h = (2m + 1) √(w₂ w₃) · mean of J(½(w₂ + w₃) + ½(w₂ − w₃) cos θ) over θ`,
//!
//! `J(w) = 1/w ∫ (c² + (1 − c²) q)^m dc` from the cone of zero stress to c = 1, with `q = 2 − 1/w`. J is smooth on all
//! of (0, 1], however large the compression, so it is tabulated, and the mean is a Gauss–Chebyshev sum.

use std::f64::consts::PI;

use crate::math::gauss::gauss_legendre;

/// Number of intervals of the table.
const INTERVALS: usize = 512;
/// Points of the average over θ: some, and more for each unit of the modulus.
const POINTS: f64 = 32.0;
const POINTS_PER_MODULUS: f64 = 0.5;

/// The average for one modulus.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalAverage {
    modulus: f64,
    /// J at equidistant w from 0 to 1.
    table: Vec<f64>,
    /// `cos θ` of the points.
    cosines: Vec<f64>,
}

impl NormalAverage {
    pub fn of(modulus: f64) -> Self {
        let points = gauss_legendre((modulus.ceil() as usize + 3).min(128));
        let table = (0..=INTERVALS).map(|i| {
            let w = i as f64 / INTERVALS as f64;
            profile(modulus, w, &points)
        });
        let count = (POINTS + POINTS_PER_MODULUS * modulus).ceil() as usize;
        let cosine = |k: usize| (PI * (2 * k + 1) as f64 / (2 * count) as f64).cos();
        Self { modulus, table: table.collect(), cosines: (0..count).map(cosine).collect() }
    }

    /// h of the principal stresses 1, `second` and `third`, both at most 1.
    pub fn risk(&self, second: f64, third: f64) -> f64 {
        let [a, b] = [second, third].map(|ratio| 1.0 / (2.0 - ratio));
        let (mean, half) = (0.5 * (a + b), 0.5 * (a - b));
        let sum: f64 = self.cosines.iter().map(|cosine| self.at(mean + half * cosine)).sum();
        (2.0 * self.modulus + 1.0) * (a * b).sqrt() * sum / self.cosines.len() as f64
    }

    /// [`Self::risk`] with its derivatives with respect to `second` and `third`.
    pub fn with_slopes(&self, second: f64, third: f64) -> (f64, [f64; 2]) {
        let [a, b] = [second, third].map(|ratio| 1.0 / (2.0 - ratio));
        let (mean, half) = (0.5 * (a + b), 0.5 * (a - b));
        // Means of J, and of its slopes with respect to a and b.
        let mut sums = [0.0; 3];
        for cosine in &self.cosines {
            let (value, slope) = self.with_slope_at(mean + half * cosine);
            sums[0] += value;
            sums[1] += 0.5 * (1.0 + cosine) * slope;
            sums[2] += 0.5 * (1.0 - cosine) * slope;
        }
        let [value, of_a, of_b] = sums.map(|sum| sum / self.cosines.len() as f64);
        let root = (2.0 * self.modulus + 1.0) * (a * b).sqrt();
        let slope = |own: f64, of_own: f64| root * own * own * (0.5 * value / own + of_own);
        (root * value, [slope(a, of_a), slope(b, of_b)])
    }

    /// J and its slope, by the cubic through the four nearest entries.
    fn with_slope_at(&self, w: f64) -> (f64, f64) {
        let place = w * INTERVALS as f64;
        let first = (place as usize).saturating_sub(1).min(INTERVALS - 3);
        let x = place - first as f64;
        let [a, b, c, d] = [x, x - 1.0, x - 2.0, x - 3.0];
        let own = &self.table[first..first + 4];
        let slope = ((a * b + a * c + b * c) * own[3] - (b * c + b * d + c * d) * own[0]) / 6.0
            + 0.5 * ((a * c + a * d + c * d) * own[1] - (a * b + a * d + b * d) * own[2]);
        (self.at(w), slope * INTERVALS as f64)
    }

    /// J by the cubic through the four nearest entries.
    fn at(&self, w: f64) -> f64 {
        let place = w * INTERVALS as f64;
        let first = (place as usize).saturating_sub(1).min(INTERVALS - 3);
        let x = place - first as f64;
        let [a, b, c, d] = [x, x - 1.0, x - 2.0, x - 3.0];
        let own = &self.table[first..first + 4];
        (a * b * c * own[3] - b * c * d * own[0]) / 6.0
            + 0.5 * (a * c * d * own[1] - a * b * d * own[2])
    }
}

/// J(w). With `1 − c² = y/(1 − q)` near the cone the integral stays finite as w vanishes.
fn profile(modulus: f64, w: f64, points: &[(f64, f64)]) -> f64 {
    // w (1 − q) and w q of q = 2 − 1/w.
    let (fall, rest) = (1.0 - w, 2.0 * w - 1.0);
    // 1 − c² on the cone.
    let most = if rest < 0.0 { w / fall } else { 1.0 };
    // From c = √(1 − most) to 1, whose distance is most/(1 + √(1 − most)).
    let length = 1.0 / (1.0 + (1.0 - most).sqrt());
    let part = |&(x, weight): &(f64, f64)| {
        // The share of the way from c = 1.
        let share = 0.5 * (1.0 + x);
        let off = share * length;
        // (1 − c²)/most = off (2 − most off); the stress is 1 − (1 − c²)(1 − q).
        let lost = off * (2.0 - most * off) * if rest < 0.0 { 1.0 } else { fall / w };
        0.5 * weight * (1.0 - lost).max(0.0).powf(modulus)
    };
    // most/w
    let scale = if rest < 0.0 { 1.0 / fall } else { 1.0 / w };
    scale * length * points.iter().map(part).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniaxial_equibiaxial_and_triaxial_stress_have_their_closed_forms() {
        for (modulus, biaxial) in [(5.0, 4.0635), (10.0, 5.6755), (20.0, 7.9763)] {
            let average = NormalAverage::of(modulus);
            let near = |found: f64, wanted: f64, off: f64| {
                assert!((found / wanted - 1.0).abs() < off, "m {modulus}: {found} {wanted}");
            };
            near(average.risk(0.0, 0.0), 1.0, 1e-7);
            near(average.risk(1.0, 0.0), biaxial, 1e-5);
            near(average.risk(1.0, 1.0), 2.0 * modulus + 1.0, 1e-12);
        }
    }

    /// Product of midpoint rules over an eighth of the sphere, extrapolated from two numbers of points.
    fn directly(modulus: f64, second: f64, third: f64) -> f64 {
        let [coarse, fine] = [700, 1400].map(|count| midpoints(modulus, second, third, count));
        fine + (fine - coarse) / 3.0
    }

    fn midpoints(modulus: f64, second: f64, third: f64, count: usize) -> f64 {
        let mut sum = 0.0;
        for i in 0..count {
            let c = (i as f64 + 0.5) / count as f64;
            for j in 0..count {
                let (sine, cosine) = (0.5 * PI * (j as f64 + 0.5) / count as f64).sin_cos();
                let across = second * cosine * cosine + third * sine * sine;
                let stress = c * c + (1.0 - c * c) * across;
                sum += stress.max(0.0).powf(modulus);
            }
        }
        (2.0 * modulus + 1.0) * sum / (count * count) as f64
    }

    #[test]
    fn average_equals_direct_quadrature() {
        for modulus in [2.0, 7.5, 30.0] {
            let average = NormalAverage::of(modulus);
            for [second, third] in [[0.9, 0.5], [0.3, -0.4], [-0.5, -2.0], [0.95, -8.0]] {
                let (found, wanted) =
                    (average.risk(second, third), directly(modulus, second, third));
                let off = (found / wanted - 1.0).abs();
                // The midpoint rule errs by (2m + 1) m h²/6.
                assert!(off < 2e-5, "m {modulus}, {second}, {third}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn compression_of_any_size_leaves_a_positive_risk() {
        let average = NormalAverage::of(10.0);
        // A narrow cone about the first axis: h → (2m + 1)/(2(m + 1) |t|).
        for size in [1e3, 1e8, 1e15] {
            let found = average.risk(-size, -size) * size;
            assert!((found / (21.0 / 22.0) - 1.0).abs() < 3e-3, "{size}: {found}");
        }
    }

    #[test]
    fn slopes_are_those_of_a_small_change() {
        for (modulus, [second, third]) in
            [(5.0, [0.3, -0.2]), (10.0, [0.9, 0.1]), (12.5, [-0.4, -3.0]), (40.0, [0.97, 0.95])]
        {
            let average = NormalAverage::of(modulus);
            let (value, slopes) = average.with_slopes(second, third);
            assert!((value / average.risk(second, third) - 1.0).abs() < 1e-13);
            let step = 1e-6;
            let central = [
                average.risk(second + step, third) - average.risk(second - step, third),
                average.risk(second, third + step) - average.risk(second, third - step),
            ];
            for (found, wanted) in slopes.into_iter().zip(central.map(|own| own / (2.0 * step))) {
                assert!((found - wanted).abs() < 1e-6 * value * modulus, "{found} {wanted}");
            }
        }
    }
}

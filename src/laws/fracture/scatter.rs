//! Scatter of strengths and energies.

use crate::math::random::{fraction, mixed};

/// Factor with the mean 1, uniformly distributed between `1 − width` and `1 + width`, from a hash of the seed and
/// some numbers.
///
/// The seed is mixed before the first number is added: seeds that follow each other give independent samples instead
/// of one sample shifted by an element.
pub fn scattered<const N: usize>(width: f64, seed: u32, numbers: [u64; N]) -> f64 {
    if width == 0.0 {
        return 1.0;
    }
    let bits = numbers
        .iter()
        .fold(mixed(u64::from(seed)), |bits, number| mixed(bits.wrapping_add(*number)));
    1.0 + width * (2.0 * fraction(bits) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Correlation of two samples whose values are even about 1 with the half width 1.
    fn correlation(count: u64, pair: impl Fn(u64) -> [f64; 2]) -> f64 {
        let sum: f64 = (0..count).map(pair).map(|[left, right]| (left - 1.0) * (right - 1.0)).sum();
        3.0 * sum / count as f64
    }

    /// Asserts that the values lie evenly about 1: mean and variance within five standard errors.
    #[test]
    fn values_are_even_about_one() {
        let count = 100_000;
        let mean = (0..count).map(|n| scattered(0.5, 3, [n, 7])).sum::<f64>() / count as f64;
        let variance = correlation(count, |n| [scattered(1.0, 3, [n, 7]); 2]);
        assert!((mean - 1.0).abs() < 5.0 * 0.5 / (3.0 * count as f64).sqrt(), "mean {mean}");
        assert!(
            (variance - 1.0).abs() < 5.0 * 0.9 / (count as f64).sqrt(),
            "variance over that of an even law {variance}"
        );
    }

    /// Asserts that neither samples of near seeds nor neighbours within a sample are correlated, shifted or not.
    #[test]
    fn samples_of_near_seeds_are_independent() {
        let count = 10_000;
        for seed in 0..4_u32 {
            for shift in 0..8_u64 {
                let across = correlation(count, |n| {
                    [scattered(1.0, 0, [n + shift, 5]), scattered(1.0, seed + 1, [n, 5])]
                });
                let along = correlation(count, |n| {
                    [scattered(1.0, seed, [n, shift]), scattered(1.0, seed, [n + 1, shift])]
                });
                assert!(across.abs() < 0.05, "seed {}, shift {shift}: {across}", seed + 1);
                assert!(along.abs() < 0.05, "seed {seed}, row {shift}: {along}");
            }
        }
    }
}

//! Complete polynomials of order 1 or 2 in one to three coordinates.

use crate::math::lanes::Lanes;

/// Number of monomials of a complete polynomial of order 1 or 2.
pub(super) const fn terms(axes: usize, order: usize) -> usize {
    if order == 1 { 1 + axes } else { (1 + axes) * (2 + axes) / 2 }
}

/// Factors of each quadratic monomial, for each number of coordinates.
const QUADRATIC: [[[usize; 2]; 6]; 4] = [
    [[0; 2]; 6],
    [[0; 2]; 6],
    [[0, 0], [0, 1], [1, 1], [0; 2], [0; 2], [0; 2]],
    [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]],
];

/// The monomials 1, y₁ …, and for N > D + 1 also y₁², y₁y₂ ….
#[inline(always)]
pub(super) fn monomials<const D: usize, const N: usize>(y: &[Lanes; D]) -> [Lanes; N] {
    let mut h = [Lanes::splat(1.0); N];
    h[1..=D].copy_from_slice(y);
    for n in D + 1..N {
        let [a, b] = QUADRATIC[D][n - D - 1];
        h[n] = y[a] * y[b];
    }
    h
}

/// Σ `factors` · ∂H/∂y_k.
#[inline(always)]
pub(super) fn slope<const D: usize, const N: usize>(
    k: usize,
    y: &[Lanes; D],
    factors: &[f64; N],
) -> Lanes {
    let mut sum = Lanes::splat(factors[1 + k]);
    for n in D + 1..N {
        let [a, b] = QUADRATIC[D][n - D - 1];
        if a == k {
            sum = sum + y[b] * Lanes::splat(factors[n]);
        }
        if b == k {
            sum = sum + y[a] * Lanes::splat(factors[n]);
        }
    }
    sum
}

/// Adds `weight` · ∂H/∂y_k to sums for each monomial.
#[inline(always)]
pub(super) fn add_slope<const D: usize, const N: usize>(
    k: usize,
    y: &[Lanes; D],
    weight: Lanes,
    sums: &mut [Lanes; N],
) {
    sums[1 + k] = sums[1 + k] + weight;
    for n in D + 1..N {
        let [a, b] = QUADRATIC[D][n - D - 1];
        if a == k {
            sums[n] = sums[n] + weight * y[b];
        }
        if b == k {
            sums[n] = sums[n] + weight * y[a];
        }
    }
}

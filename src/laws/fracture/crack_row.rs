//! Stress intensity of a row of equal edge cracks, parallel to each other at equal distances, in a half plane.
//!
//! A crack is a distribution B of edge dislocations along its depth, which are as many in each crack of the row. Their
//! stress and the given one σ cancel on the crack, `∫₀^a B(s) k(z, s) ds ∝ σ(z)` (D. A. Hills, P. A. Kelly, D. N. Dai
//! and A. M. Korsunsky, *Solution of Crack Problems*, Kluwer 1996). With `s = a (1 − r²)` the root of B at the tip
//! goes, and the integral is Gauss's sum over Legendre's polynomial of r, which is exact for stresses at the zeros of
//! Legendre's function of the second kind. K follows from B at the tip, and is a sum over the stress at these points.
//!
//! With `h = π/p` for cracks p apart, `y = z − s`, `Y = z + s`, `c(y) = coth hy` and `d(y) = 1/sinh² hy`, the stress of
//! dislocations at the depth s, those of a plane summed over the row, is
//!
//! `k = 2h c(y) − h²y d(y) − 2h c(Y) + h²(Y + 2s) d(Y) − 4h³s(Y − s) c(Y) d(Y)`.
//!
//! One crack alone, p → ∞, has 1.1215 σ√(πa) under uniform stress, a dense row σ√(p/2).

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};

use crate::math::gauss::gauss_legendre;

/// Depth over distance beyond which only the stress near the tip matters, within that many distances.
const DEEPEST: f64 = 12.0;
/// Pairs of points along a crack: some, and more for each distance that it is deep. The error is below 3e-4.
const PAIRS: f64 = 24.0;
const PAIRS_PER_DISTANCE: f64 = 2.0;
/// Newton's iterations towards a zero, from an asymptotic one.
const ITERATIONS: usize = 6;

/// Depths [m] along the cracks of a row, each with the weight of the stress there in K [√m].
pub fn crack_row(depth: f64, spacing: f64) -> Vec<(f64, f64)> {
    let reach = depth.min(DEEPEST * spacing);
    let ratio = reach / spacing;
    let count = 2 * (PAIRS + PAIRS_PER_DISTANCE * ratio).ceil() as usize;
    // Roots of the distance from the tip.
    let sources: Vec<(f64, f64)> =
        gauss_legendre(2 * count).into_iter().filter(|(root, _)| *root > 0.0).collect();
    let points: Vec<f64> = (0..count).map(|place| second_kind_zero(2 * count, place)).collect();
    let from_tip = |root: f64| root * root;
    let deep = |root: f64| 1.0 - from_tip(root);
    let stress = DMatrix::from_fn(count, count, |j, i| {
        let (root, part) = sources[j];
        2.0 * part * kernel(PI * ratio, deep(points[i]), deep(root))
    });
    // Those that lack at the tip are interpolated.
    let at_tip = DVector::from_fn(count, |j, _| {
        let own = from_tip(sources[j].0);
        let others = sources.iter().enumerate().filter(|(other, _)| *other != j);
        others.map(|(_, (other, _))| from_tip(*other) / (from_tip(*other) - own)).product()
    });
    // Points lie between sources, so the matrix has an inverse.
    let weights = stress.lu().solve(&at_tip).unwrap_or_else(|| DVector::zeros(count));
    let unit = -PI * TAU.sqrt() * reach.sqrt();
    let of_point = |(root, weight): (&f64, &f64)| (depth - reach * from_tip(*root), unit * weight);
    points.iter().zip(&weights).map(of_point).collect()
}

/// Zero of Legendre's function of the second kind `Q_n` in (0, 1), counted from 1 down.
fn second_kind_zero(n: usize, place: usize) -> f64 {
    let mut x = (PI * (place as f64 + 0.25) / (n as f64 + 0.5)).cos();
    for _ in 0..ITERATIONS {
        let (mut before, mut now) = (x.atanh(), x * x.atanh() - 1.0);
        for m in 1..n {
            let m = m as f64;
            (before, now) = (now, ((2.0 * m + 1.0) * x * now - m * before) / (m + 1.0));
        }
        let slope = n as f64 * (x * now - before) / (x * x - 1.0);
        x -= now / slope;
    }
    x
}

/// Stress at the depth z of dislocations at the depth s, with h times the depth of the cracks.
fn kernel(h: f64, z: f64, s: f64) -> f64 {
    let (below, sum) = (z - s, z + s);
    let coth = |x: f64| 1.0 / (h * x).tanh();
    // 1/sinh² without overflow.
    let falling = |x: f64| {
        let double = -2.0 * (h * x).abs();
        4.0 * double.exp() / double.exp_m1().powi(2)
    };
    let (c, d) = (coth(sum), falling(sum));
    2.0 * h * (coth(below) - c) + h * h * ((sum + 2.0 * s) * d - below * falling(below))
        - 4.0 * h.powi(3) * s * (sum - s) * c * d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::edge_crack::edge;

    fn intensity(depth: f64, spacing: f64, stress: impl Fn(f64) -> f64) -> f64 {
        crack_row(depth, spacing).into_iter().map(|(z, weight)| weight * stress(z)).sum()
    }

    #[test]
    fn distant_cracks_are_alone() {
        let profiles: [fn(f64) -> f64; 3] =
            [|_| 2.0, |z| 3.0 - z + 0.4 * z * z, |z| (-2.0 * z).exp()];
        for stress in profiles {
            let found = intensity(0.7, 700.0, stress);
            assert!((found / edge(0.7, stress) - 1.0).abs() < 1.5e-3, "{found}");
        }
        let exact = 1.121_522 * (PI * 0.7).sqrt();
        assert!((intensity(0.7, 7e4, |_| 1.0) / exact - 1.0).abs() < 3e-4);
    }

    /// A crack frees the energy `p σ²/(2E′)` of a column of material between its neighbours.
    #[test]
    fn dense_cracks_release_the_energy_of_what_they_unload() {
        for depth in [2.0, 5.0, 12.0, 100.0, 1e4] {
            let found = intensity(depth, 1.0, |_| 1.0);
            assert!((found / 0.5_f64.sqrt() - 1.0).abs() < 3e-6, "{depth}: {found}");
            // Stress that varies slowly counts at the tip, with a share of what is above.
            let slope = 1.0 / depth;
            let tilted = intensity(depth, 1.0, |z| 1.0 + slope * z);
            assert!((tilted / 2.0_f64.sqrt() - 1.0).abs() < 0.2 * slope, "{depth}: {tilted}");
        }
    }

    #[test]
    fn results_do_not_depend_on_the_depth_from_which_on_the_mouth_is_left_out() {
        let profile = |from_tip: f64| 1.0 + 0.3 * (2.0 * from_tip).cos();
        let [shallow, deep] =
            [DEEPEST, DEEPEST + 1e-9].map(|depth| intensity(depth, 1.0, |z| profile(depth - z)));
        let deeper = intensity(3.0 * DEEPEST, 1.0, |z| profile(3.0 * DEEPEST - z));
        assert!((deep / shallow - 1.0).abs() < 1e-8 && (deeper / shallow - 1.0).abs() < 1e-6);
    }
}

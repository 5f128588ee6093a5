//! Rates of measures of a stress state when the stress changes; order xx, yy, zz, xy, yz, xz [Pa].
//!
//! At a kink of a measure, as both have at zero stress, the rate is the one-sided derivative in the direction of the
//! change.

use nalgebra::{DMatrix, Matrix3};

use super::stress::{max_principal, von_mises};

/// Relative difference of principal stresses, over the largest magnitude, below which they count as equal.
const SAME: f64 = 1e-10;

/// Rate of the von Mises stress: `(3/2) s : σ̇ / σ_vM` with the deviator `s`.
pub fn von_mises_rate(stress: [f64; 6], rate: [f64; 6]) -> f64 {
    let measure = von_mises(stress);
    if measure == 0.0 {
        return von_mises(rate);
    }
    let [xx, yy, zz, xy, yz, xz] = stress;
    let mean = (xx + yy + zz) / 3.0;
    let normal = (xx - mean) * rate[0] + (yy - mean) * rate[1] + (zz - mean) * rate[2];
    let shear = xy * rate[3] + yz * rate[4] + xz * rate[5];
    1.5 * (normal + 2.0 * shear) / measure
}

/// Rate of the largest principal stress: the largest eigenvalue of the rate in the space of the
/// directions in which the stress has its largest one (T. Kato, *Perturbation Theory for Linear
/// Operators*, Springer 1966, §II.5).
pub fn max_principal_rate(stress: [f64; 6], rate: [f64; 6]) -> f64 {
    let scale = stress.iter().fold(0.0_f64, |scale, s| scale.max(s.abs()));
    if scale == 0.0 {
        return max_principal(rate);
    }
    let eigen = matrix(stress.map(|s| s / scale)).symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let directions: Vec<_> = (0..3).filter(|&i| eigen.eigenvalues[i] >= largest - SAME).collect();
    let rate = matrix(rate);
    let within = DMatrix::from_fn(directions.len(), directions.len(), |i, j| {
        let column = |i: usize| eigen.eigenvectors.column(directions[i]);
        (column(i).transpose() * rate * column(j))[(0, 0)]
    });
    within.symmetric_eigenvalues().max()
}

/// Rates of the three principal stresses in descending order, each along a direction of its own. Where some are equal,
/// only sums over them have a meaning, and only measures that treat them alike follow.
pub fn principal_rates(stress: [f64; 6], rate: [f64; 6]) -> [f64; 3] {
    let scale = stress.iter().fold(f64::MIN_POSITIVE, |scale, s| scale.max(s.abs()));
    let eigen = matrix(stress.map(|s| s / scale)).symmetric_eigen();
    let rate = matrix(rate);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    order.map(|i| {
        let along = eigen.eigenvectors.column(i);
        (along.transpose() * rate * along)[(0, 0)]
    })
}

fn matrix([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::stress::principals;

    const STRESS: [f64; 6] = [3.0, -1.0, 2.0, 0.7, -0.4, 1.1];
    const RATE: [f64; 6] = [-0.3, 0.8, 0.1, 0.5, 0.2, -0.6];

    fn moved(stress: [f64; 6], by: f64) -> [f64; 6] {
        std::array::from_fn(|i| stress[i] + by * RATE[i])
    }

    #[test]
    fn rates_are_the_limit_of_differences() {
        let h = 1e-5;
        let central =
            |f: fn([f64; 6]) -> f64| (f(moved(STRESS, h)) - f(moved(STRESS, -h))) / (2.0 * h);
        assert!((von_mises_rate(STRESS, RATE) - central(von_mises)).abs() < 1e-9);
        assert!((max_principal_rate(STRESS, RATE) - central(max_principal)).abs() < 1e-9);
    }

    #[test]
    fn at_kinks_the_one_sided_rate_is_given() {
        let h = 1e-7;
        let principal = |stress| matrix(stress).symmetric_eigenvalues().max();
        let double = [2.0, 2.0, -1.0, 0.0, 0.0, 0.0];
        for stress in [[0.0; 6], [-3.0, -3.0, -3.0, 0.0, 0.0, 0.0], double] {
            let ahead = |f: &dyn Fn([f64; 6]) -> f64| (f(moved(stress, h)) - f(stress)) / h;
            let rate = max_principal_rate(stress, RATE);
            assert!((rate - ahead(&principal)).abs() < 1e-6, "{stress:?}");
            let rate = von_mises_rate(stress, RATE);
            assert!((rate - ahead(&von_mises)).abs() < 1e-6, "{stress:?}");
        }
    }

    #[test]
    fn principal_rates_are_those_of_a_small_change() {
        let central = |i: usize| {
            let [before, after] = [-1e-6, 1e-6].map(|by| principals(moved(STRESS, by))[i]);
            (after - before) / 2e-6
        };
        let found = principal_rates(STRESS, RATE);
        for (i, found) in found.into_iter().enumerate() {
            assert!((found - central(i)).abs() < 1e-8, "{i}: {found} {}", central(i));
        }
        // Equal ones have a sum only.
        let found = principal_rates([2.0, 2.0, 1.0, 0.0, 0.0, 0.0], RATE);
        assert!((found[0] + found[1] - RATE[0] - RATE[1]).abs() < 1e-14);
        assert!((found[2] - RATE[2]).abs() < 1e-14);
        // The rate of rest is that of any basis.
        let sum: f64 = principal_rates([0.0; 6], RATE).iter().sum();
        assert!((sum - RATE[..3].iter().sum::<f64>()).abs() < 1e-14);
    }
}

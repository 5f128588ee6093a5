//! Moment matrices of particles' neighbours, as xx, yy, zz, xy, yz, xz.

use std::f64::consts::PI;

/// Determinant below which a moment matrix is not inverted.
const SINGULAR: f64 = 0.05;

/// Completes the moment matrix: in a plane model its y direction is inert.
pub fn filled(mut moment: [f64; 6], dimension: usize) -> [f64; 6] {
    if dimension == 2 {
        moment[1] = 1.0;
    }
    moment
}

/// Smallest eigenvalue of a symmetric matrix (Smith 1961, doi
/// 10.1145/355578.366316).
pub fn least_eigenvalue(&[xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> f64 {
    let mean = (xx + yy + zz) / 3.0;
    let [a, b, c] = [xx - mean, yy - mean, zz - mean];
    let spread = (a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + xz * xz)) / 6.0;
    if spread <= 0.0 {
        return mean;
    }
    let determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    let cosine = (0.5 * determinant / (spread * spread.sqrt())).clamp(-1.0, 1.0);
    mean + 2.0 * spread.sqrt() * (cosine.acos() / 3.0 + 2.0 * PI / 3.0).cos()
}

/// Gradient that is exact for linear fields; `None` where too few neighbours span space.
pub fn renormalised(&[xx, yy, zz, xy, yz, xz]: &[f64; 6], [a, b, c]: [f64; 3]) -> [f64; 3] {
    let [xx_, yy_, zz_] = [yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy];
    let [xy_, yz_, xz_] = [xz * yz - xy * zz, xy * xz - xx * yz, xy * yz - xz * yy];
    let determinant = xx * xx_ + xy * xy_ + xz * xz_;
    if determinant < SINGULAR {
        return [0.0; 3];
    }
    let inverse = 1.0 / determinant;
    [
        inverse * (xx_ * a + xy_ * b + xz_ * c),
        inverse * (xy_ * a + yy_ * b + yz_ * c),
        inverse * (xz_ * a + yz_ * b + zz_ * c),
    ]
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;

    const MOMENT: [f64; 6] = [0.9, 0.7, 0.4, 0.1, -0.2, 0.05];

    fn matrix([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Matrix3<f64> {
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    #[test]
    fn least_eigenvalue_matches_iterative_solver() {
        for moment in [MOMENT, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [0.3, 0.2, 0.9, 0.0, 0.0, 0.1]] {
            let exact = matrix(moment).symmetric_eigenvalues().min();
            assert!((least_eigenvalue(&moment) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn renormalisation_inverts_the_moment() {
        let gradient = nalgebra::Vector3::new(1.0, -2.0, 0.5);
        let sum = matrix(MOMENT) * gradient;
        let found = renormalised(&MOMENT, sum.into());
        assert!((nalgebra::Vector3::from(found) - gradient).norm() < 1e-12);
    }
}

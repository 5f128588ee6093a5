//! Risk of failure `B = ∫ h(σ) dV/V₀` of bodies with flaws in their volume, `h = (σ/σ₀)^m` in uniaxial tension.
//!
//! Sources: W. Weibull, J. Appl. Mech. 18 (1951) 293; S. B. Batdorf and J. G. Crose 1974, doi 10.1115/1.3423310. The
//! integrals were derived here.

use super::quadrature::integrate;

/// Effective volume of a bar in three-point bending over its volume `1/(2(m + 1)²)`.
pub fn three_point_volume(modulus: f64) -> f64 {
    0.5 / (modulus + 1.0).powi(2)
}

/// The same of four-point bending at the quarter points `(m + 2)/(4(m + 1)²)`.
pub fn four_point_volume(modulus: f64) -> f64 {
    0.25 * (modulus + 2.0) / (modulus + 1.0).powi(2)
}

/// Effective part of a thickness over which the stress varies linearly from `ratio` times the largest, which may be
/// compression, to the largest.
pub fn linear_stress(modulus: f64, ratio: f64) -> f64 {
    (1.0 - ratio.max(0.0).powf(modulus + 1.0)) / ((modulus + 1.0) * (1.0 - ratio))
}

/// Risk of equibiaxial over that of uniaxial tension if the normal stress is averaged over all directions,
/// `(2m + 1) ∏ 2k/(2k + 1)` for a whole number m.
pub fn equibiaxial_ratio(modulus: u32) -> f64 {
    let factor = |k: u32| f64::from(2 * k) / f64::from(2 * k + 1);
    f64::from(2 * modulus + 1) * (1..=modulus).map(factor).product::<f64>()
}

/// Effective depth of a suddenly cooled half space over `√(κt)`: `∫ erfc(z/2)^m dz`.
pub fn shock_depth(modulus: f64) -> f64 {
    integrate(|z| libm::erfc(0.5 * z).powf(modulus), &[0.0, 1.0, 4.0, 16.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shock_depths_and_ratios_of_usual_moduli() {
        for (modulus, depth, ratio) in
            [(5, 0.305035, 4.063492), (10, 0.162850, 5.675464), (20, 0.084670, 7.976346)]
        {
            assert!((shock_depth(f64::from(modulus)) - depth).abs() < 1e-6);
            assert!((equibiaxial_ratio(modulus) - ratio).abs() < 1e-6);
        }
    }

    #[test]
    fn bending_volumes_are_integrals_of_the_linear_stress() {
        // Along the bar the moment rises linearly to the load, and is constant between two loads.
        for modulus in [5.0, 10.0, 20.0] {
            let section = linear_stress(modulus, -1.0);
            let rising = 1.0 / (modulus + 1.0);
            assert!((three_point_volume(modulus) - section * rising).abs() < 1e-15);
            let four = section * (0.5 * rising + 0.5);
            assert!((four_point_volume(modulus) - four).abs() < 1e-15);
        }
    }
}

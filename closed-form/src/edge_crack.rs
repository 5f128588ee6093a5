//! Stress intensity of cracks in an uncracked stress: edge cracks of a half plane, and penny-shaped cracks.
//!
//! Edge crack of depth a: `K = 2√(a/π) ∫₀¹ σ(xa) (1.3 − 0.3 x^{5/4})/√(1 − x²) dx`, within 0.1 % of the exact solution
//! for uniform stress, 1.12152 σ√(πa) (fit to point forces on the crack: H. Tada, P. C. Paris and G. R. Irwin, *The
//! Stress Analysis of Cracks Handbook*, Del Research 1973). Penny: I. N. Sneddon 1946, doi 10.1098/rspa.1946.0077.

use std::f64::consts::{FRAC_PI_2, PI};

use super::quadrature::integrate;

/// K of an edge crack of a depth [m] under a stress [Pa] at the depth z [Pa √m].
pub fn edge(depth: f64, stress: impl Fn(f64) -> f64) -> f64 {
    // x = sin θ
    let part = |angle: f64| {
        let x = angle.sin();
        stress(x * depth) * (1.3 - 0.3 * x.powf(1.25))
    };
    2.0 * (depth / PI).sqrt() * integrate(part, &[0.0, FRAC_PI_2])
}

/// K of an edge crack in a half space whose surface was suddenly cooled, over `σ_s √δ`, with `δ = √(κt)`; the depth is
/// in units of δ.
pub fn shocked(depth: f64) -> f64 {
    edge(depth, |z| libm::erfc(0.5 * z))
}

/// K of a penny-shaped crack of a radius [m] under uniform tension [Pa] across it: `2σ√(a/π)`.
pub fn penny(radius: f64, stress: f64) -> f64 {
    2.0 * stress * (radius / PI).sqrt()
}

/// K of a penny-shaped crack of a radius [m] in the middle of a cylinder of a radius [m] under the tension far from it
/// [Pa], within 1 % (H. Tada, P. C. Paris and G. R. Irwin, as above): `σ_n √(πa) ((2/π)(1 + λ/2 − 5λ²/8) + 0.268 λ³)
/// √(1 − λ)` with λ the ratio of the radii and `σ_n = σ/(1 − λ²)`.
pub fn penny_in_cylinder(radius: f64, cylinder: f64, stress: f64) -> f64 {
    let ratio = radius / cylinder;
    let of_ratio = (1.0 + 0.5 * ratio - 0.625 * ratio * ratio) / FRAC_PI_2 + 0.268 * ratio.powi(3);
    stress / (1.0 - ratio * ratio) * (PI * radius).sqrt() * of_ratio * (1.0 - ratio).sqrt()
}

/// Energy release rate [J/m²] of a crack of a length a between two arms of a height H [m], whose ends are drawn apart:
/// `3/2 PΔ/(a + 0.677 H)` by the product of load per width and opening [J/m], as the compliance goes with the cube of
/// the length and the turning in front of the crack makes it longer (R. M. L. Foote & V. T. Buchwald 1985, Int. J.
/// Fracture 29, 125).
pub fn cantilever_release(work: f64, length: f64, height: f64) -> f64 {
    1.5 * work / (length + TURNED * height)
}

/// Opening [m] at which the crack of those arms runs at an energy release rate of 1 J/m², by the modulus in plane
/// strain [Pa]: the compliance is `8 (a + 0.677 H)³/(E'H³)`.
pub fn cantilever_opening(length: f64, height: f64, modulus: f64) -> f64 {
    let length = length + TURNED * height;
    (8.0 / 1.5 * length.powi(4) / (modulus * height.powi(3))).sqrt()
}

/// Length that the turning in front of a crack adds to arms, over their height.
const TURNED: f64 = 0.677;

/// Energy release rate `(1 − ν²) K²/E` [J/m²].
pub fn energy_release(intensity: f64, young: f64, poisson: f64) -> f64 {
    (1.0 - poisson * poisson) * intensity * intensity / young
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_stress_has_the_exact_factor_to_a_thousandth() {
        let factor = edge(1.0, |_| 1.0) / PI.sqrt();
        assert!((factor / 1.12152 - 1.0).abs() < 1e-3, "{factor}");
    }

    #[test]
    fn shocked_half_space_is_worst_at_its_diffusion_length() {
        for (depth, wanted) in [(0.1, 0.60737), (1.0, 1.33948), (3.0, 0.99187), (10.0, 0.52049)] {
            assert!((shocked(depth) - wanted).abs() < 1e-5, "{depth}");
        }
        let [below, most, above] = [1.0, 1.1305, 1.26].map(shocked);
        assert!(most > below && most > above && (most - 1.34485).abs() < 1e-5);
    }

    #[test]
    fn wide_cylinders_leave_pennies_alone() {
        let [alone, wide] = [penny(1.0, 3.0), penny_in_cylinder(1.0, 1e4, 3.0)];
        assert!((wide / alone - 1.0).abs() < 1e-4, "{alone} {wide}");
        // A thin ligament is a deep crack whose ends cannot turn: 2/√(π² − 4) σ_n √(πc).
        let (left, stress) = (1e-3, 1.0);
        let net = stress / (1.0 - (1.0 - left) * (1.0 - left));
        let found = penny_in_cylinder(1.0 - left, 1.0, stress) / (net * (PI * left).sqrt());
        assert!((found / (2.0 / (PI * PI - 4.0).sqrt()) - 1.0).abs() < 2e-3, "{found}");
    }

    #[test]
    fn arms_release_the_fall_of_their_energy() {
        // 12 P²a²/(E'H³) of slender arms.
        let (length, height, modulus) = (1e4, 2.0, 3.0);
        let opening = cantilever_opening(length, height, modulus);
        let load = opening * modulus * height.powi(3) / (8.0 * length.powi(3));
        let slender = 12.0 * load * load * length * length / (modulus * height.powi(3));
        assert!((slender - 1.0).abs() < 1e-3, "{slender}");
        assert!((cantilever_release(load * opening, length, height) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn pennies_release_the_energy_of_sneddon() {
        let (radius, stress, young, poisson) = (1e-3, 1e8, 3e11, 0.2);
        let found = energy_release(penny(radius, stress), young, poisson);
        let wanted = 4.0 * (1.0 - poisson * poisson) * stress * stress * radius / (PI * young);
        assert!((found / wanted - 1.0).abs() < 1e-12);
    }
}

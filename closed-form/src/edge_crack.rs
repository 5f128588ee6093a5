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
    fn pennies_release_the_energy_of_sneddon() {
        let (radius, stress, young, poisson) = (1e-3, 1e8, 3e11, 0.2);
        let found = energy_release(penny(radius, stress), young, poisson);
        let wanted = 4.0 * (1.0 - poisson * poisson) * stress * stress * radius / (PI * young);
        assert!((found / wanted - 1.0).abs() < 1e-12);
    }
}

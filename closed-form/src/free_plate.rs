//! Free plate `−h/2 ≤ z ≤ h/2` whose temperature varies through the thickness only, away from the
//! edges.
//!
//! Source: B. A. Boley and J. H. Weiner, *Theory of Thermal Stresses*, Wiley 1960.

use super::medium::Elastic;
use super::quadrature::integrate;

/// The plate. Each function receives the temperature rise ΔT(z) [K].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreePlate {
    pub body: Elastic,
    /// Expansion coefficient α [1/K].
    pub expansion: f64,
    /// Thickness h [m].
    pub thickness: f64,
}

impl FreePlate {
    /// In-plane stress [Pa] `σ = 1/(1−ν) · [−EαΔT + 1/h ∫EαΔT dz + 12z/h³ ∫EαΔT z dz]`.
    pub fn stress(&self, rise: impl Fn(f64) -> f64, z: f64) -> f64 {
        let strain = self.mid_strain(&rise) + self.curvature(&rise) * z;
        self.body.biaxial_modulus() * (strain - self.expansion * rise(z))
    }

    /// In-plane strain of the mid-plane [1] `α/h ∫ΔT dz`.
    pub fn mid_strain(&self, rise: impl Fn(f64) -> f64) -> f64 {
        self.expansion / self.thickness * integrate(rise, &self.faces())
    }

    /// Growth of the in-plane strain with z [1/m] `12α/h³ ∫ΔT z dz`: the curvature, positive where
    /// the plate bends towards −z.
    pub fn curvature(&self, rise: impl Fn(f64) -> f64) -> f64 {
        let moment = integrate(|z| rise(z) * z, &self.faces());
        12.0 * self.expansion / self.thickness.powi(3) * moment
    }

    fn faces(&self) -> [f64; 2] {
        [-0.5 * self.thickness, 0.5 * self.thickness]
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA_ELASTIC, ALUMINA_EXPANSION, assert_close, assert_within};
    use super::*;

    const PLATE: FreePlate =
        FreePlate { body: ALUMINA_ELASTIC, expansion: ALUMINA_EXPANSION, thickness: 0.26e-3 };

    #[test]
    fn linear_temperature_bends_without_stress() {
        let rise = |z: f64| 50.0 + 2e5 * z;
        assert_close(PLATE.mid_strain(rise), 50.0 * ALUMINA_EXPANSION, 1e-12);
        assert_close(PLATE.curvature(rise), 2e5 * ALUMINA_EXPANSION, 1e-12);
        assert_within(PLATE.stress(rise, 1e-4), 0.0, 1e-2);
    }

    #[test]
    fn parabolic_temperature_gives_the_parabolic_stress() {
        let (peak, h) = (100.0, PLATE.thickness);
        let scale = PLATE.body.biaxial_modulus() * PLATE.expansion * peak;
        for z in [-0.5 * h, 0.1 * h, 0.5 * h] {
            let stress = PLATE.stress(|z| peak * (z / h).powi(2), z);
            assert_close(stress, scale * (1.0 / 12.0 - (z / h).powi(2)), 1e-11);
        }
    }

    #[test]
    fn stress_has_neither_force_nor_moment() {
        let h = PLATE.thickness;
        let stress = |z: f64| PLATE.stress(|z| 300.0 * (-(z + 0.5 * h) / (0.1 * h)).exp(), z);
        let scale = stress(-0.5 * h).abs() * h;
        assert_within(integrate(stress, &PLATE.faces()), 0.0, 1e-10 * scale);
        assert_within(integrate(|z| stress(z) * z, &PLATE.faces()), 0.0, 1e-10 * scale * h);
    }
}

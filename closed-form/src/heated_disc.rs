//! Thin free disc and long free cylinder `r ≤ R` whose temperature varies along the radius only.
//!
//! Source: S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*, 3rd ed., McGraw-Hill 1970,
//! §150 (disc) and §151 (cylinder).

use super::medium::Elastic;
use super::quadrature::integrate;

/// Mean of the rise over the circle `r`, halved: `1/r² ∫₀^r ΔT r dr` [K], finite at `r = 0`.
fn half_mean(rise: impl Fn(f64) -> f64, r: f64) -> f64 {
    integrate(|x| rise(r * x) * x, &[0.0, 1.0])
}

/// Thin disc, in plane stress. Each function receives the temperature rise ΔT(r) [K].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinDisc {
    pub body: Elastic,
    /// Expansion coefficient α [1/K].
    pub expansion: f64,
    /// Radius R [m].
    pub radius: f64,
}

impl ThinDisc {
    /// Radial stress [Pa] `σ_rr = Eα [1/R² ∫₀^R ΔT r dr − 1/r² ∫₀^r ΔT r dr]`.
    pub fn radial_stress(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        self.body.young * self.expansion * (half_mean(&rise, self.radius) - half_mean(&rise, r))
    }

    /// Hoop stress [Pa] `σ_θθ = Eα [1/R² ∫₀^R ΔT r dr + 1/r² ∫₀^r ΔT r dr − ΔT]`.
    pub fn hoop_stress(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        let sum = half_mean(&rise, self.radius) + half_mean(&rise, r);
        self.body.young * self.expansion * (sum - rise(r))
    }

    /// Radial displacement [m] `u = α [(1+ν)/r ∫₀^r ΔT r dr + (1−ν) r/R² ∫₀^R ΔT r dr]`.
    pub fn radial_displacement(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        let nu = self.body.poisson;
        let (whole, inside) = (half_mean(&rise, self.radius), half_mean(&rise, r));
        self.expansion * r * ((1.0 + nu) * inside + (1.0 - nu) * whole)
    }
}

/// Long cylinder with free ends, away from them: plane sections stay plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongCylinder {
    pub body: Elastic,
    /// Expansion coefficient α [1/K].
    pub expansion: f64,
    /// Radius R [m].
    pub radius: f64,
}

impl LongCylinder {
    /// Radial stress [Pa]: that of the thin disc over `1 − ν`.
    pub fn radial_stress(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        self.disc().radial_stress(rise, r) / (1.0 - self.body.poisson)
    }

    /// Hoop stress [Pa]: that of the thin disc over `1 − ν`.
    pub fn hoop_stress(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        self.disc().hoop_stress(rise, r) / (1.0 - self.body.poisson)
    }

    /// Axial stress [Pa] `σ_zz = Eα/(1−ν) · [2/R² ∫₀^R ΔT r dr − ΔT] = σ_rr + σ_θθ`.
    pub fn axial_stress(&self, rise: impl Fn(f64) -> f64, r: f64) -> f64 {
        let mean = 2.0 * half_mean(&rise, self.radius);
        self.body.biaxial_modulus() * self.expansion * (mean - rise(r))
    }

    /// Axial strain [1] `α · 2/R² ∫₀^R ΔT r dr`.
    pub fn axial_strain(&self, rise: impl Fn(f64) -> f64) -> f64 {
        2.0 * self.expansion * half_mean(rise, self.radius)
    }

    fn disc(&self) -> ThinDisc {
        ThinDisc { body: self.body, expansion: self.expansion, radius: self.radius }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{
        ALUMINA_ELASTIC, ALUMINA_EXPANSION, assert_close, assert_within, derivative,
    };
    use super::*;

    const DISC: ThinDisc =
        ThinDisc { body: ALUMINA_ELASTIC, expansion: ALUMINA_EXPANSION, radius: 1e-3 };
    const CYLINDER: LongCylinder =
        LongCylinder { body: ALUMINA_ELASTIC, expansion: ALUMINA_EXPANSION, radius: 1e-3 };

    fn gauss(r: f64) -> f64 {
        100.0 * (-(r / 0.3e-3).powi(2)).exp()
    }

    #[test]
    fn uniform_temperature_grows_the_disc_without_stress() {
        assert_within(DISC.hoop_stress(|_| 100.0, 0.5e-3), 0.0, 1e-2);
        let grown = DISC.radial_displacement(|_| 100.0, 0.5e-3);
        assert_close(grown, ALUMINA_EXPANSION * 100.0 * 0.5e-3, 1e-12);
    }

    #[test]
    fn parabolic_temperature_gives_the_parabolic_stress() {
        let rise = |r: f64| 100.0 * (r / DISC.radius).powi(2);
        let scale = 0.25 * DISC.body.young * DISC.expansion * 100.0;
        assert_close(DISC.radial_stress(rise, 0.3e-3), scale * (1.0 - 0.09), 1e-11);
        assert_close(DISC.hoop_stress(rise, 0.3e-3), scale * (1.0 - 3.0 * 0.09), 1e-11);
    }

    #[test]
    fn stress_is_in_equilibrium_and_free_at_the_rim() {
        let r = 0.4e-3;
        let slope = derivative(|r| DISC.radial_stress(gauss, r), r, 5e-6);
        let hoop = DISC.hoop_stress(gauss, r);
        assert_close(slope, (hoop - DISC.radial_stress(gauss, r)) / r, 1e-7);
        assert_eq!(DISC.radial_stress(gauss, DISC.radius), 0.0);
        assert_eq!(DISC.radial_stress(gauss, 0.0), DISC.hoop_stress(gauss, 0.0));
    }

    #[test]
    fn displacement_strains_obey_hookes_law() {
        let (r, nu) = (0.4e-3, DISC.body.poisson);
        let (radial, hoop) = (DISC.radial_stress(gauss, r), DISC.hoop_stress(gauss, r));
        let free = DISC.expansion * gauss(r);
        let displacement = |r| DISC.radial_displacement(gauss, r);
        let radial_strain = (radial - nu * hoop) / DISC.body.young + free;
        assert_close(derivative(displacement, r, 5e-6), radial_strain, 1e-7);
        assert_close(displacement(r) / r, (hoop - nu * radial) / DISC.body.young + free, 1e-10);
    }

    #[test]
    fn cylinder_has_one_axial_strain_and_no_axial_force() {
        let body = CYLINDER.body;
        for r in [0.0, 0.4e-3, 1e-3] {
            let plane = CYLINDER.radial_stress(gauss, r) + CYLINDER.hoop_stress(gauss, r);
            let axial = CYLINDER.axial_stress(gauss, r);
            let strain = (axial - body.poisson * plane) / body.young + DISC.expansion * gauss(r);
            assert_close(strain, CYLINDER.axial_strain(gauss), 1e-10);
        }
        let force = integrate(|r| CYLINDER.axial_stress(gauss, r) * r, &[0.0, 1e-3]);
        assert_within(force, 0.0, 1e-9 * CYLINDER.axial_stress(gauss, 0.0).abs() * 1e-6);
    }
}

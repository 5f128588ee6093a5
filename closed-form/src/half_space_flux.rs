//! Half space `z ≥ 0` at zero, heated through its surface from time 0 on; insulated elsewhere.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959,
//! §2.9 (uniform flux, flux `∝ t^{n/2}`) and §10.5 (disc).

use std::f64::consts::PI;

use super::medium::Conductor;
use super::quadrature::integrate_over_disc;
use super::special::{ierfc, ierfc_drop};

/// Constant flux over the whole surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformFlux {
    pub body: Conductor,
    /// Flux q into the body [W/m²].
    pub flux: f64,
}

impl UniformFlux {
    /// Temperature rise [K] `q s/k · ierfc(z/s)`, `s = 2√(at)`.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let s = self.body.diffusion_length(t);
        self.flux * s / self.body.conductivity * ierfc(z / s)
    }
}

/// Flux `q = C/√t` over the whole surface, for which the surface temperature is constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecayingFlux {
    pub body: Conductor,
    /// Strength C [W √s/m²].
    pub strength: f64,
}

impl DecayingFlux {
    /// Flux into the body [W/m²] `C/√t`.
    pub fn flux(&self, t: f64) -> f64 {
        self.strength / t.sqrt()
    }

    /// Temperature rise [K] `C √π/e · erfc(z/s)`, `e` the effusivity.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let surface = self.strength * PI.sqrt() / self.body.effusivity();
        surface * libm::erfc(z / self.body.diffusion_length(t))
    }
}

/// Constant flux over the disc `r ≤ R` of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscFlux {
    pub body: Conductor,
    /// Flux q into the body [W/m²].
    pub flux: f64,
    /// Radius R of the disc [m].
    pub radius: f64,
}

impl DiscFlux {
    /// Temperature rise on the axis [K] `q s/k · [ierfc(z/s) − ierfc(√(z²+R²)/s)]`.
    pub fn rise_on_axis(&self, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        self.flux / self.body.conductivity * self.radial_integral(z, self.radius, t)
    }

    /// Temperature rise [K] at distance r from the axis and depth z, by quadrature to 1e-9: the
    /// continuous point source `q dA/(2πk d) · erfc(d/s)` over the disc.
    pub fn rise(&self, r: f64, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let sum = integrate_over_disc(self.radius, r, |rho| self.radial_integral(z, rho, t));
        self.flux / (2.0 * PI * self.body.conductivity) * sum
    }

    /// Temperature rise on the axis for `t → ∞` [K] `q/k · (√(z²+R²) − z)`.
    pub fn steady_rise_on_axis(&self, z: f64) -> f64 {
        self.flux / self.body.conductivity * further(z, self.radius)
    }

    /// `∫₀^ρ erfc(d/s)/d ρ dρ = s [ierfc(z/s) − ierfc(√(z²+ρ²)/s)]`, `d = √(z²+ρ²)`.
    fn radial_integral(&self, z: f64, rho: f64, t: f64) -> f64 {
        let s = self.body.diffusion_length(t);
        s * ierfc_drop(z / s, further(z, rho) / s)
    }
}

/// `√(z²+ρ²) − z` without cancellation for `z ≥ 0`.
fn further(z: f64, rho: f64) -> f64 {
    if rho == 0.0 { 0.0 } else { rho * rho / (z.hypot(rho) + z) }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, assert_close, assert_heat_equation, derivative_at_left};
    use super::super::quadrature::integrate;
    use super::*;

    const DISC: DiscFlux = DiscFlux { body: ALUMINA, flux: 1e8, radius: 50e-6 };
    const UNIFORM: UniformFlux = UniformFlux { body: ALUMINA, flux: 1e8 };
    const DECAYING: DecayingFlux = DecayingFlux { body: ALUMINA, strength: 5e4 };

    #[test]
    fn disc_on_alumina_after_1_ms() {
        assert_close(DISC.rise_on_axis(0.0, 1e-3), 371.743, 1e-6);
        assert_close(DISC.rise_on_axis(20e-6, 1e-3), 211.720, 2e-6);
    }

    #[test]
    fn all_obey_the_heat_equation() {
        let a = ALUMINA.diffusivity();
        let at = [30e-6, 20e-6, 15e-6];
        assert_heat_equation(|x, t| UNIFORM.rise(x[2], t), a, at, 1e-4, 5e-7);
        assert_heat_equation(|x, t| DECAYING.rise(x[2], t), a, at, 1e-4, 5e-7);
        let disc = |x: [f64; 3], t| DISC.rise(x[0].hypot(x[1]), x[2], t);
        assert_heat_equation(disc, a, at, 2e-4, 2e-6);
        assert_heat_equation(disc, a, [60e-6, 20e-6, 15e-6], 2e-4, 2e-6);
    }

    #[test]
    fn surface_gradient_is_the_flux() {
        let (k, t) = (ALUMINA.conductivity, 1e-4);
        let flux = |f: &dyn Fn(f64) -> f64| -k * derivative_at_left(f, 0.0, 2e-7);
        assert_close(flux(&|z| UNIFORM.rise(z, t)), 1e8, 1e-7);
        assert_close(flux(&|z| DECAYING.rise(z, t)), DECAYING.flux(t), 1e-7);
        assert_close(flux(&|z| DISC.rise_on_axis(z, t)), 1e8, 1e-7);
        assert_close(flux(&|z| DISC.rise(30e-6, z, t)), 1e8, 1e-5);
        assert!(flux(&|z| DISC.rise(70e-6, z, t)).abs() < 1e3);
    }

    #[test]
    fn uniform_heat_content_is_the_heat_given() {
        let content = integrate(|z| UNIFORM.rise(z, 1e-4), &[0.0, 5e-4]);
        assert_close(ALUMINA.heat_capacity * content, 1e8 * 1e-4, 1e-10);
    }

    #[test]
    fn disc_tends_to_uniform_flux_early_and_to_the_steady_state_late() {
        for z in [0.0, 5e-6] {
            assert_close(DISC.rise_on_axis(z, 1e-5), UNIFORM.rise(z, 1e-5), 1e-9);
            assert_close(DISC.rise_on_axis(z, 1e8), DISC.steady_rise_on_axis(z), 1e-5);
        }
    }

    #[test]
    fn disc_off_axis_joins_the_axis_the_edge_and_the_far_field() {
        let t = 1e-3;
        for z in [0.0, 20e-6, 200e-6] {
            assert_close(DISC.rise(0.0, z, t), DISC.rise_on_axis(z, t), 1e-10);
            assert_close(DISC.rise(1e-9, z, t), DISC.rise_on_axis(z, t), 1e-8);
        }
        // At the edge in the steady state: 2qR/(πk) (Carslaw & Jaeger §8.2).
        let edge = 2.0 * DISC.flux * DISC.radius / (PI * ALUMINA.conductivity);
        assert_close(DISC.rise(DISC.radius, 0.0, 1e8), edge, 1e-5);
        let far = 40.0 * DISC.radius;
        let point = 0.5 * DISC.flux * DISC.radius.powi(2) / (ALUMINA.conductivity * far);
        let s = ALUMINA.diffusion_length(1.0);
        assert_close(DISC.rise(far, 0.0, 1.0), point * libm::erfc(far / s), 1e-3);
    }

    #[test]
    fn disc_near_its_edge_is_a_half_plane_early() {
        for t in [1e-12, 1e-10, 1e-8] {
            let half = 0.5 * UNIFORM.rise(0.0, t);
            let reach = ALUMINA.diffusion_length(t) / DISC.radius;
            for nearly in [1.0 - 1e-9, 1.0, 1.0 + 1e-9] {
                assert_close(DISC.rise(nearly * DISC.radius, 0.0, t), half, reach + 3e-4);
            }
        }
    }

    #[test]
    fn rise_is_zero_at_time_zero() {
        assert_eq!(UNIFORM.rise(0.0, 0.0) + DISC.rise(0.0, 0.0, 0.0), 0.0);
        assert_eq!(DISC.rise_on_axis(0.0, 0.0) + DECAYING.rise(0.0, 0.0), 0.0);
    }
}

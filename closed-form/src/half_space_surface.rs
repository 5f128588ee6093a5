//! Half space `z ≥ 0` at zero whose surface or surroundings change temperature at time 0.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959, §2.4 (surface
//! temperature) and §2.7 (convection).

use std::f64::consts::PI;

use super::medium::Conductor;
use super::special::erfcx;

/// Surface with a prescribed temperature. With `a = 1` this is the rod of Park §2.4.5.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuddenSurface {
    pub body: Conductor,
    /// Temperature rise ΔT of the surface [K].
    pub step: f64,
}

impl SuddenSurface {
    /// Temperature rise [K] `ΔT erfc(z/s)`, `s = 2√(at)`.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        self.step * libm::erfc(z / self.body.diffusion_length(t))
    }

    /// Flux into the body [W/m²] `e ΔT/√(πt)`.
    pub fn flux(&self, t: f64) -> f64 {
        self.body.effusivity() * self.step / (PI * t).sqrt()
    }
}

/// Surface with the flux `h (ΔT∞ − ΔT)` into the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvectiveSurface {
    pub body: Conductor,
    /// Heat transfer coefficient h [W/(m² K)].
    pub coefficient: f64,
    /// Ambient temperature above that of the body at time 0, ΔT∞ [K].
    pub ambient: f64,
}

impl ConvectiveSurface {
    /// Temperature rise [K] `ΔT∞ [erfc η − e^{hz/k + b²} erfc(η + b)]`, `η = z/s`, `b = h√(at)/k`.
    ///
    /// The exponent is `(η + b)² − η²`, so the second term is `e^{−η²} erfcx(η + b)`.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let s = self.body.diffusion_length(t);
        let (eta, b) = (z / s, 0.5 * self.coefficient * s / self.body.conductivity);
        self.ambient * (-eta * eta).exp() * (erfcx(eta) - erfcx(eta + b))
    }

    /// Flux into the body [W/m²].
    pub fn flux(&self, t: f64) -> f64 {
        self.coefficient * (self.ambient - self.rise(0.0, t))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, assert_close, assert_heat_equation, derivative_at_left};
    use super::super::half_space_flux::{DecayingFlux, UniformFlux};
    use super::*;

    const SUDDEN: SuddenSurface = SuddenSurface { body: ALUMINA, step: 80.0 };
    const CONVECTIVE: ConvectiveSurface =
        ConvectiveSurface { body: ALUMINA, coefficient: 2e6, ambient: 80.0 };

    #[test]
    fn both_obey_the_heat_equation() {
        let (a, at) = (ALUMINA.diffusivity(), [0.0, 0.0, 4e-6]);
        assert_heat_equation(|x, t| SUDDEN.rise(x[2], t), a, at, 1e-6, 1e-7);
        assert_heat_equation(|x, t| CONVECTIVE.rise(x[2], t), a, at, 1e-6, 1e-7);
    }

    #[test]
    fn surface_gradient_is_the_flux() {
        let (k, t, h) = (ALUMINA.conductivity, 1e-6, 2e-8);
        assert_close(-k * derivative_at_left(|z| SUDDEN.rise(z, t), 0.0, h), SUDDEN.flux(t), 1e-7);
        let gradient = derivative_at_left(|z| CONVECTIVE.rise(z, t), 0.0, h);
        assert_close(-k * gradient, CONVECTIVE.flux(t), 1e-7);
    }

    #[test]
    fn sudden_surface_is_the_decaying_flux_that_holds_it() {
        let strength = SUDDEN.flux(1.0);
        let decaying = DecayingFlux { body: ALUMINA, strength };
        assert_close(decaying.rise(3e-6, 2e-6), SUDDEN.rise(3e-6, 2e-6), 1e-14);
    }

    #[test]
    fn convection_is_a_held_surface_when_strong_and_a_uniform_flux_when_weak() {
        let strong = ConvectiveSurface { coefficient: 1e14, ..CONVECTIVE };
        assert_close(strong.rise(2e-6, 1e-6), SUDDEN.rise(2e-6, 1e-6), 1e-6);
        let weak = ConvectiveSurface { coefficient: 1.0, ..CONVECTIVE };
        let uniform = UniformFlux { body: ALUMINA, flux: 80.0 };
        assert_close(weak.rise(2e-6, 1e-6), uniform.rise(2e-6, 1e-6), 1e-6);
    }
}

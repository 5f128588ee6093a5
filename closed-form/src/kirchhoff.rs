//! Conduction with a conductivity linear in the temperature, `k = k₀ (1 + β T)`, and a heat capacity proportional to
//! it, so that the diffusivity is constant.
//!
//! The heat conductivity integral `θ = T + β T²/2` (G. Kirchhoff 1894) then obeys the linear heat equation with the
//! constants at T = 0. So solutions of the linear problem carry over for prescribed fluxes and temperatures. Source: H.
//! S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959, §1.6 and §2.16.

use super::half_space_flux::UniformFlux;
use super::half_space_surface::SuddenSurface;
use super::medium::Conductor;

/// A body with `k = k₀ (1 + β T)` and `ρc = ρc₀ (1 + β T)`, T above its initial temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearConductivity {
    /// Constants at the initial temperature.
    pub body: Conductor,
    /// β [1/K]
    pub slope: f64,
}

impl LinearConductivity {
    /// Kirchhoff's variable over `k₀`, θ [K], at a temperature rise.
    pub fn integral(&self, rise: f64) -> f64 {
        rise * (1.0 + 0.5 * self.slope * rise)
    }

    /// The temperature rise [K] of a θ, `2θ/(1 + √(1 + 2βθ))`.
    pub fn rise_of(&self, integral: f64) -> f64 {
        2.0 * integral / (1.0 + (1.0 + 2.0 * self.slope * integral).sqrt())
    }

    /// Temperature rise [K] of a half space whose surface changes by `step` [K] at time 0.
    pub fn sudden_surface(&self, step: f64, z: f64, t: f64) -> f64 {
        let linear = SuddenSurface { body: self.body, step: self.integral(step) };
        self.rise_of(linear.rise(z, t))
    }

    /// Flux [W/m²] into that half space.
    pub fn sudden_surface_flux(&self, step: f64, t: f64) -> f64 {
        SuddenSurface { body: self.body, step: self.integral(step) }.flux(t)
    }

    /// Temperature rise [K] of a half space under a flux [W/m²] from time 0.
    pub fn uniform_flux(&self, flux: f64, z: f64, t: f64) -> f64 {
        self.rise_of(UniformFlux { body: self.body, flux }.rise(z, t))
    }

    /// Temperature rise [K] of a steady slab between faces at two temperature rises, at a `part` of its thickness.
    pub fn steady_slab(&self, ends: [f64; 2], part: f64) -> f64 {
        let [low, high] = ends.map(|rise| self.integral(rise));
        self.rise_of((1.0 - part) * low + part * high)
    }

    /// Flux [W/m²] through that slab of a thickness [m], from the first face to the second.
    pub fn steady_flux(&self, ends: [f64; 2], thickness: f64) -> f64 {
        let [low, high] = ends.map(|rise| self.integral(rise));
        self.body.conductivity * (low - high) / thickness
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, assert_close, derivative};
    use super::*;

    const BODY: LinearConductivity = LinearConductivity { body: ALUMINA, slope: 2e-3 };

    #[test]
    fn nonlinear_heat_equation_holds() {
        // ρc ∂T/∂t = ∂/∂z (k ∂T/∂z)
        let factor = |rise: f64| 1.0 + BODY.slope * rise;
        let (z, t) = (4e-5, 3e-4);
        for field in [(|z, t| BODY.sudden_surface(400.0, z, t)) as fn(f64, f64) -> f64, |z, t| {
            BODY.uniform_flux(8e7, z, t)
        }] {
            let rate = factor(field(z, t)) * derivative(|t| field(z, t), t, 1e-6);
            let flux = |z: f64| factor(field(z, t)) * derivative(|z| field(z, t), z, 1e-6);
            let spread = ALUMINA.diffusivity() * derivative(flux, z, 1e-6);
            assert_close(spread, rate, 1e-7);
        }
    }

    #[test]
    fn boundary_conditions_hold() {
        assert_close(BODY.sudden_surface(400.0, 0.0, 1e-3), 400.0, 1e-13);
        let at = |z: f64| BODY.integral(BODY.uniform_flux(8e7, z, 1e-3));
        let slope = (at(1e-9) - at(0.0)) / 1e-9;
        assert_close(-ALUMINA.conductivity * slope, 8e7, 1e-4);
        assert_close(BODY.steady_slab([100.0, 500.0], 1.0), 500.0, 1e-13);
        assert_close(BODY.rise_of(BODY.integral(-120.0)), -120.0, 1e-14);
        let slope = |rise: f64| derivative(|p| BODY.steady_slab([100.0, 500.0], p), rise, 1e-3);
        let flux = -10.0 * (1.0 + 2e-3 * BODY.steady_slab([100.0, 500.0], 0.3)) * slope(0.3) / 2e-3;
        assert_close(flux, BODY.steady_flux([100.0, 500.0], 2e-3), 1e-9);
    }
}

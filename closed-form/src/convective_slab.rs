//! Slab `0 ≤ z ≤ L` at zero whose face `z = 0` meets a fluid at time 0, its back insulated.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959,
//! §3.11.

use std::f64::consts::PI;

use super::half_space_surface::ConvectiveSurface;
use super::medium::Conductor;

/// Fourier number `at/L²` below which the back has no influence.
const SHORT: f64 = 0.01;
/// Number of terms of the series; the last one is below rounding from the short time on.
const TERMS: usize = 30;

/// The slab and its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvectiveSlab {
    pub body: Conductor,
    /// Thickness L [m].
    pub thickness: f64,
    /// Heat transfer coefficient h [W/(m² K)].
    pub coefficient: f64,
    /// Temperature of the fluid above that of the slab at time 0, ΔT∞ [K].
    pub ambient: f64,
}

impl ConvectiveSlab {
    /// Temperature rise [K] `ΔT∞ [1 − Σ 4 sin ζ / (2ζ + sin 2ζ) · e^{−ζ²F} cos(ζ (1 − z/L))]` over the
    /// roots of `ζ tan ζ = hL/k`, `F = at/L²`; at short times that of the half space.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        let Self { body, thickness, coefficient, ambient } = *self;
        let fourier = body.diffusivity() * t / (thickness * thickness);
        if fourier < SHORT {
            return ConvectiveSurface { body, coefficient, ambient }.rise(z, t);
        }
        let biot = coefficient * thickness / body.conductivity;
        let term = |n: usize| {
            let zeta = root(biot, n);
            let amplitude = 4.0 * zeta.sin() / (2.0 * zeta + (2.0 * zeta).sin());
            amplitude * (-zeta * zeta * fourier).exp() * (zeta * (1.0 - z / thickness)).cos()
        };
        ambient * (1.0 - (0..TERMS).rev().map(term).sum::<f64>())
    }
}

/// The root of `ζ tan ζ = Bi` in `[nπ, nπ + π/2]`, by bisection.
fn root(biot: f64, n: usize) -> f64 {
    let excess = |zeta: f64| zeta * zeta.sin() - biot * zeta.cos();
    let (mut low, mut high) = (n as f64 * PI, (n as f64 + 0.5) * PI);
    let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if sign * excess(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, assert_close, assert_heat_equation};
    use super::*;

    const SLAB: ConvectiveSlab =
        ConvectiveSlab { body: ALUMINA, thickness: 1e-3, coefficient: 5e4, ambient: 80.0 };

    #[test]
    fn obeys_the_heat_equation_and_tends_to_the_fluid_temperature() {
        let unit = 1e-6 / ALUMINA.diffusivity();
        let at = [0.0, 0.0, 4e-4];
        assert_heat_equation(
            |x, t| SLAB.rise(x[2], t),
            ALUMINA.diffusivity(),
            at,
            0.1 * unit,
            1e-6,
        );
        assert_close(SLAB.rise(1e-3, 50.0 * unit), 80.0, 1e-9);
    }

    #[test]
    fn series_continues_the_half_space_solution() {
        let unit = 1e-6 / ALUMINA.diffusivity();
        let (before, after) = (SHORT * unit * (1.0 - 1e-9), SHORT * unit * (1.0 + 1e-9));
        for z in [0.0, 1e-4, 3e-4] {
            assert_close(SLAB.rise(z, after), SLAB.rise(z, before), 1e-7);
        }
    }
}

//! Slab `0 ≤ z ≤ L` at zero, under a constant flux q on the face `z = 0` from time 0 on.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959,
//! §3.8 and §12.5 (images of the half space, for early times).

use std::f64::consts::PI;

use super::medium::Conductor;
use super::special::ierfc;

/// Fourier number `at/L²` below which images replace the series. Both are accurate to rounding there.
const EARLY: f64 = 0.2;
/// Number of images, or of terms of a series.
const TERMS: u32 = 8;

/// The slab and its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatedSlab {
    pub body: Conductor,
    /// Flux q into the face `z = 0` [W/m²].
    pub flux: f64,
    /// Thickness L [m].
    pub thickness: f64,
}

impl HeatedSlab {
    /// Temperature rise [K], the back insulated. With `F = at/L²`, `ζ = z/L`:
    /// `qL/k [F + (1−ζ)²/2 − 1/6 − 2/π² Σ e^{−n²π²F} cos(nπζ)/n²]`, n from 1.
    pub fn rise_with_insulated_back(&self, z: f64, t: f64) -> f64 {
        let (fourier, zeta) = (self.fourier(t), z / self.thickness);
        if fourier < EARLY {
            return self.images(zeta, fourier, 1.0);
        }
        let series = sum(1, |n| {
            let m = n * PI;
            (-m * m * fourier).exp() * (m * zeta).cos() / (m * m)
        });
        let depth = 1.0 - zeta;
        self.scale() * (fourier + 0.5 * depth * depth - 1.0 / 6.0 - 2.0 * series)
    }

    /// Temperature rise [K], the back held at zero:
    /// `qL/k [1 − ζ − 2 Σ e^{−m²F} cos(mζ)/m²]`, `m = (n + ½)π`, n from 0.
    pub fn rise_with_held_back(&self, z: f64, t: f64) -> f64 {
        let (fourier, zeta) = (self.fourier(t), z / self.thickness);
        if fourier < EARLY {
            return self.images(zeta, fourier, -1.0);
        }
        let series = sum(0, |n| {
            let m = (n + 0.5) * PI;
            (-m * m * fourier).exp() * (m * zeta).cos() / (m * m)
        });
        self.scale() * (1.0 - zeta - 2.0 * series)
    }

    /// Temperature above that of the ambient behind the slab for `t → ∞` [K], the back convective
    /// with the `coefficient` h [W/(m² K)]: `q (L − z)/k + q/h`. With `h = ∞` the back is held.
    pub fn steady_rise_with_convective_back(&self, z: f64, coefficient: f64) -> f64 {
        self.flux * ((self.thickness - z) / self.body.conductivity + 1.0 / coefficient)
    }

    /// `qL/k · 2√F Σ pⁿ [ierfc((2n+ζ)/2√F) + p ierfc((2n+2−ζ)/2√F)]`, with the parity `p` of the
    /// image in the back: 1 insulated, −1 held.
    fn images(&self, zeta: f64, fourier: f64, parity: f64) -> f64 {
        if fourier <= 0.0 {
            return 0.0;
        }
        let s = 2.0 * fourier.sqrt();
        let series = sum(0, |n| {
            let pair = ierfc((2.0 * n + zeta) / s) + parity * ierfc((2.0 * n + 2.0 - zeta) / s);
            parity.powi(n as i32) * pair
        });
        self.scale() * s * series
    }

    fn fourier(&self, t: f64) -> f64 {
        self.body.diffusivity() * t / (self.thickness * self.thickness)
    }

    fn scale(&self) -> f64 {
        self.flux * self.thickness / self.body.conductivity
    }
}

/// Sum of a series from its last term to its first.
fn sum(first: u32, term: impl Fn(f64) -> f64) -> f64 {
    (first..=TERMS).rev().map(|n| term(f64::from(n))).sum()
}

#[cfg(test)]
mod tests {
    use super::super::checks::{
        ALUMINA, assert_close, assert_heat_equation, assert_within, derivative, derivative_at_left,
    };
    use super::super::half_space_flux::UniformFlux;
    use super::super::quadrature::integrate;
    use super::*;

    const SLAB: HeatedSlab = HeatedSlab { body: ALUMINA, flux: 1e6, thickness: 0.26e-3 };

    /// Time [s] of a Fourier number.
    fn time(fourier: f64) -> f64 {
        fourier * SLAB.thickness.powi(2) / ALUMINA.diffusivity()
    }

    #[test]
    fn series_and_images_agree() {
        for z in [0.0, 0.4 * SLAB.thickness, 0.9 * SLAB.thickness] {
            for rise in [HeatedSlab::rise_with_insulated_back, HeatedSlab::rise_with_held_back] {
                let (early, late) = (time(EARLY * (1.0 - 1e-13)), time(EARLY * (1.0 + 1e-13)));
                assert_close(rise(&SLAB, z, early), rise(&SLAB, z, late), 1e-11);
            }
        }
    }

    #[test]
    fn both_obey_the_heat_equation_and_the_conditions_on_their_faces() {
        let (k, length) = (ALUMINA.conductivity, SLAB.thickness);
        for t in [time(0.05), time(0.5)] {
            let at = [0.0, 0.0, 0.3 * length];
            let insulated = |x: [f64; 3], t| SLAB.rise_with_insulated_back(x[2], t);
            let held = |x: [f64; 3], t| SLAB.rise_with_held_back(x[2], t);
            assert_heat_equation(insulated, ALUMINA.diffusivity(), at, t, 0.01 * length);
            assert_heat_equation(held, ALUMINA.diffusivity(), at, t, 0.01 * length);
            let h = 0.005 * length;
            let front = derivative_at_left(|z| SLAB.rise_with_insulated_back(z, t), 0.0, h);
            assert_close(-k * front, SLAB.flux, 1e-6);
            let back = derivative(|z| SLAB.rise_with_insulated_back(z, t), length, h);
            assert_within(-k * back / SLAB.flux, 0.0, 1e-9);
            let front = derivative_at_left(|z| SLAB.rise_with_held_back(z, t), 0.0, h);
            assert_close(-k * front, SLAB.flux, 1e-6);
            assert_within(SLAB.rise_with_held_back(length, t), 0.0, 1e-12);
        }
    }

    #[test]
    fn insulated_slab_keeps_all_heat() {
        for t in [time(0.01), time(0.19), time(3.0)] {
            let rise = |z| SLAB.rise_with_insulated_back(z, t);
            let content = ALUMINA.heat_capacity * integrate(rise, &[0.0, SLAB.thickness]);
            assert_close(content, SLAB.flux * t, 1e-10);
        }
    }

    #[test]
    fn early_slab_is_a_half_space_and_late_held_slab_is_steady() {
        let uniform = UniformFlux { body: ALUMINA, flux: SLAB.flux };
        let t = time(0.01);
        for rise in [SLAB.rise_with_insulated_back(2e-5, t), SLAB.rise_with_held_back(2e-5, t)] {
            assert_close(rise, uniform.rise(2e-5, t), 1e-12);
        }
        let steady = SLAB.steady_rise_with_convective_back(1e-4, f64::INFINITY);
        assert_close(SLAB.rise_with_held_back(1e-4, time(20.0)), steady, 1e-14);
        assert_eq!(SLAB.rise_with_insulated_back(0.0, 0.0), 0.0);
    }

    #[test]
    fn convective_back_passes_the_flux() {
        let h = 5e3;
        let back = SLAB.steady_rise_with_convective_back(SLAB.thickness, h);
        assert_close(h * back, SLAB.flux, 1e-14);
    }
}

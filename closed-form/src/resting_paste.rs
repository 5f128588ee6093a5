//! Shapes in which a thin layer of a yield-stress fluid comes to rest on a horizontal plate.
//!
//! A spreading layer stops where the yield stress at the plate balances the pressure gradient, `ρg h |dh/dr| = τ₀`. At
//! the distance d from the edge the thickness is `h = √(2τ₀d/(ρg))`, whence, from their volumes,
//!
//! - drop of the volume V [m³]: `R = (225 ρg V²/(128 π² τ₀))^{1/5}`;
//! - line of the section A [m²]: half-width `w = (9 A² ρg/(32 τ₀))^{1/3}`;
//! - line that surface tension σ [N/m] spreads on a plate that it wets, instead of gravity: `σ h h''' = τ₀`, with h'
//!   = 0 in the middle and h = h' = 0 at the edge: half-width `w = 1.210937 (σA²/τ₀)^{1/5}`.
//!
//! Valid for `h ≪ R`, layers that spread to rest from a thicker state without inertia, and the first two for
//! negligible surface tension (`ρg h² ≫ σ`), the last for negligible gravity (`ρg w² ≪ σ`). Tresca's and von Mises'
//! criteria agree in thin layers, whose stress is pure shear.
//!
//! Sources: N. Roussel and P. Coussot (2005), J. Rheol. 49, 705–718, doi 10.1122/1.1879041 (drop); the lines follow
//! from the same balance. The scaling with surface tension is that of J. van der Kolk, D. Tieman and M. Jalaal
//! (2023), J. Fluid Mech. 958, A34.

use std::f64::consts::PI;

/// Half-width of a line that surface tension spreads, over `(σA²/τ₀)^{1/5}`: by integration of its shape.
const TENSION_SPREADS: f64 = 1.210937;

/// The fluid and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestingPaste {
    /// Yield stress τ₀ [Pa].
    pub yield_stress: f64,
    /// Weight per volume ρg [N/m³].
    pub weight: f64,
}

impl RestingPaste {
    /// Thickness [m] at a distance from the edge [m].
    pub fn thickness(&self, from_edge: f64) -> f64 {
        (2.0 * self.yield_stress * from_edge.max(0.0) / self.weight).sqrt()
    }

    /// Radius R [m] of a drop of the volume V [m³].
    pub fn drop_radius(&self, volume: f64) -> f64 {
        (225.0 / (128.0 * PI * PI) * volume.powi(2) * self.weight / self.yield_stress).powf(0.2)
    }

    /// Half of the width w [m] of a line of the section A [m²].
    pub fn line_half_width(&self, section: f64) -> f64 {
        (9.0 / 32.0 * section.powi(2) * self.weight / self.yield_stress).cbrt()
    }

    /// Half of the width w [m] of a line of the section A [m²] that a surface tension σ [N/m] spreads instead of
    /// gravity.
    pub fn tension_half_width(&self, section: f64, tension: f64) -> f64 {
        TENSION_SPREADS * (tension * section.powi(2) / self.yield_stress).powf(0.2)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const PASTE: RestingPaste = RestingPaste { yield_stress: 50.0, weight: 2000.0 * 9.81 };

    #[test]
    fn digits_of_a_litre_and_of_a_square_centimetre() {
        assert_close(PASTE.drop_radius(1e-3), 0.14753, 4e-5);
        assert_close(PASTE.line_half_width(1e-4), 10.33e-3, 5e-4);
    }

    #[test]
    fn shapes_hold_their_volumes() {
        let radius = PASTE.drop_radius(1e-3);
        let ring = |r: f64| 2.0 * PI * r * PASTE.thickness(radius - r);
        assert_close(integrate(ring, &[0.0, radius]), 1e-3, 1e-9);
        let half = PASTE.line_half_width(1e-4);
        let section = 2.0 * integrate(|x| PASTE.thickness(half - x), &[0.0, half]);
        assert_close(section, 1e-4, 1e-9);
    }

    #[test]
    fn pressure_gradient_bears_the_yield_stress() {
        for d in [1e-3, 0.03, 0.1] {
            let slope = derivative(|d| PASTE.thickness(d), d, 1e-2 * d);
            assert_close(PASTE.weight * PASTE.thickness(d) * slope, 50.0, 1e-9);
        }
        assert_eq!(PASTE.thickness(-1e-3), 0.0);
    }

    /// The layer that its edge holds: the balance of forces over the whole radius, `½ρgh₀² = ∫τ₀ dr`.
    #[test]
    fn pressure_in_the_middle_is_the_friction_up_to_the_edge() {
        let radius = PASTE.drop_radius(1e-3);
        let push = 0.5 * PASTE.weight * PASTE.thickness(radius).powi(2);
        assert_close(push, PASTE.yield_stress * radius, 1e-13);
    }

    /// Shape `h h''' = −1` in the distance d from the edge: `√(8/3) d^{3/2} − d^m` next to it, with
    /// `m (m − 1)(m − 2) = 3/8`, and level in the middle. The state is h, h', h'' and the integral of h.
    #[test]
    fn line_under_tension_by_integration() {
        let (edge, power) = (1e-4_f64, 2.151387818865997_f64);
        assert_close(power * (power - 1.0) * (power - 2.0), 0.375, 1e-13);
        let term = |factor: f64, m: f64| {
            let slopes = [1.0, m, m * (m - 1.0)];
            let derivatives = [0, 1, 2].map(|n| factor * slopes[n] * edge.powf(m - n as f64));
            let [h, slope, bend] = derivatives;
            [h, slope, bend, factor * edge.powf(m + 1.0) / (m + 1.0)]
        };
        let (main, other) = (term((8.0_f64 / 3.0).sqrt(), 1.5), term(-1.0, power));
        let mut state = [0, 1, 2, 3].map(|n| main[n] + other[n]);
        let rate = |s: [f64; 4]| [s[1], s[2], -1.0 / s[0], s[0]];
        let ahead = |s: [f64; 4], r: [f64; 4], by: f64| [0, 1, 2, 3].map(|n| s[n] + by * r[n]);
        let mut d = edge;
        while state[1] > 0.0 {
            let step = 0.01 * d.min(0.05);
            let a = rate(state);
            let b = rate(ahead(state, a, 0.5 * step));
            let c = rate(ahead(state, b, 0.5 * step));
            let e = rate(ahead(state, c, step));
            let mean = [0, 1, 2, 3].map(|n| (a[n] + 2.0 * (b[n] + c[n]) + e[n]) / 6.0);
            state = ahead(state, mean, step);
            d += step;
        }
        let beyond = -state[1] / state[2];
        let (half, section) = (d + beyond, 2.0 * (state[3] + beyond * state[0]));
        let paste = RestingPaste { yield_stress: 1.0, weight: 0.0 };
        assert_close(paste.tension_half_width(section, 1.0), half, 1e-6);
        assert_close(2.0 * paste.tension_half_width(1.0, 1.0), 2.42, 1e-3);
    }
}

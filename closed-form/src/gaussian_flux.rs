//! Half space `z ≥ 0` at zero under a Gaussian flux that starts at time 0 at the origin and moves along x at a constant
//! speed, or stays.
//!
//! Sources: H. E. Cline and T. R. Anthony, J. Appl. Phys. 48 (1977) 3895–3900, doi 10.1063/1.324261 (moving); M. Lax,
//! J. Appl. Phys. 48 (1977) 3919–3924, doi 10.1063/1.324265 (at rest).

use std::f64::consts::{FRAC_PI_2, PI};

use super::medium::Conductor;
use super::quadrature::integrate;

/// Flux `q₀ exp(−2 ((x − vt)² + y²)/w²) = q₀ exp(−((x − vt)² + y²)/W²)`, `W = w/√2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianFlux {
    pub body: Conductor,
    /// Peak flux q₀ into the body [W/m²].
    pub peak: f64,
    /// Radius w at which the flux is q₀/e² [m].
    pub radius: f64,
    /// Velocity v of the source along x [m/s], of either sign; 0 for a source at rest.
    pub velocity: f64,
}

impl GaussianFlux {
    /// Flux into the surface [W/m²] at a point (x, y).
    pub fn flux(&self, x: f64, y: f64, t: f64) -> f64 {
        let r = (x - self.velocity * t).hypot(y) / self.radius;
        self.peak * (-2.0 * r * r).exp()
    }

    /// Power of the source [W] `P = π q₀ W²`.
    pub fn power(&self) -> f64 {
        0.5 * PI * self.peak * self.radius * self.radius
    }

    /// Temperature rise [K] at a point (x, y, z), to 1e-9 relative, if the distances from the point to the source and
    /// to its start are below some 10⁴ radii.
    pub fn rise(&self, at: [f64; 3], t: f64) -> f64 {
        self.rise_near_source([at[0] - self.velocity * t, at[1], at[2]], t)
    }

    /// Temperature rise [K] at a point (ξ, y, z) from the centre of the source, when the source
    /// has been on for a `duration` [s]; with an infinite one, the quasi-steady state.
    ///
    /// A time τ ago the source stood at `−vτ`, and its heat has spread to
    /// `ΔT = 2q₀√a/(k√π) ∫ W²/(W²+4aτ) exp(−z²/4aτ − ((ξ+vτ)² + y²)/(W²+4aτ)) d√τ`.
    /// With `√(4aτ) = W tan φ` this is
    /// `ΔT = q₀W/(k√π) ∫ exp(−z²/(W tan φ)² − ((ξ+vτ)² + y²) cos²φ/W²) dφ`,
    /// from 0 to `atan(√(4at)/W)`, which is bounded and smooth on a finite range.
    pub fn rise_near_source(&self, at: [f64; 3], duration: f64) -> f64 {
        if duration <= 0.0 {
            return 0.0;
        }
        let ([xi, y, z], width) = (at, self.width());
        let four_a = 4.0 * self.body.diffusivity();
        let integrand = |phi: f64| {
            let (sine, cosine) = phi.sin_cos();
            let depth = z * cosine / (width * sine);
            let since = (width * sine / cosine).powi(2) / four_a;
            let along = (xi + self.velocity * since) * cosine / width;
            let across = y * cosine / width;
            (-depth * depth - along * along - across * across).exp()
        };
        let scale = self.peak * width / (self.body.conductivity * PI.sqrt());
        scale * integrate(integrand, &self.angles(at, duration))
    }

    /// Temperature rise [K] at the origin under a source at rest, `q₀W/(k√π) · atan(√(4at)/W)`.
    pub fn rise_at_centre_at_rest(&self, t: f64) -> f64 {
        let width = self.width();
        let scale = self.peak * width / (self.body.conductivity * PI.sqrt());
        scale * (self.body.diffusion_length(t) / width).atan()
    }

    /// Radius W at which the flux is q₀/e [m].
    fn width(&self) -> f64 {
        self.radius / 2f64.sqrt()
    }

    /// Range of φ, split where the integrand may rise or peak: when heat has spread over the distance d, when the
    /// source passed (`τ = −ξ/v`), at the saddle point of a point source (`τ = d/v`) and where motion outruns
    /// conduction (`τ = 4a/v²`).
    fn angles(&self, [xi, y, z]: [f64; 3], duration: f64) -> Vec<f64> {
        let (width, a, speed) = (self.width(), self.body.diffusivity(), self.velocity.abs());
        let square = xi * xi + y * y + z * z;
        let mut times: Vec<_> = (0..7).map(|n| square / (4.0 * a * 3f64.powi(n))).collect();
        if speed > 0.0 {
            times.extend([1.0, 6.0, 40.0].map(|m| m * 4.0 * a / (speed * speed)));
            for centre in [(-xi / self.velocity).max(0.0), square.sqrt() / speed] {
                let spread = (width * width + 4.0 * a * centre).sqrt() / speed;
                times.extend([-6.0, -2.0, 0.0, 2.0, 6.0].map(|m| centre + m * spread));
            }
        }
        let angle = |tau: f64| ((4.0 * a * tau).sqrt() / width).atan();
        let end = angle(duration).min(FRAC_PI_2);
        let mut angles = vec![0.0, end];
        angles.extend(times.into_iter().filter(|t| *t > 0.0 && *t < duration).map(angle));
        angles.sort_by(f64::total_cmp);
        angles
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{
        ALUMINA, assert_close, assert_heat_equation, assert_within, derivative_at_left,
    };
    use super::super::half_space_flux::UniformFlux;
    use super::*;

    const AT_REST: GaussianFlux =
        GaussianFlux { body: ALUMINA, peak: 1e8, radius: 50e-6, velocity: 0.0 };

    /// `(velocity, point, time, rise)`, the rise from the integral over √τ with 25 digits.
    const REFERENCE: [(f64, [f64; 3], f64, f64); 6] = [
        (0.0, [0.0, 0.0, 0.0], 1e-3, 249.1532597071748),
        (0.0, [200e-6, 0.0, 100e-6], 1e-3, 0.1211002566057619),
        (0.1, [30e-6, -20e-6, 15e-6], 1e-3, 59.6743339408866),
        (1.0, [-200e-6, 0.0, 0.0], 2e-3, 0.09747360863984033),
        (2.0, [1e-3, 10e-6, 5e-6], 1e-3, 5.548447628216287),
        (2.0, [1e-3, 0.0, 0.0], 1e-3, 5.655106759867964),
    ];

    #[test]
    fn matches_multiprecision_values() {
        for (velocity, at, t, rise) in REFERENCE {
            assert_close(GaussianFlux { velocity, ..AT_REST }.rise(at, t), rise, 1e-9);
        }
    }

    #[test]
    fn centre_at_rest_is_the_closed_form_at_all_times() {
        for t in [1e-9, 1e-6, 1e-3, 1.0, 1e6, f64::INFINITY] {
            let closed = AT_REST.rise_at_centre_at_rest(t);
            assert_close(AT_REST.rise([0.0; 3], t.min(1e300)), closed, 1e-10);
        }
        let early = UniformFlux { body: ALUMINA, flux: 1e8 }.rise(0.0, 1e-9);
        assert_close(AT_REST.rise([0.0; 3], 1e-9), early, 1e-5);
    }

    #[test]
    fn obeys_the_heat_equation_and_its_surface_condition() {
        let (a, t) = (ALUMINA.diffusivity(), 5e-4);
        for velocity in [0.0, 0.2, -0.2] {
            let source = GaussianFlux { velocity, ..AT_REST };
            let at = [velocity * t + 30e-6, -20e-6, 15e-6];
            assert_heat_equation(|x, t| source.rise(x, t), a, at, t, 3e-6);
            let below = |z: f64| source.rise([at[0], at[1], z], t);
            let flux = -ALUMINA.conductivity * derivative_at_left(below, 0.0, 1e-6);
            assert_close(flux, source.flux(at[0], at[1], t), 1e-5);
        }
    }

    #[test]
    fn narrow_source_matches_rosenthals_moving_point() {
        let source = GaussianFlux { radius: 1e-7, peak: 1e12, velocity: 0.5, ..AT_REST };
        let (a, k) = (ALUMINA.diffusivity(), ALUMINA.conductivity);
        for at in [[-90e-6_f64, 10e-6, 20e-6], [20e-6, 0.0, 10e-6], [-2e-3, 0.0, 0.0]] {
            let d = (at[0] * at[0] + at[1] * at[1] + at[2] * at[2]).sqrt();
            let decay = (-source.velocity * (d + at[0]) / (2.0 * a)).exp();
            let rosenthal = source.power() / (2.0 * PI * k * d) * decay;
            assert_close(source.rise_near_source(at, f64::INFINITY), rosenthal, 1e-4);
        }
    }

    #[test]
    fn narrow_source_at_rest_matches_a_continuous_point_source() {
        let source = GaussianFlux { radius: 1e-7, peak: 1e12, ..AT_REST };
        for t in [3e-5, 3e-4, 3.0, 3e4] {
            let d = 50e-6_f64.hypot(40e-6);
            let point = source.power() / (2.0 * PI * ALUMINA.conductivity * d);
            let expected = point * libm::erfc(d / ALUMINA.diffusion_length(t));
            assert_close(source.rise([50e-6, 0.0, 40e-6], t), expected, 2e-3);
        }
    }

    #[test]
    fn both_directions_mirror_and_the_past_is_cold() {
        let (right, left) = (0.5, -0.5);
        let rise = |velocity: f64, x: f64| {
            GaussianFlux { velocity, ..AT_REST }.rise([x, 5e-6, 3e-6], 1e-3)
        };
        assert_close(rise(right, 300e-6), rise(left, -300e-6), 1e-12);
        assert_eq!(AT_REST.rise([0.0; 3], 0.0), 0.0);
        assert_within(AT_REST.rise([1.0, 0.0, 0.0], 1e-3), 0.0, 1e-300);
    }
}

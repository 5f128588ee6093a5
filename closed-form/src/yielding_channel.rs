//! Steady laminar flow of a Herschel–Bulkley fluid between plates, and of a film of it down an incline.
//!
//! The shear stress grows linearly from 0 at the middle of the channel, or at the surface of the film. With the force
//! per volume G [Pa/m] (pressure gradient, or ρg sin θ) the fluid within `y_p = τ₀/G` of there moves as a plug.
//! Beyond, with the half-width or thickness h [m] and `a = h − y_p`, at the distance s from the middle or the
//! surface, `u = n/(n+1) (G/k)^{1/n} [a^{(n+1)/n} − (s − y_p)^{(n+1)/n}]`. For `h ≤ y_p` all of it is at rest. Exact
//! for fully developed flow; the film needs negligible drag of the air.
//!
//! Source: R. B. Bird, W. E. Stewart and E. N. Lightfoot, *Transport Phenomena*, 2nd ed., Wiley 2007, §8.3, for
//! generalised Newtonian fluids; from `τ = Gs` and the law by integration.

use super::herschel_bulkley::HerschelBulkley;
use super::quadrature::integrate;

/// Half of a channel, from the middle to a plate: also a film, from its surface down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layer {
    fluid: HerschelBulkley,
    /// G [Pa/m]
    force: f64,
    /// h [m]
    thickness: f64,
}

impl Layer {
    fn plug(&self) -> f64 {
        self.fluid.yield_stress / self.force
    }

    /// Velocity at the distance s from the stress-free end.
    fn velocity(&self, s: f64) -> f64 {
        let HerschelBulkley { consistency, exponent, .. } = self.fluid;
        let sheared = (self.thickness - self.plug()).max(0.0);
        let power = |x: f64| x.powf(1.0 + 1.0 / exponent);
        let scale = exponent / (exponent + 1.0) * (self.force / consistency).powf(1.0 / exponent);
        scale * (power(sheared) - power((s - self.plug()).clamp(0.0, sheared)))
    }

    /// Flow per width [m²/s]: the plug, and the sheared fluid, whose mean is (n+1)/(2n+1) of the plug's velocity.
    fn flow(&self) -> f64 {
        let sheared = (self.thickness - self.plug()).max(0.0);
        let n = self.fluid.exponent;
        self.velocity(0.0) * (self.plug() + sheared * (n + 1.0) / (2.0 * n + 1.0))
    }
}

/// Flow between plates under a pressure gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingChannel {
    pub fluid: HerschelBulkley,
    /// Pressure gradient G, positive along the flow [Pa/m].
    pub gradient: f64,
    /// Distance H of the plates [m].
    pub width: f64,
}

impl YieldingChannel {
    /// Half of the plug's width τ₀/G [m]: the flow is at rest where that is H/2 or more.
    pub fn plug(&self) -> f64 {
        self.half().plug()
    }

    /// Velocity [m/s] at the distance y from a plate.
    pub fn velocity(&self, y: f64) -> f64 {
        self.half().velocity((y - 0.5 * self.width).abs())
    }

    /// Flow per width [m²/s].
    pub fn flow(&self) -> f64 {
        2.0 * self.half().flow()
    }

    /// Shear rate at the plates [1/s].
    pub fn wall_rate(&self) -> f64 {
        self.fluid.rate(0.5 * self.gradient * self.width)
    }

    /// Velocity [m/s] of the fluid whose law is regularised below the rate γ̇₀ `least`, by quadrature.
    pub fn regularised_velocity(&self, y: f64, least: f64) -> f64 {
        let [half, joint] = [0.5 * self.width, self.fluid.stress(least) / self.gradient];
        let s = (y - half).abs();
        let rate = |s: f64| self.fluid.regularised_rate(self.gradient * s, least);
        integrate(rate, &[s, joint.clamp(s, half), half])
    }

    fn half(&self) -> Layer {
        Layer { fluid: self.fluid, force: self.gradient, thickness: 0.5 * self.width }
    }
}

/// Film that flows down an incline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingFilm {
    pub fluid: HerschelBulkley,
    /// Weight along the incline, ρg sin θ [N/m³].
    pub weight: f64,
    /// Thickness h normal to the incline [m].
    pub thickness: f64,
}

impl YieldingFilm {
    /// Thickness of the plug at the surface `h_p = τ₀/(ρg sin θ)` [m]: a film that is no thicker stays at rest.
    pub fn plug(&self) -> f64 {
        self.layer().plug()
    }

    /// Velocity [m/s] at the height z above the incline.
    pub fn velocity(&self, z: f64) -> f64 {
        self.layer().velocity(self.thickness - z)
    }

    /// Flow per width [m²/s].
    pub fn flow(&self) -> f64 {
        self.layer().flow()
    }

    fn layer(&self) -> Layer {
        Layer { fluid: self.fluid, force: self.weight, thickness: self.thickness }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    /// Benchmark of Park §2.6.
    const PARK: YieldingChannel = YieldingChannel {
        fluid: HerschelBulkley { yield_stress: 0.5, consistency: 0.5, exponent: 0.5 },
        gradient: 10.0,
        width: 0.5,
    };

    #[test]
    fn park_digits() {
        assert_close(PARK.plug(), 0.05, 1e-14);
        for (y, speed) in [(0.25, 1.066667), (0.05, 0.616667), (0.1, 0.933333), (0.15, 1.05)] {
            assert_close(PARK.velocity(y), speed, 1e-6);
            assert_close(PARK.velocity(0.5 - y), speed, 1e-6);
        }
        assert_close(PARK.flow(), 0.426667, 1e-6);
        assert_close(PARK.flow() / PARK.width, 0.853333, 1e-6);
        assert_close(PARK.wall_rate(), 16.0, 1e-12);
        assert_close(PARK.fluid.viscosity(PARK.wall_rate()), 0.15625, 1e-12);
        assert_close(PARK.regularised_velocity(0.25, 1e-3), 1.066692, 5e-7);
    }

    #[test]
    fn stress_balances_the_gradient() {
        for exponent in [0.4, 1.0, 1.7] {
            let channel =
                YieldingChannel { fluid: HerschelBulkley { exponent, ..PARK.fluid }, ..PARK };
            for y in [0.02, 0.11, 0.19] {
                let rate = derivative(|y| channel.velocity(y), y, 1e-4);
                let stress = channel.gradient * (0.25 - y);
                assert_close(channel.fluid.stress(rate), stress, 1e-6);
            }
            let flow = integrate(|y| channel.velocity(y), &[0.0, 0.2, 0.3, 0.5]);
            assert_close(channel.flow(), flow, 1e-9);
            assert_close(channel.velocity(0.0), 0.0, 0.0);
        }
    }

    #[test]
    fn regularised_flow_tends_to_the_true_one_and_creeps_where_that_rests() {
        let excess =
            |least: f64| PARK.regularised_velocity(0.25, least) / PARK.velocity(0.25) - 1.0;
        assert!(excess(1e-6) > 0.0 && excess(1e-6) < 1e-2 * excess(1e-3));
        let resting = YieldingChannel { gradient: 1.5, ..PARK };
        assert_eq!([resting.velocity(0.25), resting.flow()], [0.0, 0.0]);
        let creep = 0.5 * resting.gradient * 0.25_f64.powi(2) / PARK.fluid.viscosity(1e-3);
        assert_close(resting.regularised_velocity(0.25, 1e-3), creep, 1e-11);
    }

    #[test]
    fn film_is_half_a_channel_and_stops_at_its_plug() {
        let film = YieldingFilm { fluid: PARK.fluid, weight: 10.0, thickness: 0.25 };
        assert_close(film.velocity(0.1), PARK.velocity(0.1), 1e-13);
        assert_close(film.flow(), 0.5 * PARK.flow(), 1e-13);
        // u_s = n/(n+1) (ρg sin θ/k)^{1/n} (h − h_p)^{(n+1)/n} = 1/3 · 400 · 0.008.
        assert_close(film.velocity(0.25), 400.0 / 3.0 * 0.008, 1e-12);
        let drop = |z: f64| film.fluid.stress(derivative(|z| film.velocity(z), z, 1e-4));
        assert_close(drop(0.05), film.weight * 0.2, 1e-6);
        for thickness in [0.02, film.plug()] {
            let thin = YieldingFilm { thickness, ..film };
            assert_eq!([thin.velocity(thickness), thin.flow()], [0.0, 0.0]);
        }
        let thicker = YieldingFilm { thickness: 1.01 * film.plug(), ..film };
        assert!(thicker.flow() > 0.0);
    }
}

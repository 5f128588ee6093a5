//! Steady laminar flow of a Herschel–Bulkley fluid through a round pipe.
//!
//! With the pressure gradient G [Pa/m] and the radius R [m] the wall bears `τ_w = GR/2`; within `r_p = 2τ₀/G` the
//! fluid moves as a plug. With `φ = τ₀/τ_w` the flow is
//! `Q = πR³ n (τ_w/k)^{1/n} (1−φ)^{(n+1)/n} [(1−φ)²/(3n+1) + 2φ(1−φ)/(2n+1) + φ²/(n+1)]`, for n = 1 that of
//! Buckingham and Reiner, `πR³τ_w/(4k) (1 − 4φ/3 + φ⁴/3)`. Exact for fully developed flow.
//!
//! Sources: E. Buckingham (1921), Proc. ASTM 21, 1154–1156, for n = 1; otherwise from `τ = Gr/2` and the law by
//! integration.

use std::f64::consts::PI;

use super::herschel_bulkley::HerschelBulkley;

/// The pipe and its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingPipe {
    pub fluid: HerschelBulkley,
    /// Pressure gradient G, positive along the flow [Pa/m].
    pub gradient: f64,
    /// Radius R [m].
    pub radius: f64,
}

impl YieldingPipe {
    /// Radius of the plug `2τ₀/G` [m]: the flow is at rest where that is R or more.
    pub fn plug(&self) -> f64 {
        2.0 * self.fluid.yield_stress / self.gradient
    }

    /// Shear stress at the wall [Pa].
    pub fn wall_stress(&self) -> f64 {
        0.5 * self.gradient * self.radius
    }

    /// Velocity [m/s] at the radius r: `n/(n+1) (G/2k)^{1/n} [(R−r_p)^{(n+1)/n} − (r−r_p)^{(n+1)/n}]`, uniform in the
    /// plug.
    pub fn velocity(&self, r: f64) -> f64 {
        let HerschelBulkley { consistency, exponent, .. } = self.fluid;
        let sheared = (self.radius - self.plug()).max(0.0);
        let power = |x: f64| x.powf(1.0 + 1.0 / exponent);
        let rate = (0.5 * self.gradient / consistency).powf(1.0 / exponent);
        let inner = (r - self.plug()).clamp(0.0, sheared);
        exponent / (exponent + 1.0) * rate * (power(sheared) - power(inner))
    }

    /// Flow Q [m³/s].
    pub fn flow(&self) -> f64 {
        let HerschelBulkley { yield_stress, consistency, exponent: n } = self.fluid;
        let plug = (yield_stress / self.wall_stress()).min(1.0);
        let sheared = 1.0 - plug;
        let terms = sheared.powi(2) / (3.0 * n + 1.0)
            + 2.0 * plug * sheared / (2.0 * n + 1.0)
            + plug.powi(2) / (n + 1.0);
        let rate = (self.wall_stress() / consistency).powf(1.0 / n);
        PI * self.radius.powi(3) * n * rate * sheared.powf(1.0 + 1.0 / n) * terms
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    fn pipe(radius: f64, wall: f64, fluid: [f64; 3]) -> YieldingPipe {
        let [yield_stress, consistency, exponent] = fluid;
        let fluid = HerschelBulkley { yield_stress, consistency, exponent };
        YieldingPipe { fluid, gradient: 2.0 * wall / radius, radius }
    }

    #[test]
    fn digits_of_two_fluids() {
        assert_close(pipe(1.0, 2.5, [0.5, 0.5, 0.5]).flow(), 8.900341, 1e-7);
        let bingham = pipe(0.7, 3.0, [1.0, 2.0, 1.0]);
        assert_close(bingham.flow(), 0.226156, 2e-6);
        let phi: f64 = 1.0 / 3.0;
        let bracket = 1.0 - 4.0 / 3.0 * phi + phi.powi(4) / 3.0;
        assert_close(bingham.flow(), PI * 0.343 * 3.0 / 8.0 * bracket, 1e-13);
    }

    #[test]
    fn flow_integrates_the_velocity_and_stress_balances_the_gradient() {
        for exponent in [0.5, 1.0, 1.6] {
            let pipe = pipe(0.8, 3.0, [1.1, 0.7, exponent]);
            let annulus = |r: f64| 2.0 * PI * r * pipe.velocity(r);
            assert_close(pipe.flow(), integrate(annulus, &[0.0, pipe.plug(), 0.8]), 1e-9);
            for r in [0.4, 0.7] {
                let rate = -derivative(|r| pipe.velocity(r), r, 1e-4);
                assert_close(pipe.fluid.stress(rate), 0.5 * pipe.gradient * r, 1e-6);
            }
        }
    }

    #[test]
    fn newtonian_flow_is_poiseuilles_and_weak_gradients_leave_the_fluid_at_rest() {
        let newtonian = pipe(0.5, 2.0, [0.0, 3.0, 1.0]);
        let poiseuille = PI * 0.5_f64.powi(4) * newtonian.gradient / (8.0 * 3.0);
        assert_close(newtonian.flow(), poiseuille, 1e-13);
        let resting = pipe(0.5, 0.9, [1.0, 3.0, 0.6]);
        assert_eq!([resting.flow(), resting.velocity(0.0)], [0.0, 0.0]);
    }
}

//! Elastic half space `z ≥ 0` with inertia whose free surface changes temperature at time 0, strained along z alone.
//!
//! Heat expands the surface, which sends a wave of tension at the speed of sound into a body that compression precedes
//! where heat has come first. With ξ = z c/κ and τ = c² t/κ the stress over `β ΔT`, `β = E α/(1 − 2ν)`, is
//!
//! `H(τ − ξ) e^{τ−ξ} − ½ e^τ [e^{−ξ} erfc(ξ/2√τ − √τ) + e^ξ erfc(ξ/2√τ + √τ)]`,
//!
//! with a jump of 1 at the front. Deformation makes no heat.
//!
//! Source: V. I. Danilovskaya, Prikl. Mat. Mekh. 14 (1950) 316; the form with `erfc` follows by Laplace transformation
//! of `σ_ξξ − σ_ττ = θ_ττ`, and the tests check it against that equation.

use super::special::erfcx;

/// The half space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShockedHalfSpace {
    /// Speed c of waves of pressure [m/s].
    pub speed: f64,
    /// Thermal diffusivity κ [m²/s].
    pub diffusivity: f64,
}

impl ShockedHalfSpace {
    /// Stress along z over β ΔT at a depth [m] and time [s].
    pub fn stress(&self, depth: f64, time: f64) -> f64 {
        let (place, now) = self.scaled(depth, time);
        let front = if place < now { (now - place).exp() } else { 0.0 };
        front + self.continuous_stress(depth, time)
    }

    /// The part of it without the jump: what a body bears ahead of the front.
    pub fn continuous_stress(&self, depth: f64, time: f64) -> f64 {
        if time <= 0.0 {
            return 0.0;
        }
        let (place, now) = self.scaled(depth, time);
        let (half, root) = (0.5 * place / now.sqrt(), now.sqrt());
        // e^{τ±ξ} erfc(ξ/2√τ ± √τ) = e^{−ξ²/4τ} erfcx(ξ/2√τ ± √τ).
        -0.5 * (-half * half).exp() * (erfcx(half - root) + erfcx(half + root))
    }

    /// ξ and τ.
    fn scaled(&self, depth: f64, time: f64) -> (f64, f64) {
        let Self { speed, diffusivity } = *self;
        (depth * speed / diffusivity, speed * speed * time / diffusivity)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_within, second_derivative};
    use super::*;

    const BODY: ShockedHalfSpace = ShockedHalfSpace { speed: 2.0, diffusivity: 0.5 };

    fn at(place: f64, now: f64) -> f64 {
        BODY.stress(place * 0.25, now * 0.125)
    }

    #[test]
    fn stress_at_one_depth_over_time() {
        for (now, stress) in [
            (0.25, -0.172_402),
            (0.5, -0.405_224),
            (1.0 - 1e-9, -0.885_475),
            (1.0 + 1e-9, 0.114_525),
            (2.0, 0.056_876),
            (4.0, 0.025_310),
        ] {
            assert_within(at(1.0, now), stress, 1e-6);
        }
    }

    #[test]
    fn stress_obeys_the_wave_equation_with_heat() {
        let rise = |place: f64, now: f64| libm::erfc(0.5 * place / now.sqrt());
        for (place, now) in [(1.0, 0.4), (1.0, 2.0), (0.3, 0.7), (2.0, 3.0)] {
            let along = second_derivative(|x| at(x, now), place, 0.01);
            let in_time = second_derivative(|t| at(place, t), now, 0.01);
            let source = second_derivative(|t| rise(place, t), now, 0.01);
            assert_within(along - in_time, source, 1e-5);
        }
    }

    #[test]
    fn surface_is_free_and_the_jump_is_one() {
        for now in [0.1, 1.0, 3.0] {
            assert_within(at(0.0, now), 0.0, 1e-13);
            assert_within(at(now - 1e-9, now) - at(now + 1e-9, now), 1.0, 1e-8);
        }
    }
}

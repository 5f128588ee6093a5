//! Neumann's solution of Stefan's problem: a half space `z ≥ 0` that melts or freezes from its surface.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959, §11.2.

use std::f64::consts::PI;

use super::medium::Conductor;

/// A half space in one phase at time 0, whose surface then has a constant temperature beyond the phase change.
///
/// All temperatures are relative to the phase change, positive towards the surface temperature: so melting and freezing
/// are the same. Both phases have one density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeltingFront {
    /// The phase that grows from the surface, and the original one.
    pub new: Conductor,
    pub old: Conductor,
    /// Latent heat per volume, ρL [J/m³].
    pub latent: f64,
    /// Surface temperature relative to the phase change, above 0 [K].
    pub surface: f64,
    /// Initial distance to the phase change, 0 or above [K]: 0 is the one-phase problem.
    pub initial: f64,
}

impl MeltingFront {
    /// λ of the front `s = 2λ√(a₁t)`, by bisection of
    /// `k₁T₁ e^{−λ²}/(√a₁ erf λ) − k₂T₂ e^{−λ²a₁/a₂}/(√a₂ erfc(λ√(a₁/a₂))) = √π λ √a₁ ρL`.
    pub fn growth(&self) -> f64 {
        let [root_new, root_old] = [self.new, self.old].map(|body| body.diffusivity().sqrt());
        let ratio = root_new / root_old;
        let excess = |x: f64| {
            let heated =
                self.new.conductivity * self.surface / root_new * (-x * x).exp() / libm::erf(x);
            // e^{−y²}/erfc y = 1/erfcx y
            let cooled =
                self.old.conductivity * self.initial / root_old / super::special::erfcx(x * ratio);
            heated - cooled - PI.sqrt() * x * root_new * self.latent
        };
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Depth of the front [m].
    pub fn depth(&self, t: f64) -> f64 {
        self.growth() * self.new.diffusion_length(t)
    }

    /// Temperature relative to the phase change [K]: positive in the new phase.
    pub fn rise(&self, z: f64, t: f64) -> f64 {
        let growth = self.growth();
        let (own, other) = (self.new.diffusion_length(t), self.old.diffusion_length(t));
        if z <= growth * own {
            return self.surface * (1.0 - libm::erf(z / own) / libm::erf(growth));
        }
        let ratio = libm::erfc(z / other) / libm::erfc(growth * own / other);
        -self.initial * (1.0 - ratio)
    }

    /// Flux into the body [W/m²], with the sign of the relative temperatures.
    pub fn flux(&self, t: f64) -> f64 {
        let slope = 2.0 / PI.sqrt() / (self.new.diffusion_length(t) * libm::erf(self.growth()));
        self.new.conductivity * self.surface * slope
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    /// Water that freezes under ice.
    const FREEZING: MeltingFront = MeltingFront {
        new: Conductor { conductivity: 2.2, heat_capacity: 2.0e6 },
        old: Conductor { conductivity: 0.57, heat_capacity: 4.2e6 },
        latent: 3.34e8,
        surface: 20.0,
        initial: 10.0,
    };

    #[test]
    fn stefan_condition_at_the_front() {
        for front in [FREEZING, MeltingFront { initial: 0.0, ..FREEZING }] {
            let t = 1e3;
            let depth = front.depth(t);
            let flux = |body: Conductor, z: f64| {
                -body.conductivity * derivative(|z| front.rise(z, t), z, 1e-7)
            };
            let into = flux(front.new, depth - 1e-6);
            let onward = flux(front.old, depth + 1e-6);
            let speed = derivative(|t| front.depth(t), t, 1.0);
            assert_close(into - onward, front.latent * speed, 1e-3);
        }
    }

    #[test]
    fn both_phases_obey_the_heat_equation_and_meet_at_the_change() {
        let (front, t) = (FREEZING, 1e3);
        for (body, z) in [(front.new, 0.4), (front.old, 1.7)] {
            let z = z * front.depth(t);
            let rate = derivative(|t| front.rise(z, t), t, 1.0);
            let bend = super::super::checks::second_derivative(|z| front.rise(z, t), z, 1e-4);
            assert_close(body.diffusivity() * bend, rate, 1e-5);
        }
        assert!(front.rise(front.depth(t), t).abs() < 1e-12);
        assert_close(front.rise(0.0, t), 20.0, 1e-14);
        let slope = derivative(|z| front.rise(z, t), 1e-5, 1e-6);
        assert_close(front.flux(t), -2.2 * slope, 1e-5);
    }

    #[test]
    fn one_phase_front_at_a_stefan_number_of_one() {
        let surface = FREEZING.latent / FREEZING.new.heat_capacity;
        let growth = MeltingFront { surface, initial: 0.0, ..FREEZING }.growth();
        assert_close(growth, 0.620063, 1e-6);
        // √π λ e^{λ²} erf λ = Ste
        let number = PI.sqrt() * growth * (growth * growth).exp() * libm::erf(growth);
        assert_close(number, 1.0, 1e-13);
    }

    #[test]
    fn small_stefan_numbers_are_quasi_steady() {
        // 2λ² = Ste where the sensible heat is small.
        let front = MeltingFront { surface: 0.01, initial: 0.0, ..FREEZING };
        let stefan = front.new.heat_capacity * front.surface / front.latent;
        assert_close(2.0 * front.growth().powi(2), stefan, 1e-4);
    }
}

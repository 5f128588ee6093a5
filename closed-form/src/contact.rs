//! Two half spaces of different temperature brought into perfect contact at time 0.
//!
//! Source: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959,
//! §2.15.

use std::f64::consts::PI;

use super::medium::Conductor;

/// The first body fills `x < 0`, the second `x > 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    pub first: Conductor,
    /// Temperature of the first body before contact [K].
    pub first_temperature: f64,
    pub second: Conductor,
    /// Temperature of the second body before contact [K].
    pub second_temperature: f64,
}

impl Contact {
    /// Temperature of the interface [K] `T_c = (e₁T₁ + e₂T₂)/(e₁ + e₂)`, constant in time.
    pub fn temperature_of_contact(&self) -> f64 {
        let (e1, e2) = (self.first.effusivity(), self.second.effusivity());
        (e1 * self.first_temperature + e2 * self.second_temperature) / (e1 + e2)
    }

    /// Flux from the first into the second body [W/m²] `e₁e₂/(e₁+e₂) (T₁ − T₂)/√(πt)`.
    pub fn flux(&self, t: f64) -> f64 {
        self.strength() / (PI * t).sqrt()
    }

    /// Heat transferred from the first into the second body [J/m²]: the integral of the flux.
    pub fn heat(&self, t: f64) -> f64 {
        2.0 * self.strength() * (t / PI).sqrt()
    }

    /// Temperature [K] `T_c + (T_i − T_c) erf(|x|/2√(a_i t))`.
    pub fn temperature(&self, x: f64, t: f64) -> f64 {
        let contact = self.temperature_of_contact();
        let (body, before) = if x < 0.0 {
            (&self.first, self.first_temperature)
        } else {
            (&self.second, self.second_temperature)
        };
        if x == 0.0 {
            return contact;
        }
        contact + (before - contact) * libm::erf(x.abs() / body.diffusion_length(t))
    }

    /// `e₁e₂/(e₁+e₂) (T₁ − T₂)` [W √s/m²].
    fn strength(&self) -> f64 {
        let (e1, e2) = (self.first.effusivity(), self.second.effusivity());
        e1 * e2 / (e1 + e2) * (self.first_temperature - self.second_temperature)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{
        ALUMINA, WATER, assert_close, assert_heat_equation, derivative_at_left,
    };
    use super::super::quadrature::integrate;
    use super::*;

    const PARK: Contact = Contact {
        first: WATER,
        first_temperature: 373.15,
        second: ALUMINA,
        second_temperature: 293.15,
    };

    #[test]
    fn park_water_on_alumina() {
        assert_close(PARK.temperature_of_contact() - 273.15, 36.499, 2e-5);
        assert_close(PARK.flux(1e-6), 5.550e7, 1e-4);
    }

    #[test]
    fn profiles_obey_the_heat_equation_on_both_sides() {
        let profile = |x: [f64; 3], t| PARK.temperature(x[0], t);
        assert_heat_equation(profile, WATER.diffusivity(), [-1e-6, 0.0, 0.0], 1e-6, 3e-8);
        assert_heat_equation(profile, ALUMINA.diffusivity(), [4e-6, 0.0, 0.0], 1e-6, 1e-7);
    }

    #[test]
    fn both_gradients_at_the_interface_give_the_flux() {
        let t = 1e-6;
        let right = derivative_at_left(|x| PARK.temperature(x, t), 0.0, 2e-8);
        let left = -derivative_at_left(|x| PARK.temperature(-x, t), 0.0, 5e-9);
        assert_close(-ALUMINA.conductivity * right, PARK.flux(t), 1e-7);
        assert_close(-WATER.conductivity * left, PARK.flux(t), 1e-7);
    }

    #[test]
    fn heat_lost_equals_heat_gained_equals_heat_passed() {
        let t = 1e-6;
        let lost = integrate(|x| 373.15 - PARK.temperature(-x, t), &[0.0, 1e-5]);
        let gained = integrate(|x| PARK.temperature(x, t) - 293.15, &[0.0, 5e-5]);
        assert_close(WATER.heat_capacity * lost, PARK.heat(t), 1e-9);
        assert_close(ALUMINA.heat_capacity * gained, PARK.heat(t), 1e-9);
    }

    #[test]
    fn bodies_keep_their_temperature_at_time_zero() {
        assert_eq!(PARK.temperature(-1e-6, 0.0), 373.15);
        assert_eq!(PARK.temperature(1e-6, 0.0), 293.15);
    }
}

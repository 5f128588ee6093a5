//! Two half spaces brought into perfect contact at time 0, one of which freezes: a drop that lands on a cold wall,
//! before heat reaches its top.
//!
//! Indices w, s and l denote wall, frozen and molten fluid; `e = √(k ρc)` is the effusivity, a the diffusivity. All
//! depends on `x/√t`: the temperature T_i of contact is constant, the front lies at `δ = 2λ√(a_s t)`. With
//! `b = λ√(a_s/a_l)`, `T_i = (e_w T_w + e_s T_m/erf λ)/(e_w + e_s/erf λ)` and λ is the root of
//! `e_s (T_m − T_i) e^{−λ²}/erf λ − e_l (T_l − T_m) e^{−b²}/erfc b = √π ρL λ √a_s`.
//!
//! Valid for a fluid at rest whose phases have one density, a sharp melting point without undercooling, contact
//! without resistance, and as long as both bodies are thicker than some `3√(at)`. The fluid freezes only if the
//! temperature of contact without freezing lies below the melting point.
//!
//! Source: Neumann's solution (H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., Oxford 1959,
//! §11.2, case of two media) for the fluid, joined to the wall's solution for a constant surface temperature (§2.4).

use std::f64::consts::PI;

use super::contact::Contact;
use super::medium::Conductor;
use super::melting_front::MeltingFront;

/// The wall and the fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreezingContact {
    pub wall: Conductor,
    /// The frozen fluid, and the molten one.
    pub frozen: Conductor,
    pub molten: Conductor,
    /// Latent heat per volume ρL [J/m³].
    pub latent: f64,
    /// Melting point T_m [K].
    pub melts_at: f64,
    /// Temperatures before contact, T_w of the wall and T_l ≥ T_m of the fluid [K].
    pub wall_temperature: f64,
    pub fluid_temperature: f64,
}

impl FreezingContact {
    /// Returns true if the fluid freezes at all.
    pub fn freezes(&self) -> bool {
        self.unfrozen().temperature_of_contact() < self.melts_at
    }

    /// λ of the front [1]: 0 if the fluid does not freeze.
    pub fn growth(&self) -> f64 {
        if !self.freezes() {
            return 0.0;
        }
        let speed = self.latent * PI.sqrt() * self.frozen.diffusivity().sqrt();
        let ratio = (self.frozen.diffusivity() / self.molten.diffusivity()).sqrt();
        let superheat = self.molten.effusivity() * (self.fluid_temperature - self.melts_at);
        let excess = |x: f64| {
            let drawn = self.frozen.effusivity() * self.undercooling(x) * (-x * x).exp();
            // e^{−b²}/erfc b = 1/erfcx b
            drawn / libm::erf(x) - superheat / super::special::erfcx(x * ratio) - speed * x
        };
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Temperature of contact T_i [K].
    pub fn temperature_of_contact(&self) -> f64 {
        match self.freezes() {
            true => self.melts_at - self.undercooling(self.growth()),
            false => self.unfrozen().temperature_of_contact(),
        }
    }

    /// Thickness δ of the frozen layer [m].
    pub fn front(&self, t: f64) -> f64 {
        self.growth() * self.frozen.diffusion_length(t)
    }

    /// Flux into the wall [W/m²], `e_w (T_i − T_w)/√(πt)`.
    pub fn flux(&self, t: f64) -> f64 {
        let step = self.temperature_of_contact() - self.wall_temperature;
        self.wall.effusivity() * step / (PI * t).sqrt()
    }

    /// Temperature [K] at the distance x from the contact [m], negative in the wall.
    pub fn temperature(&self, x: f64, t: f64) -> f64 {
        if !self.freezes() {
            return self.unfrozen().temperature(-x, t);
        }
        if x < 0.0 {
            let step = self.temperature_of_contact() - self.wall_temperature;
            return self.wall_temperature + step * libm::erfc(-x / self.wall.diffusion_length(t));
        }
        self.melts_at - self.fluid().rise(x, t)
    }

    /// T_m − T_i for a value of λ, from equal fluxes on both sides of the contact.
    fn undercooling(&self, growth: f64) -> f64 {
        let frozen = self.frozen.effusivity() / libm::erf(growth);
        let wall = self.wall.effusivity();
        wall * (self.melts_at - self.wall_temperature) / (wall + frozen)
    }

    /// The fluid's part, whose surface is at T_i.
    fn fluid(&self) -> MeltingFront {
        MeltingFront {
            new: self.frozen,
            old: self.molten,
            latent: self.latent,
            surface: self.melts_at - self.temperature_of_contact(),
            initial: self.fluid_temperature - self.melts_at,
        }
    }

    /// The same contact of the molten fluid alone.
    fn unfrozen(&self) -> Contact {
        Contact {
            first: self.molten,
            first_temperature: self.fluid_temperature,
            second: self.wall,
            second_temperature: self.wall_temperature,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{TIN_ON_STEEL, assert_close, assert_within, derivative};
    use super::*;

    /// Tin on steel as in the digits below, with temperatures of wall and fluid.
    fn tin(wall_temperature: f64, fluid_temperature: f64) -> FreezingContact {
        FreezingContact { wall_temperature, fluid_temperature, ..TIN_ON_STEEL }
    }

    #[test]
    fn four_cases_of_tin_on_steel() {
        let digits = [
            (tin(298.15, 505.0), 0.269269, 468.19, 102.83e-6),
            (tin(298.15, 513.0), 0.254518, 469.79, 97.19e-6),
            (tin(423.15, 505.0), 0.124516, 497.42, 47.55e-6),
            (tin(423.15, 513.0), 0.110241, 498.21, 42.10e-6),
        ];
        for (contact, growth, temperature, front) in digits {
            assert_within(contact.growth(), growth, 5e-7);
            assert_within(contact.temperature_of_contact(), temperature, 5e-3);
            assert_within(contact.front(1e-3), front, 5e-9);
        }
    }

    #[test]
    fn fluxes_balance_at_the_contact_and_at_the_front() {
        let (contact, t, h) = (tin(298.15, 513.0), 1e-3, 1e-8);
        let flux = |body: Conductor, x: f64| {
            body.conductivity * derivative(|x| contact.temperature(x, t), x, h)
        };
        assert_close(flux(contact.wall, -4.0 * h), contact.flux(t), 1e-3);
        assert_close(flux(contact.frozen, 4.0 * h), contact.flux(t), 1e-3);
        let front = contact.front(t);
        let speed = derivative(|t| contact.front(t), t, 1e-6);
        let released =
            flux(contact.frozen, front - 4.0 * h) - flux(contact.molten, front + 4.0 * h);
        assert_close(released, contact.latent * speed, 1e-3);
        assert_close(contact.temperature(front, t), contact.melts_at, 1e-13);
        assert_close(contact.temperature(-1.0, t), 298.15, 1e-13);
        assert_close(contact.temperature(1.0, t), 513.0, 1e-13);
    }

    #[test]
    fn conducting_wall_holds_its_temperature_and_the_one_phase_problem_remains() {
        let wall = Conductor { conductivity: 1e12, heat_capacity: 1e12 };
        let contact = FreezingContact { wall, ..tin(298.15, 505.0) };
        let front = MeltingFront { surface: 505.0 - 298.15, ..contact.fluid() };
        assert_close(contact.growth(), front.growth(), 1e-6);
        assert_close(contact.flux(2e-3), front.flux(2e-3), 1e-4);
    }

    #[test]
    fn hot_wall_leaves_the_fluid_molten() {
        let contact = tin(503.0, 540.0);
        assert!(!contact.freezes() && tin(298.15, 540.0).freezes());
        assert_eq!(contact.front(1e-3), 0.0);
        let bodies = contact.unfrozen();
        assert_eq!(contact.temperature_of_contact(), bodies.temperature_of_contact());
        assert_close(contact.flux(1e-3), bodies.flux(1e-3), 1e-12);
        assert_eq!(contact.temperature(-1e-5, 1e-3), bodies.temperature(1e-5, 1e-3));
    }
}

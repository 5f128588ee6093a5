//! Two half spaces of different temperature brought into contact at time 0, with a flux proportional to the difference
//! of their surface temperatures.
//!
//! Source: each half space obeys the solution for a convective surface (H. S. Carslaw and J. C. Jaeger, *Conduction of
//! Heat in Solids*, 2nd ed., Oxford 1959, §2.7); with `b = h (1/e₁ + 1/e₂)` the flux is `h ΔT exp(b²t) erfc(b√t)`.

use std::f64::consts::PI;

use super::contact::Contact;
use super::special::erfcx;

/// The contact and its conductance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResistiveContact {
    pub bodies: Contact,
    /// Conductance h [W/(m² K)].
    pub conductance: f64,
}

impl ResistiveContact {
    /// Flux from the first into the second body [W/m²].
    pub fn flux(&self, t: f64) -> f64 {
        self.conductance * self.difference() * erfcx(self.rate() * t.sqrt())
    }

    /// Heat transferred from the first into the second body [J/m²]: the integral of the flux,
    /// `h ΔT/b² (exp(b²t) erfc(b√t) − 1 + 2b √(t/π))`.
    pub fn heat(&self, t: f64) -> f64 {
        let y = self.rate() * t.sqrt();
        let passed = erfcx(y) - 1.0 + 2.0 * y / PI.sqrt();
        self.conductance * self.difference() * passed / self.rate().powi(2)
    }

    /// Temperatures of both surfaces [K]: each changes by a fraction of the difference that follows from its
    /// effusivity.
    pub fn surfaces(&self, t: f64) -> [f64; 2] {
        let Contact { first, second, first_temperature, second_temperature } = self.bodies;
        let [e1, e2] = [first.effusivity(), second.effusivity()];
        let moved = self.difference() * (1.0 - erfcx(self.rate() * t.sqrt())) / (e1 + e2);
        [first_temperature - e2 * moved, second_temperature + e1 * moved]
    }

    fn difference(&self) -> f64 {
        self.bodies.first_temperature - self.bodies.second_temperature
    }

    /// b [1/√s]
    fn rate(&self) -> f64 {
        let Contact { first, second, .. } = self.bodies;
        self.conductance * (1.0 / first.effusivity() + 1.0 / second.effusivity())
    }
}

#[cfg(test)]
mod tests {
    use super::super::medium::Conductor;
    use super::super::quadrature::integrate;
    use super::*;

    fn contact(conductance: f64) -> ResistiveContact {
        let bodies = Contact {
            first: Conductor { conductivity: 10.0, heat_capacity: 3.5e6 },
            first_temperature: 500.0,
            second: Conductor { conductivity: 400.0, heat_capacity: 3.4e6 },
            second_temperature: 300.0,
        };
        ResistiveContact { bodies, conductance }
    }

    #[test]
    fn flux_obeys_the_contact_law() {
        for conductance in [1.0, 1e3, 1e6] {
            let contact = contact(conductance);
            for t in [1e-6, 1e-3, 1.0, 100.0] {
                let [first, second] = contact.surfaces(t);
                let law = conductance * (first - second);
                assert!((law / contact.flux(t) - 1.0).abs() < 1e-9, "{conductance} {t}");
            }
        }
    }

    #[test]
    fn heat_is_the_integral_of_the_flux() {
        for conductance in [1e2, 1e4, 1e6] {
            let contact = contact(conductance);
            for t in [1e-3_f64, 1.0, 100.0] {
                // Over the root of time the flux has no singularity of its slope.
                let flux = |root: f64| 2.0 * root * contact.flux(root * root);
                let integral = integrate(flux, &[0.0, t.sqrt()]);
                assert!((contact.heat(t) / integral - 1.0).abs() < 1e-8, "{conductance} {t}");
            }
        }
    }

    #[test]
    fn zero_resistance_is_perfect_contact() {
        let contact = contact(1e12);
        assert!((contact.flux(1.0) / contact.bodies.flux(1.0) - 1.0).abs() < 1e-12);
        let middle = contact.bodies.temperature_of_contact();
        contact.surfaces(1.0).iter().for_each(|t| assert!((t - middle).abs() < 1e-6));
    }
}

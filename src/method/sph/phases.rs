//! Heat content, temperature and conduction of a fluid that freezes.

use crate::laws::Melting;
use crate::laws::fluid::Freezing;

/// A fluid with a frozen and a molten phase.
///
/// The heat content of a mass is its enthalpy over the specific heat of the molten phase, in kelvins above the model's
/// reference temperature, which is one of the molten phase: there content and temperature are equal. Content and the
/// heat potential `∫ k dT`, over the molten conductivity, are piecewise linear in the temperature, with slopes of 1
/// above the liquidus, `c_s/c_l` and `k_s/k_l` below the solidus, and their means in between, where the content also
/// has the latent heat. Conduction in terms of the potential is exact in steady states, across fronts, too (G.
/// Kirchhoff 1894, *Vorlesungen über die Theorie der Wärme*). Both phases have the density of the molten one.
///
/// Source: V. R. Voller and M. Cross (1981), Int. J. Heat Mass Transfer 24, 545–556, doi 10.1016/0017-9310(81)90062-4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phases {
    /// Solidus and liquidus above the reference [K].
    pub melting: [f64; 2],
    /// `L/c_l` [K].
    pub latent: f64,
    /// `c_s/c_l` and `k_s/k_l` of the frozen phase over the molten one.
    pub heat: f64,
    pub conduction: f64,
}

impl Phases {
    /// Phases of a fluid with the specific heat [J/(kg K)] and the conductivity [W/(m K)] of its molten phase, above a
    /// reference temperature [K].
    pub fn of(
        freezing: &Freezing,
        [specific_heat, conductivity]: [f64; 2],
        reference: f64,
    ) -> Self {
        let Melting { solidus, liquidus, latent_heat } = freezing.melting;
        Self {
            melting: [solidus, liquidus].map(|point| point - reference),
            latent: latent_heat / specific_heat,
            heat: freezing.specific_heat / specific_heat,
            conduction: freezing.conductivity / conductivity,
        }
    }

    /// Contents of the frozen phase at the solidus and of the molten one at the liquidus.
    pub fn contents(&self) -> [f64; 2] {
        let [solidus, liquidus] = self.melting;
        [liquidus - self.latent - 0.5 * (1.0 + self.heat) * (liquidus - solidus), liquidus]
    }

    /// Temperature above the reference at a content.
    pub fn rise(&self, content: f64) -> f64 {
        let ([frozen, molten], [solidus, liquidus]) = (self.contents(), self.melting);
        if content >= molten {
            content
        } else if content <= frozen {
            solidus + (content - frozen) / self.heat
        } else {
            solidus + (liquidus - solidus) * (content - frozen) / (molten - frozen)
        }
    }

    /// Content at a temperature above the reference; where melting is isothermal, at that point, of the molten phase.
    pub fn content(&self, rise: f64) -> f64 {
        let ([frozen, molten], [solidus, liquidus]) = (self.contents(), self.melting);
        if rise >= liquidus {
            rise
        } else if rise <= solidus {
            frozen + self.heat * (rise - solidus)
        } else {
            frozen + (molten - frozen) * (rise - solidus) / (liquidus - solidus)
        }
    }

    /// Heat potential above the reference at a content [K].
    pub fn potential(&self, content: f64) -> f64 {
        let [solidus, liquidus] = self.melting;
        let rise = self.rise(content);
        let (mushy, frozen) = ((rise.max(solidus) - liquidus).min(0.0), (rise - solidus).min(0.0));
        rise.max(liquidus) + 0.5 * (1.0 + self.conduction) * mushy + self.conduction * frozen
    }

    /// Changes a content, and the temperature that follows from it.
    pub fn heat(&self, content: &mut f64, temperature: &mut f64, change: f64) {
        *content += change;
        *temperature = self.rise(*content);
    }

    /// Frozen fraction of the mass at a content.
    pub fn frozen(&self, content: f64) -> f64 {
        let [frozen, molten] = self.contents();
        ((molten - content) / (molten - frozen)).clamp(0.0, 1.0)
    }

    /// Largest rise of the temperature with the content.
    pub fn steepest(&self) -> f64 {
        self.heat.recip().max(1.0)
    }

    /// Largest diffusivity of a phase over that of the molten one.
    pub fn fastest(&self) -> f64 {
        (self.conduction / self.heat).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fluids() -> [Phases; 2] {
        let fluid = Phases { melting: [-8.0, -8.0], latent: 240.0, heat: 1.1, conduction: 1.9 };
        [fluid, Phases { melting: [-20.0, -5.0], ..fluid }]
    }

    #[test]
    fn content_is_the_inverse_of_temperature() {
        for fluid in fluids() {
            for rise in [-300.0, -20.0, -12.0, -7.0, -5.0, 0.0, 90.0] {
                assert!((fluid.rise(fluid.content(rise)) - rise).abs() < 1e-12);
            }
            let [frozen, molten] = fluid.contents();
            for part in [0.0, 0.25, 1.0] {
                let content = molten + part * (frozen - molten);
                assert!((fluid.frozen(content) - part).abs() < 1e-14);
                let [solidus, liquidus] = fluid.melting;
                assert!((solidus..=liquidus).contains(&fluid.rise(content)));
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_phases() {
        for fluid in fluids() {
            let [solidus, liquidus] = fluid.melting;
            let mean = 0.5 * (solidus + liquidus);
            let slope = |of: &dyn Fn(f64) -> f64, at: f64| (of(at + 1e-3) - of(at - 1e-3)) / 2e-3;
            let potential = |rise: f64| fluid.potential(fluid.content(rise));
            let content = |rise: f64| fluid.content(rise);
            assert!((slope(&content, solidus - 1.0) - fluid.heat).abs() < 1e-9);
            assert!((slope(&potential, solidus - 1.0) - fluid.conduction).abs() < 1e-9);
            assert!((slope(&potential, liquidus + 1.0) - 1.0).abs() < 1e-9);
            if solidus < liquidus {
                assert!((slope(&potential, mean) - 0.5 * (1.0 + fluid.conduction)).abs() < 1e-9);
            }
            let [frozen, molten] = fluid.contents();
            let sensible = 0.5 * (1.0 + fluid.heat) * (liquidus - solidus);
            assert!((molten - frozen - sensible - fluid.latent).abs() < 1e-12);
        }
    }
}

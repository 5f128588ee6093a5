//! Heat of a segment: its content and temperature, and what it exchanges with what lies below it and with the air.
//!
//! A segment is a slab of its mean height H, insulated above but for the air. The conductance between its mean
//! temperature and its lower face follows from the cooling of a slab: with the part `F(Fo)` of its heat that a slab has
//! released (`closed_form::cooling_film`), `Fo = a t/H²` of its age t, it is `g = (k/H) d/dFo [−ln(1 − F)]`: √(kρc/(πt)) of
//! a half space at first, and `π²k/(4H)` later. It is exact on a plate of constant temperature without a resistance.
//! Where the fluid freezes, k is the mean of both phases by the frozen fraction.

use std::f64::consts::PI;

use crate::closed_form::cooling_film::given_part;
use crate::method::sph::Phases;

/// Fourier number from which on two terms of the series are exact to 1e-12.
const LATE: f64 = 0.3;

/// Heat of a fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heat {
    /// Temperature of which the content is zero [K].
    pub reference: f64,
    /// Heat capacity per volume ρc of the molten fluid [J/(m³ K)].
    pub capacity: f64,
    /// Conductivity of the molten fluid [W/(m K)].
    pub conductivity: f64,
    pub phases: Option<Phases>,
}

impl Heat {
    /// Heat capacity of a volume of molten fluid [J/K].
    pub fn capacity(&self, volume: f64) -> f64 {
        self.capacity * volume
    }

    /// Content over the heat capacity of the molten fluid [K], at a temperature [K].
    pub fn content_at(&self, temperature: f64) -> f64 {
        let rise = temperature - self.reference;
        self.phases.map_or(rise, |phases| phases.content(rise))
    }

    /// Temperature at a content [K].
    pub fn temperature(&self, content: f64) -> f64 {
        self.reference + self.phases.map_or(content, |phases| phases.rise(content))
    }

    pub fn frozen(&self, content: f64) -> f64 {
        self.phases.map_or(0.0, |phases| phases.frozen(content))
    }

    /// Conductivity at a frozen fraction [W/(m K)].
    fn conductivity(&self, frozen: f64) -> f64 {
        let ratio = self.phases.map_or(1.0, |phases| phases.conduction);
        self.conductivity * (1.0 + frozen * (ratio - 1.0))
    }

    /// Mean conductance between the mean temperature of a slab of height H [m] and its lower face [W/(m² K)], between
    /// two ages [s]. The content that it releases in one implicit step is exact where the fluid does not freeze.
    pub fn conductance(&self, height: f64, [from, to]: [f64; 2], content: f64) -> f64 {
        let frozen = self.frozen(content);
        let fourier = |age: f64| self.conductivity / self.capacity * age / (height * height);
        let [a, b] = [from, to].map(fourier);
        let cooled = logarithm(b) - logarithm(a);
        let is_mushy = 0.0 < frozen && frozen < 1.0;
        let released = if is_mushy { cooled } else { cooled.exp_m1() };
        self.conductivity(frozen) / height * released / (b - a)
    }

    /// The ratio for which [`Self::settle`] relaxes exponentially to a constant temperature as with the given ratio of a
    /// short step, unless the fluid is freezing.
    pub fn exact_ratio(&self, ratio: f64, content: f64) -> f64 {
        match (self.phases, self.frozen(content)) {
            (Some(phases), 1.0) => phases.heat * (ratio / phases.heat).exp_m1(),
            (_, 0.0) => ratio.exp_m1(),
            _ => ratio,
        }
    }

    /// `−ln(1 − F)` between two ages of a slab.
    pub fn cooling(&self, height: f64, [from, to]: [f64; 2]) -> f64 {
        let fourier = |age: f64| self.conductivity / self.capacity * age / (height * height);
        logarithm(fourier(to)) - logarithm(fourier(from))
    }

    /// Content after a step that is implicit in the temperature T: `content + r T = b`, with the ratio r ≥ 0 of the
    /// conductances times the step to the heat capacity, and T above the reference.
    pub fn settle(&self, ratio: f64, b: f64) -> f64 {
        let Some(phases) = self.phases else { return b / (1.0 + ratio) };
        let ([frozen, molten], [solidus, liquidus]) = (phases.contents(), phases.melting);
        if b >= molten + ratio * liquidus {
            b / (1.0 + ratio)
        } else if b <= frozen + ratio * solidus {
            // T = solidus + (content − frozen)/heat.
            let slope = ratio / phases.heat;
            (b - ratio * solidus + slope * frozen) / (1.0 + slope)
        } else {
            let slope = ratio * (liquidus - solidus) / (molten - frozen);
            (b - ratio * solidus + slope * frozen) / (1.0 + slope)
        }
    }
}

/// `−ln(1 − F(Fo))`.
fn logarithm(fourier: f64) -> f64 {
    if fourier < LATE {
        return -(-given_part(fourier)).ln_1p();
    }
    let rate = 0.25 * PI * PI;
    rate * fourier - (8.0 / (PI * PI)).ln() - ((-8.0 * rate * fourier).exp() / 9.0).ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wax(range: f64) -> Heat {
        let phases =
            Phases { melting: [-40.0 - range, -40.0], latent: 90.0, heat: 0.9, conduction: 1.4 };
        Heat { reference: 350.0, capacity: 1.7e6, conductivity: 0.15, phases: Some(phases) }
    }

    #[test]
    fn series_and_images_meet() {
        let [before, after] = [LATE * (1.0 - 1e-12), LATE].map(logarithm);
        assert!((before - after).abs() < 1e-9, "{before} {after}");
    }

    #[test]
    fn steps_solve_their_equation() {
        for heat in [wax(0.0), wax(8.0), Heat { phases: None, ..wax(0.0) }] {
            for ratio in [0.0, 0.3, 50.0] {
                for b in [-4e3, -300.0, -140.0, -60.0, -20.0, 100.0, 3e3] {
                    let content = heat.settle(ratio, b);
                    let rise = heat.temperature(content) - heat.reference;
                    assert!((content + ratio * rise - b).abs() < 1e-9 * (1.0 + b.abs()));
                }
            }
        }
    }

    /// In steps of any length a slab on a plate of constant temperature cools as in closed form.
    #[test]
    fn slabs_cool_as_in_closed_form() {
        let heat = Heat { phases: None, ..wax(0.0) };
        let height = 0.4e-3;
        for steps in [1, 7, 300] {
            let (mut content, end) = (10.0, 2.0);
            for n in 0..steps {
                let ages = [n, n + 1].map(|n| end * f64::from(n) / f64::from(steps));
                let conductance = heat.conductance(height, ages, content);
                let ratio = conductance * (ages[1] - ages[0]) / (heat.capacity * height);
                content = heat.settle(ratio, content - 20.0 * ratio);
            }
            let fourier = heat.conductivity / heat.capacity * end / (height * height);
            let exact = 10.0 - 30.0 * given_part(fourier);
            assert!((content - exact).abs() < 1e-9, "{steps}: {content} {exact}");
        }
    }
}

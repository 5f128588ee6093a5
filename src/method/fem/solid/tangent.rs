//! Derivatives of a solid's state and extremes. All other readings are linear, so the same functions serve a change of
//! temperatures, deformation and loads.

use super::{Deformation, SolidFem, SolidLoads, Temperatures};
use crate::laws::stress::{max_principal, von_mises};
use crate::laws::stress_rate::{max_principal_rate, von_mises_rate};

impl SolidFem {
    /// Returns the time derivative of a state, laid out like the state, if heat is linear; `rates` is that of the
    /// loads.
    pub fn rates(&self, state: &[f64], loads: &SolidLoads, rates: &SolidLoads) -> Option<Vec<f64>> {
        self.heat.rates(state, &loads.thermal(), &rates.thermal())
    }

    /// Rate of change of the highest nodal temperature when temperatures change by `change`. Among nodes that share the
    /// highest value, the fastest counts.
    pub fn max_temperature_rate(&self, temperatures: &Temperatures, change: &Temperatures) -> f64 {
        let mut highest = Highest::default();
        for image in self.images(&present(temperatures, change)) {
            let values = self.rise_of_image(temperatures, image);
            for (value, rate) in values.into_iter().zip(self.rise_of_image(change, image)) {
                highest.include(value, || rate);
            }
        }
        highest.rate
    }

    /// Rates of change of the highest von Mises and the largest principal stress when temperatures and deformation
    /// change by `change`. Among nodes that share the highest value, the fastest counts.
    pub fn max_stress_rate(
        &self,
        (temperatures, deformation): (&Temperatures, &Deformation),
        (temperature_change, change): (&Temperatures, &Deformation),
    ) -> [f64; 2] {
        let mut highest = [Highest::default(); 2];
        let (nodal, nodal_change) = (self.nodal_strains(deformation), self.nodal_strains(change));
        for image in self.images(&present(&deformation.displacement, &change.displacement)) {
            let stresses = self.stress_of_image(temperatures, &nodal, image);
            let rates = self.stress_of_image(temperature_change, &nodal_change, image);
            for (stress, rate) in stresses.into_iter().zip(rates) {
                highest[0].include(von_mises(stress), || von_mises_rate(stress, rate));
                highest[1].include(max_principal(stress), || max_principal_rate(stress, rate));
            }
        }
        highest.map(|highest| highest.rate)
    }
}

/// The highest of some values, and its rate of change.
#[derive(Clone, Copy)]
struct Highest {
    value: f64,
    rate: f64,
}

impl Default for Highest {
    fn default() -> Self {
        Self { value: f64::NEG_INFINITY, rate: f64::NEG_INFINITY }
    }
}

impl Highest {
    fn include(&mut self, value: f64, rate: impl FnOnce() -> f64) {
        if value > self.value {
            *self = Self { value, rate: rate() };
        } else if value == self.value {
            self.rate = self.rate.max(rate());
        }
    }
}

/// For each class, a list that is empty only if both are empty.
pub(super) fn present(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let either = |(a, b): (&Vec<f64>, &Vec<f64>)| vec![0.0; a.len().max(b.len()).min(1)];
    a.iter().zip(b).map(either).collect()
}

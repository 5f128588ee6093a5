//! Effects of the temperature on solids of large strain.
//!
//! A uniform temperature stretches a free body by ϑ, `F = ϑ F_e`, and the energy of the law is that of the rest: `W(F,
//! ϑ) = ϑ³ W_e(F/ϑ)` per reference volume, so `P = ϑ² P_e` and `∂P/∂F = ϑ ∂P_e/∂F_e` (S. C. H. Lu and K. S. Pister
//! 1975, doi 10.1016/0020-7683(75)90015-3). Relaxation goes on in the reduced time of its [`Shift`].

use crate::laws::Property;
use crate::laws::solid::{Elasticity, Shift};

/// Thermal stretch, and pace of relaxation, about a temperature without stress.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermal {
    /// Mean coefficient of linear expansion from a reference temperature [1/K].
    expansion: Option<Property>,
    reference: f64,
    shift: Option<Shift>,
    /// Temperature without stress, at which the times of the law hold [K].
    free: f64,
}

impl Thermal {
    /// `free` is the temperature without stress [K].
    pub fn new(elasticity: &Elasticity, shift: Option<Shift>, free: f64) -> Self {
        Self {
            expansion: elasticity.expansion.clone(),
            reference: elasticity.expansion_reference.unwrap_or(free),
            shift,
            free,
        }
    }

    /// Returns true if a change of temperature has any effect.
    pub fn acts(&self) -> bool {
        self.shift.is_some()
            || self.expansion.as_ref().is_some_and(|a| *a != Property::Constant(0.0))
    }

    /// ϑ at a temperature [K]: 1 without stress.
    pub fn stretch(&self, temperature: f64) -> f64 {
        let Some(expansion) = &self.expansion else { return 1.0 };
        let length = |t: f64| 1.0 + expansion.value(t) * (t - self.reference);
        length(temperature) / length(self.free)
    }

    /// Time [s] in which a body at the temperature without stress relaxes as this one does over a duration [s] in which
    /// its temperature changes linearly [K].
    pub fn reduced_time(&self, temperatures: [f64; 2], duration: f64) -> f64 {
        match self.shift {
            Some(shift) if temperatures != [self.free; 2] => {
                shift.reduced_time(temperatures, duration) * shift.logarithm(self.free).exp()
            }
            _ => duration,
        }
    }
}

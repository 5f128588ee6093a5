//! Flow curves in the units of the method.

use super::super::plan::DropletPlan;
use super::super::units::Units;
use crate::laws::Viscosity;

/// Relative accuracy of rates, and a bound of the iterations that find them.
const CLOSE: f64 = 1e-6;
const MOST_ITERATIONS: usize = 60;

/// Flow curves of a fluid: rates over c₀/H, stresses over ρ₀c₀², temperatures above the model's reference [K].
#[derive(Debug, Clone, PartialEq)]
pub struct FlowCurves {
    law: Viscosity,
    reference_temperature: f64,
    /// Units of the rate [1/s] and of the stress [Pa].
    rate: f64,
    stress: f64,
}

impl FlowCurves {
    pub fn of(plan: &DropletPlan, units: &Units) -> Self {
        Self {
            law: plan.fluid.viscosity.clone(),
            reference_temperature: plan.reference_temperature(),
            rate: 1.0 / units.time(),
            stress: units.pressure(),
        }
    }

    /// Returns true if the viscosity does not depend on the shear rate.
    pub fn is_newtonian(&self) -> bool {
        self.law.is_newtonian()
    }

    /// Viscosity of a Newtonian fluid.
    pub fn newtonian(&self, temperature: f64) -> f64 {
        self.viscosity(temperature, 1.0)
    }

    /// Secant viscosity at a shear rate; infinite at rest where the fluid yields.
    pub fn viscosity(&self, temperature: f64, rate: f64) -> f64 {
        let curve = self.law.at(self.reference_temperature + temperature);
        curve.viscosity(rate * self.rate) * self.rate / self.stress
    }

    /// Shear rate q at which `(µ(γ̇) + p) q` equals a load, for `γ̇² = q² + R²` with the rest R² of the rate.
    pub fn rate_beyond(&self, temperature: f64, load: f64, penalty: f64, rest: f64) -> f64 {
        let curve = self.law.at(self.reference_temperature + temperature);
        let (load, penalty) = (load * self.stress, penalty * self.stress / self.rate);
        let rest = rest * self.rate * self.rate;
        if rest == 0.0 {
            return curve.rate_beyond(load, penalty) / self.rate;
        }
        // Increasing in q; the bracket's ends are those of infinite and of no viscosity.
        let excess = |q: f64| (curve.viscosity((q * q + rest).sqrt()) + penalty) * q - load;
        false_position(excess, load / penalty) / self.rate
    }

    pub fn yield_stress(&self) -> f64 {
        self.law.yield_stress() / self.stress
    }
}

/// Root between 0 and `high` of an increasing function that is negative at 0, by false position with halved weights
/// (Dowell & Jarratt 1971, BIT 11, 168–174, doi 10.1007/BF01934364).
fn false_position(f: impl Fn(f64) -> f64, high: f64) -> f64 {
    let ([mut low, mut high], mut root) = ([0.0, high], high);
    let (mut below, mut above) = (f(low), f(high));
    let mut last = 0.0;
    for _ in 0..MOST_ITERATIONS {
        if high - low <= CLOSE * high || above <= 0.0 || below >= 0.0 {
            break;
        }
        root = (low * above - high * below) / (above - below);
        let value = f(root);
        if value > 0.0 {
            (high, above) = (root, value);
            below *= if last > 0.0 { 0.5 } else { 1.0 };
        } else {
            (low, below) = (root, value);
            above *= if last < 0.0 { 0.5 } else { 1.0 };
        }
        last = value;
        if value.abs() <= CLOSE * f(0.0).abs() {
            break;
        }
    }
    root
}

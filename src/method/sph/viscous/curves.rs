//! Flow curves in the units of the method.

use super::super::plan::DropletPlan;
use super::super::units::Units;
use crate::laws::Viscosity;

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

    /// Slope of the stress over the shear rate; infinite at rest where the fluid thins without a plateau.
    pub fn tangent(&self, temperature: f64, rate: f64) -> f64 {
        let curve = self.law.at(self.reference_temperature + temperature);
        curve.tangent(rate * self.rate) * self.rate / self.stress
    }

    /// Shear rate q at which `τ(q) + p q` equals a load.
    pub fn rate_beyond(&self, temperature: f64, load: f64, penalty: f64) -> f64 {
        let curve = self.law.at(self.reference_temperature + temperature);
        let (load, penalty) = (load * self.stress, penalty * self.stress / self.rate);
        curve.rate_beyond(load, penalty) / self.rate
    }

    pub fn yield_stress(&self) -> f64 {
        self.law.yield_stress() / self.stress
    }
}

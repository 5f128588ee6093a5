//! Checks that states from outside belong to a run of the body.

use super::SolidBody;
use crate::body::BodyError;
use crate::method::fem::ThermalFace;

/// Share of the stored and transferred heat that a balance may miss; runs keep it to 1e-9.
const BALANCE: f64 = 1e-6;
/// Share that a single step may miss before it is refused; beyond it rounding is no longer negligible.
const BALANCE_OF_STEP: f64 = 1e-3;
/// Share of the heat at time zero that a balance may miss; enthalpies are rounded to 1e-16 of it.
const ROUNDING: f64 = 1e-9;
/// Share of the range of nodal temperatures by which the lowest may lie below absolute zero. With consistent
/// capacities, a node next to a suddenly heated one falls below its surroundings, by 2 − √3 of the jump along one axis.
const UNDERSHOOT: f64 = 0.4;
/// The same share at corners between faces of prescribed temperature, where jumps along three axes meet.
const UNDERSHOOT_AT_CORNERS: f64 = 0.55;
/// Highest temperature [K].
const HOTTEST: f64 = 1e100;

/// Heat balance of a body before or after a step [J].
#[derive(Debug, Clone, Copy)]
pub(super) struct Balance {
    /// Heat stored but never supplied.
    missing: f64,
    /// Heat stored or transferred since time zero.
    passed: f64,
}

impl SolidBody {
    pub(super) fn heat_balance(&self, state: &[f64]) -> Balance {
        let heat = self.heat_of(state);
        let totals = self.solid.heat_totals(heat);
        let passed = [self.solid.heat_stored(heat), totals.brought_in, totals.lost];
        Balance { missing: self.solid.heat_drift(heat), passed: passed.map(f64::abs).iter().sum() }
    }

    /// Refuses a step in which heat appeared or vanished.
    pub(super) fn check_step(&self, before: Balance, state: &[f64]) -> Result<(), BodyError> {
        // Particles at unequal distances do not conserve heat.
        if self.solid.fallback_particles().is_some() {
            return Ok(());
        }
        let after = self.heat_balance(state);
        let passed = before.passed + after.passed;
        let missing = (after.missing - before.missing).abs();
        let allowed = BALANCE_OF_STEP * passed;
        let at_start = || self.heat_capacity() * self.solid.initial_temperature();
        if missing <= allowed || missing <= allowed + ROUNDING * at_start() {
            return Ok(());
        }
        Err(BodyError::Unbalanced { body: self.name.clone(), missing, passed })
    }

    /// Refuses thermal states that no run produces: impossible temperatures, or heat that was never supplied.
    pub(super) fn check_heat(&self, state: &[f64], inputs: &[f64]) -> Result<(), String> {
        let heat = self.heat_of(state);
        let loads = self.loads.of_faces(inputs, self.solid.mesh());
        let temperatures = self.solid.temperatures(heat, &loads);
        let lowest = self.solid.min_temperature(&temperatures);
        let highest = self.solid.hottest(&temperatures).value;
        let name = &self.name;
        let below = self.undershoot() * (highest - lowest);
        let is_possible = lowest > -below && highest < HOTTEST;
        if !is_possible {
            return Err(format!(
                "temperatures of {name} from {lowest:e} to {highest:e} K, which no run leads to"
            ));
        }
        // Particles at unequal distances do not conserve heat.
        if self.solid.fallback_particles().is_some() {
            return Ok(());
        }
        let totals = self.solid.heat_totals(heat);
        let stored = self.solid.heat_stored(heat);
        let (start, capacity) = (self.solid.initial_temperature(), self.heat_capacity());
        let warmed = capacity * (highest - start).abs().max((lowest - start).abs());
        let scale = warmed + stored.abs() + totals.brought_in.abs() + totals.lost.abs();
        let missing = self.solid.heat_drift(heat);
        let is_balanced = missing.abs() <= BALANCE * scale + ROUNDING * capacity * start;
        if !is_balanced {
            return Err(format!(
                "{missing:e} J more heat in {name} than was brought in and not lost"
            ));
        }
        Ok(())
    }

    fn undershoot(&self) -> f64 {
        let prescribed = |(_, condition): &(_, ThermalFace)| *condition == ThermalFace::Prescribed;
        let faces = self.plan.thermal_faces.iter().filter(|face| prescribed(face)).count();
        if faces > 1 { UNDERSHOOT_AT_CORNERS } else { UNDERSHOOT }
    }

    /// Heat capacity of the whole body if it consisted of its layer of highest capacity [J/K].
    fn heat_capacity(&self) -> f64 {
        let mesh = self.solid.mesh();
        let volume: f64 =
            mesh.axes.iter().map(|axis| axis.integrals().iter().sum::<f64>()).product();
        let capacities = self.plan.strata.iter().map(|layer| layer.constants.heat_capacity());
        mesh.copies() * volume * capacities.fold(0.0, f64::max)
    }
}

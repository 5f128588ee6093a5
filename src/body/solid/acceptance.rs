//! Checks of unknowns that come from elsewhere: they have to be those of some run of the body.

use super::SolidBody;
use crate::body::BodyError;
use crate::method::fem::ThermalFace;

/// Part of the heat that warmed a body and of the heat that passed which a balance may miss: runs keep it to 1e-9.
const BALANCE: f64 = 1e-6;
/// The same of one step, from which on the step is refused: beyond it rounding is no small error any more.
const BALANCE_OF_STEP: f64 = 1e-3;
/// Part of the heat that was there at time zero which it may miss: enthalpies round to 1e-16 of it.
const ROUNDING: f64 = 1e-9;
/// Part of the range of nodal temperatures by which the lowest may lie below absolute zero. Consistent
/// capacities place a node beside one that was just heated below its surroundings, by 2 − √3 of the jump
/// along one axis.
const UNDERSHOOT: f64 = 0.4;
/// The same at corners between faces of prescribed temperature, where jumps along three axes meet.
const UNDERSHOOT_AT_CORNERS: f64 = 0.55;
/// Highest temperature [K].
const HOTTEST: f64 = 1e100;

/// What a step is to keep of the heat of a body [J].
#[derive(Debug, Clone, Copy)]
pub(super) struct Balance {
    /// Stored, but not brought in and kept.
    missing: f64,
    /// Stored or passed since time zero.
    passed: f64,
}

impl SolidBody {
    pub(super) fn heat_balance(&self, state: &[f64]) -> Balance {
        let heat = self.heat_of(state);
        let totals = self.solid.heat_totals(heat);
        let passed = [self.solid.heat_stored(heat), totals.brought_in, totals.lost];
        Balance { missing: self.solid.heat_drift(heat), passed: passed.map(f64::abs).iter().sum() }
    }

    /// Refuses a step from a balance to a state in which heat appeared or vanished.
    pub(super) fn check_step(&self, before: Balance, state: &[f64]) -> Result<(), BodyError> {
        // Particles at unequal distances keep no balance.
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

    /// Refuses heat that no run leads to: temperatures that no matter has, or heat that did not come in.
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
        // Particles at unequal distances keep no balance.
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

    /// Heat capacity of the whole body, if it were all of its most capacious layer [J/K].
    fn heat_capacity(&self) -> f64 {
        let mesh = self.solid.mesh();
        let volume: f64 =
            mesh.axes.iter().map(|axis| axis.integrals().iter().sum::<f64>()).product();
        let capacities = self.plan.strata.iter().map(|layer| layer.constants.heat_capacity());
        mesh.copies() * volume * capacities.fold(0.0, f64::max)
    }
}

//! Plausibility of the values of inputs.

use super::{Quantity, Slot, Variable};
use crate::advice::{Measure, implausible_input, implausible_place};
use crate::scene::Scene;
use crate::warning::Warning;

impl Variable {
    /// Returns a warning about an implausible value of an input, worded like those about a scene's constants.
    pub fn implausible(&self, scene: &Scene, value: f64) -> Option<Warning> {
        let Slot::Input(_) = self.slot else { return None };
        let measure = match self.quantity? {
            Quantity::Temperature if self.name.ends_with("ambient") => Measure::Ambient,
            Quantity::Temperature => Measure::Temperature,
            Quantity::HeatTransferCoefficient => Measure::HeatTransfer,
            Quantity::HeatFlux => Measure::HeatFlux,
            Quantity::Stress => Measure::Traction,
            Quantity::Length => return implausible_place(scene, &self.name, value),
            _ => return None,
        };
        implausible_input(scene, &self.name, measure, value)
    }

    /// Returns the name without the indices of an element, in either naming.
    pub fn family(&self) -> &str {
        let is_index = |letter: char| letter.is_ascii_digit() || "[],_".contains(letter);
        self.name.trim_end_matches(is_index)
    }
}

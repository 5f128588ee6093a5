//! Plausibility of the values of inputs.

use super::{Quantity, Slot, Variable};
use crate::advice::{
    Measure, implausible_input, implausible_place, implausible_power, place_of_input,
};
use crate::inputs::{InputLayout, LoadInputs};
use crate::scene::{Load, Scene};
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

    /// Returns a warning about a power or radius that makes an implausible heat flux together with other inputs, the
    /// values of all of which are given.
    pub fn implausible_among(&self, scene: &Scene, inputs: &[f64]) -> Option<Warning> {
        let Slot::Input(index) = self.slot else { return None };
        if !matches!(self.quantity?, Quantity::HeatFlow | Quantity::Length) {
            return None;
        }
        let layout = InputLayout::of(scene);
        let of_load = |(load, places): (&Load, &LoadInputs)| {
            let mut amounts = places.amounts.iter();
            let (channel, range) = amounts.find(|(channel, _)| channel.is_of_whole())?;
            let radius = places.radius?;
            let is_either = index == range.start || index == radius;
            let found = || implausible_power(load, *channel, [inputs[range.start], inputs[radius]]);
            is_either.then(found)?
        };
        let finding = scene.load.iter().zip(&layout.loads).find_map(of_load)?;
        Some(finding.at(place_of_input(&self.name, inputs[index])))
    }

    /// Returns the name without the indices of an element, in either naming.
    pub fn family(&self) -> &str {
        let is_index = |letter: char| letter.is_ascii_digit() || "[],_".contains(letter);
        self.name.trim_end_matches(is_index)
    }
}

//! Powers of loads, judged by the heat fluxes that they make.

use crate::channel::Channel;
use crate::inputs::{InputLayout, LoadInputs};
use crate::limits::number;
use crate::limits::plausible;
use crate::scene::{Load, Scene};
use crate::warning::{self, Finding};

/// The finding of a power that makes an implausible heat flux with its radius, if an input is either of the two;
/// `inputs` are the values of all.
pub fn implausible_power(scene: &Scene, inputs: &[f64], index: usize) -> Option<Finding> {
    let layout = InputLayout::of(scene);
    let of_load = |(load, places): (&Load, &LoadInputs)| {
        let mut amounts = places.amounts.iter();
        let (channel, range) = amounts.find(|(channel, _)| channel.is_of_whole())?;
        let radius = places.radius?;
        let is_either = index == range.start || index == radius;
        is_either.then(|| finding(load, *channel, [inputs[range.start], inputs[radius]]))?
    };
    scene.load.iter().zip(&layout.loads).find_map(of_load)
}

/// The finding of an implausible heat flux that an amount of the whole footprint makes on it, with its outer radius [m].
pub fn finding(load: &Load, channel: Channel, [amount, radius]: [f64; 2]) -> Option<Finding> {
    let range = &plausible::HEAT_FLUX;
    let [density, _] = load.density(channel, radius);
    let flux = amount * density;
    (!range.holds(flux)).then(|| {
        let (amount, radius, most) = (number(amount), number(radius), number(range.highest));
        warning::power_makes_implausible_flux(amount, format!("{flux:.1e}"), radius, most)
    })
}

//! Powers of loads, judged by the heat fluxes that they make.

use crate::channel::Channel;
use crate::limits::number;
use crate::limits::plausible;
use crate::scene::Load;
use crate::warning::{self, Finding};

/// The finding of an implausible heat flux that an amount of the whole footprint makes on it, with its outer radius
/// [m].
pub fn implausible_power(
    load: &Load,
    channel: Channel,
    [amount, radius]: [f64; 2],
) -> Option<Finding> {
    let range = &plausible::HEAT_FLUX;
    let [density, _] = load.density(channel, radius);
    let flux = amount * density;
    (!range.holds(flux)).then(|| {
        let (amount, radius, most) = (number(amount), number(radius), number(range.highest));
        warning::power_makes_implausible_flux(amount, format!("{flux:.1e}"), radius, most)
    })
}

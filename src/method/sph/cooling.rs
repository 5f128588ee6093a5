//! Heat that passes from free surfaces to the air.

use super::cloud::{Cloud, Ledger};
use super::exposure;
use super::images::copies;
use super::method::Method;
use super::plan::DropletPlan;
use super::units::Units;

/// Constants of the heat that passes to the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cooling {
    /// `h/(ρ₀ c c₀)` with the coefficient h and the specific heat c of the molten fluid.
    rate: f64,
    /// Factor of areas, see [`exposure`].
    pub factor: f64,
}

impl Cooling {
    /// Constants of a plan; `None` where no heat passes to the air.
    pub fn of(plan: &DropletPlan, units: &Units) -> Option<Self> {
        let air = plan.feed.map_or(0.0, |feed| feed.air);
        let conducts = plan.fluid.conductivity > 0.0;
        (air > 0.0 && conducts).then(|| Self {
            rate: air / (plan.fluid.density * plan.fluid.specific_heat * units.speed),
            factor: exposure::factor(plan.support),
        })
    }

    /// Gives heat of all particles to air at a temperature above the reference [K] for a time over H/c₀: of a particle
    /// with the exposed area A and the mass m `h A (T − T_a)`, in an implicit step.
    pub fn act(
        &self,
        method: &Method,
        cloud: &mut Cloud,
        ledger: &mut Ledger,
        (dt, air): (f64, f64),
    ) {
        let Some(areas) = std::mem::take(&mut cloud.exposed) else { return };
        let mut lost = 0.0;
        for (i, area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.0) {
            let part = dt * self.rate * area / cloud.mass[i];
            let change = part / (1.0 + part) * (air - cloud.temperature[i]);
            cloud.heat(i, change, method.phases.as_ref());
            lost -= cloud.mass[i] * change;
        }
        cloud.exposed = Some(areas);
        let unit = copies(method.mirrors) * method.units.energy() / method.heat_unit;
        ledger.heat_to_air.iter_mut().for_each(|sum| *sum += unit * lost);
    }
}

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
        let steepest = method.phases.map_or(1.0, |phases| phases.steepest());
        let mut lost = 0.0;
        for (i, area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.0) {
            let part = dt * self.rate * area / cloud.mass[i];
            let change = change(part, air - cloud.temperature[i], steepest);
            cloud.heat(i, change, method.phases.as_ref());
            lost -= cloud.mass[i] * change;
        }
        cloud.exposed = Some(areas);
        let unit = copies(method.mirrors) * method.units.energy() / method.heat_unit;
        ledger.heat_to_air.iter_mut().for_each(|sum| *sum += unit * lost);
    }
}

/// Change of a heat content [K] in an implicit step: `dt h A/(m c)` is a part of the difference from the air [K], which
/// the temperature approaches and never passes, as it rises by at most `steepest` with the content.
fn change(part: f64, difference: f64, steepest: f64) -> f64 {
    part / (1.0 + steepest * part) * difference
}

#[cfg(test)]
mod tests {
    use super::super::phases::Phases;
    use super::*;

    #[test]
    fn steps_of_any_length_leave_fluid_warmer_than_the_air() {
        let phases = Phases { melting: [-20.0, -5.0], latent: 240.0, heat: 0.05, conduction: 1.9 };
        for part in [1e-3, 0.3, 20.0, 1e9] {
            let air = -90.0;
            let (mut content, mut rise) = (-3.0, -3.0);
            for _ in 0..40_000 {
                let by = change(part, air - rise, phases.steepest());
                phases.heat(&mut content, &mut rise, by);
                assert!((air - 1e-9..=-3.0).contains(&rise), "{part}: {rise}");
            }
            assert!(rise < air + 1e-3, "{part}: {rise}");
        }
    }
}

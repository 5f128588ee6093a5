//! Temperature of contact between a drop and what lies below it.

use super::types::Scene;
use crate::closed_form::special::erfcx;

/// Predicted first contact of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact<'a> {
    /// Name of the solid or wall below.
    pub below: &'a str,
    /// Its temperature before contact [K].
    pub below_temperature: f64,
    /// Temperature of contact [K]; through a resistance, that of the fluid's surface by the stop time.
    pub temperature: f64,
}

impl Scene {
    /// Contact temperature above the wall, as a share of the difference between drop and wall: `e₁/(e₁ + e₂)` of
    /// effusivities e; zero above a wall without effusivity.
    pub fn contact_share(&self, droplet: &str) -> f64 {
        let own = self.droplet(droplet).map_or(0.0, |droplet| droplet.fluid.effusivity());
        self.effusivity_below(droplet).map_or(0.0, |below| own / (own + below))
    }

    /// First contact between a droplet and the surface below it. For two half spaces of effusivities e its temperature
    /// is `(e₁T₁ + e₂T₂)/(e₁ + e₂)` (Carslaw & Jaeger 1959, §2.15); for a wall without effusivity it is the wall's.
    /// Through a conductance h the fluid's surface has yet to change by `exp(b²t) erfc(b√t)` of its whole change, `b =
    /// h (1/e₁ + 1/e₂)` (§2.7).
    pub fn first_contact(&self, name: &str) -> Option<FirstContact<'_>> {
        let droplet = self.droplet(name)?;
        let (below, below_temperature) = match self.coupling_from(name) {
            Some(coupling) => {
                let solid = self.coupling[coupling].solid()?;
                (solid, self.solid(solid)?.initial_temperature)
            }
            None => {
                let wall = &self.wall[self.wall_under(name)?];
                let start =
                    wall.start.temperature.as_ref().and_then(|values| values.numbers().next());
                (wall.name.as_str(), start.unwrap_or(droplet.initial_temperature))
            }
        };
        let above = droplet.initial_temperature - below_temperature;
        let share = self.contact_share(name);
        let change = self.conductance_below(name).map_or(1.0, |conductance| {
            // 1/e₁ + 1/e₂ is 1/e₁ over the share of the wall.
            let rate = conductance / (droplet.fluid.effusivity() * (1.0 - share));
            1.0 - erfcx(rate * self.stop_time.sqrt())
        });
        let temperature = droplet.initial_temperature - change * (1.0 - share) * above;
        Some(FirstContact { below, below_temperature, temperature })
    }
}

//! Temperature of contact between a drop and what lies below it.

use super::types::Scene;

/// Predicted first contact of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact<'a> {
    /// Name of the solid or wall below.
    pub below: &'a str,
    /// Its temperature before contact [K].
    pub below_temperature: f64,
    /// Temperature of contact [K].
    pub temperature: f64,
}

impl Scene {
    /// Contact temperature above the wall, as a share of the difference between drop and wall: `e₁/(e₁ + e₂)` of
    /// effusivities e; zero above a wall without effusivity.
    pub fn contact_share(&self, droplet: &str) -> f64 {
        let own = self.droplet(droplet).map_or(0.0, |droplet| droplet.fluid.effusivity());
        self.effusivity_below(droplet).map_or(0.0, |below| own / (own + below))
    }

    /// First contact between a droplet and the surface below it. For two half spaces of effusivities e its temperature is
    /// `(e₁T₁ + e₂T₂)/(e₁ + e₂)` (Carslaw & Jaeger 1959, §2.15); for a wall without effusivity it is the wall's.
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
        let temperature = below_temperature + self.contact_share(name) * above;
        Some(FirstContact { below, below_temperature, temperature })
    }
}

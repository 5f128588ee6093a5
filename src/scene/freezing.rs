//! Freezing of droplets in a scene.

use super::Scene;
use super::droplet::DropletMethod;
use crate::laws::Freezing;

impl Scene {
    /// Returns the freezing of a droplet's fluid; `None` if it stays liquid: it does not melt, conducts no heat, is
    /// repeated from a record or a film, or touches nothing. Whether anything becomes cold enough is not asked: inputs,
    /// parameters and fluxes may make it so.
    pub fn freezing_of(&self, name: &str) -> Option<Freezing> {
        let droplet = self.droplet(name)?;
        let conducts = droplet.fluid.conductivity > 0.0 && droplet.method == DropletMethod::Sph;
        let stands = self.has_surface_below(name);
        droplet.fluid.freezing().filter(|_| conducts && stands)
    }
}

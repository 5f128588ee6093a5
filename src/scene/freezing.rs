//! Freezing of droplets in a scene.

use super::Scene;
use super::droplet::DropletMethod;
use crate::laws::Freezing;

impl Scene {
    /// Returns the freezing of a droplet's fluid; `None` if it stays liquid: it does not melt, conducts no heat,
    /// is repeated from a record or a film, or nothing in the scene is colder than its liquidus.
    pub fn freezing_of(&self, name: &str) -> Option<Freezing> {
        // The temperatures of a wall are inputs, which may become anything.
        let may_be_cold = self.wall_under(name).is_some();
        let is_cold = |freezing: &Freezing| self.coldest() < freezing.melting.liquidus;
        self.possible_freezing_of(name).filter(|freezing| may_be_cold || is_cold(freezing))
    }

    /// Returns the freezing of a droplet's fluid at temperatures that parameters may set; `None` if it stays liquid at
    /// any.
    pub fn possible_freezing_of(&self, name: &str) -> Option<Freezing> {
        let droplet = self.droplet(name)?;
        let conducts = droplet.fluid.conductivity > 0.0 && droplet.method == DropletMethod::Sph;
        let stands = self.wall_under(name).is_some() || self.coupling_from(name).is_some();
        droplet.fluid.freezing().filter(|_| conducts && stands)
    }

    /// Lowest temperature of solids, reservoirs and what acts on them at time zero [K].
    fn coldest(&self) -> f64 {
        let solids = self.solids().flat_map(|(_, solid)| {
            let faces = solid.faces.values().flat_map(|face| {
                let convection = face.convection.map(|convection| convection.ambient);
                let radiation = face.radiation.map(|radiation| radiation.ambient);
                [face.temperature, convection, radiation].into_iter().flatten()
            });
            faces.chain([solid.initial_temperature])
        });
        let reservoirs = self.reservoirs().flat_map(|(_, reservoir)| {
            reservoir.ambient.into_iter().chain([reservoir.initial_temperature])
        });
        solids.chain(reservoirs).fold(f64::INFINITY, f64::min)
    }
}

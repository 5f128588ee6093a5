//! Warnings of temperatures that are probably in °C.

use crate::limits::plausible::{BESIDE_WARM, Cold};
use crate::scene::{Body, Scene};

/// Density below which a liquid is hydrogen or helium [kg/m³].
const LIGHTEST_COMMON: f64 = 150.0;

impl Scene {
    /// Returns whether the scene is declared cold, or is cold throughout.
    pub fn cold(&self) -> Cold {
        let is_light = self.droplets().any(|(_, drop)| drop.fluid.density < LIGHTEST_COMMON);
        if self.cryogenic || is_light {
            Cold::Meant
        } else if self.has_warm() {
            Cold::BesideWarm
        } else {
            Cold::Throughout
        }
    }

    /// Returns true if something in the scene is at least as warm as is plausible next to warm things.
    fn has_warm(&self) -> bool {
        let is_warm = |temperature: f64| temperature >= BESIDE_WARM;
        let of_walls = self.wall.iter().any(|wall| {
            let start = wall.start.temperature.as_ref();
            start.is_some_and(|values| values.numbers().any(is_warm))
        });
        let mut of_bodies = self.body.values().flat_map(Body::temperatures);
        of_walls || of_bodies.any(is_warm)
    }
}

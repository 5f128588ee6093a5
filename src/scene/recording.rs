//! Drops that repeat what is known of one, and how that is recorded.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::droplet::{Droplet, DropletMethod};
use crate::closed_form::DropImpact;
use crate::limits::within;

/// How an impact is recorded.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Time after the first contact that is recorded [s]; then the splat cools as a film.
    #[schemars(transform = within(1e-12, 1e6, "s", "the time that is recorded")
        .otherwise("five times D/U, or as many of the time in which tension pulls the drop round; of films until they are widest, \
                    if that takes longer"))]
    pub duration: Option<f64>,
    /// Speeds at the release that are recorded [m/s]: drops of speeds between them are interpolated.
    #[schemars(
        length(min = 1),
        transform = within(1e-9, 1e5, "m/s", "a speed that is recorded")
            .condition("ascending, `impact_velocity` within them")
            .otherwise("`impact_velocity` alone")
    )]
    pub speeds: Option<Vec<f64>>,
}

/// Time that is recorded, over D/U.
const RECORDED: f64 = 5.0;

impl Droplet {
    /// Whether drops repeat what is known of one.
    pub fn is_replayed(&self) -> bool {
        self.method != DropletMethod::Sph
    }

    /// Whether drops are made of particles, in the scene itself or ahead.
    pub fn has_particles(&self) -> bool {
        self.method != DropletMethod::Film
    }

    /// Speeds at the release that are known of drops that are replayed [m/s].
    pub fn recorded_speeds(&self) -> Vec<f64> {
        let speeds = self.record.as_ref().and_then(|record| record.speeds.clone());
        speeds.unwrap_or_else(|| vec![self.impact_velocity])
    }

    /// Of a round drop [kg].
    pub fn mass(&self) -> f64 {
        PI / 6.0 * self.diameter.powi(3) * self.fluid.density
    }

    /// Way of a drop from its release to where it is about to touch the wall [m]: half a distance of particles above it.
    fn way_down(&self) -> f64 {
        (self.gap() - 0.5 * self.spacing).max(0.0)
    }

    /// How fast a drop is about to touch the wall that comes straight down [m/s], and how long after its release [s].
    pub fn contact(&self, speed: f64) -> (f64, f64) {
        let way = self.way_down();
        let fast = (speed * speed + 2.0 * self.gravity * way).sqrt();
        (fast, if way > 0.0 { 2.0 * way / (speed + fast) } else { 0.0 })
    }

    /// Time after the contact that is known of drops that are replayed [s].
    pub fn recorded_time(&self, speed: f64) -> f64 {
        let impact = DropImpact { speed, ..self.impact() };
        let usual = RECORDED * impact.time();
        let default = if self.has_particles() { usual } else { usual.max(impact.time_to_rest()) };
        self.record.as_ref().and_then(|record| record.duration).unwrap_or(default)
    }
}

//! Drops that repeat a recorded one, and the settings of the recording.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::droplet::{Droplet, DropletMethod};
use crate::closed_form::DropImpact;
use crate::limits::within;

/// Settings of a recorded impact.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Recorded time after the first contact [s]; afterwards the splat cools as a film.
    #[schemars(transform = within(1e-12, 1e6, "s", "the time that is recorded")
        .otherwise("five times D/U, or as many of the time in which tension pulls the drop round; of films until they are widest, \
                    if that takes longer"))]
    pub duration: Option<f64>,
    /// Recorded speeds at the release [m/s]; other speeds between them are interpolated.
    #[schemars(
        length(min = 1),
        transform = within(1e-9, 1e5, "m/s", "a speed that is recorded")
            .condition("ascending, `impact_velocity` within them")
            .otherwise("`impact_velocity` alone")
    )]
    pub speeds: Option<Vec<f64>>,
}

/// Default recorded time over D/U.
const RECORDED: f64 = 5.0;

impl Droplet {
    /// Returns true if drops repeat a known one.
    pub fn is_replayed(&self) -> bool {
        self.method != DropletMethod::Sph
    }

    /// Returns true if drops consist of particles, in the scene itself or in a recording.
    pub fn has_particles(&self) -> bool {
        self.method != DropletMethod::Film
    }

    /// Speeds at the release for which replayed drops are recorded [m/s].
    pub fn recorded_speeds(&self) -> Vec<f64> {
        let speeds = self.record.as_ref().and_then(|record| record.speeds.clone());
        speeds.unwrap_or_else(|| vec![self.impact_velocity])
    }

    /// Mass of a round drop [kg].
    pub fn mass(&self) -> f64 {
        PI / 6.0 * self.diameter.powi(3) * self.fluid.density
    }

    /// Distance that a drop falls from its release until just before it touches the wall [m]: half a particle distance
    /// above it.
    fn way_down(&self) -> f64 {
        (self.gap() - 0.5 * self.spacing).max(0.0)
    }

    /// Speed of a vertically falling drop just before contact [m/s], and the time since its release [s].
    pub fn contact(&self, speed: f64) -> (f64, f64) {
        let way = self.way_down();
        let fast = (speed * speed + 2.0 * self.gravity * way).sqrt();
        (fast, if way > 0.0 { 2.0 * way / (speed + fast) } else { 0.0 })
    }

    /// Speed of a drop of the scene just before contact [m/s].
    pub fn speed_at_contact(&self) -> f64 {
        self.contact(self.impact_velocity).0
    }

    /// Speed towards the wall of a drop of the scene just before contact [m/s].
    pub fn normal_speed_at_contact(&self) -> f64 {
        self.contact(self.normal_speed()).0
    }

    /// Recorded time after contact of replayed drops that touch the wall at a speed [s].
    pub fn recorded_time(&self, speed: f64) -> f64 {
        let impact = DropImpact { speed, ..self.impact() };
        let usual = RECORDED * impact.time();
        let default = if self.has_particles() { usual } else { usual.max(impact.time_to_rest()) };
        self.record.as_ref().and_then(|record| record.duration).unwrap_or(default)
    }
}

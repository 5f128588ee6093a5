//! Drops that would dry, as the model has no evaporation.

use std::f64::consts::PI;

use super::Reviewer;
use crate::laws::SphericalCap;
use crate::limits::two_digits;
use crate::scene::locate::Path;
use crate::scene::{Droplet, FirstContact};
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    for (name, droplet) in reviewer.scene.droplets().filter(|(_, droplet)| droplet.dimension == 3) {
        drying(reviewer, (name, droplet));
    }
}

/// Share of a drop whose loss matters.
const NOTABLE: f64 = 0.05;

/// Warns of drops at rest that would lose a notable share of their mass within the run, at the temperature of what lies
/// below.
fn drying(reviewer: &mut Reviewer, (name, droplet): (&str, &Droplet)) {
    let scene = reviewer.scene;
    let Some((evaporation, boils_at)) = droplet.fluid.evaporation.zip(droplet.fluid.boils_at)
    else {
        return;
    };
    let Some(FirstContact { below, below_temperature, .. }) = scene.first_contact(name) else {
        return;
    };
    if below_temperature >= boils_at {
        return;
    }
    let volume = PI * droplet.diameter.powi(3) / 6.0;
    let cap = SphericalCap::of_volume(volume, droplet.fluid.contact_angle.max(LEAST_ANGLE));
    let time = droplet.fluid.density * volume / evaporation.rate(cap, below_temperature, boils_at);
    if scene.stop_time < NOTABLE * time {
        return;
    }
    let finding = warning::drop_dries(below, below_temperature, two_digits(NOTABLE * time));
    reviewer.warn(&Path::default().key("body").key(name), finding);
}

/// Contact angle from which on a drop counts as a cap and not as a film [rad].
const LEAST_ANGLE: f64 = 0.05;

//! Checks how drops are computed: by particles, by a recording of these, or by the closed forms of a film. Each has
//! keys of its own.

use super::{Checker, number};
use crate::kernel::Kernel;
use crate::scene::droplet::{Droplet, DropletMethod, DropletSymmetry, Placement, Precision};
use crate::scene::locate::Path;

pub fn check(checker: &mut Checker, path: &Path, (name, droplet): (&str, &Droplet)) {
    let method = droplet.method;
    if droplet.has_particles() {
        let message = "drops of particles need the particle spacing";
        let allowed = "spacing, up to a sixth of the diameter";
        checker.require(droplet.spacing > 0.0, &path.at("spacing"), message, allowed);
    }
    if method == DropletMethod::Sph {
        let message = "`sph` computes each drop and records nothing";
        let allowed = "no such key, or method = \"record\"";
        checker.require(droplet.record.is_none(), &path.at("record"), message, allowed);
        return;
    }
    let scene = checker.scene;
    let stands = scene.has_surface_below(name);
    let message = "a recorded drop needs a wall or a solid below it";
    checker.require(
        stands,
        &path.at("method"),
        message,
        "\"sph\", or a `[[coupling]]` or `[[wall]]` of the droplet",
    );
    if method == DropletMethod::Film {
        without_particles(checker, path, droplet);
    }
    let message = "drops that are repeated are round";
    checker.require(droplet.dimension == 3, &path.at("dimension"), message, "3");
    let message = "drops that are repeated come straight down";
    checker.require(droplet.is_straight(), &path.at("impact_angle"), message, "0");
    let (speed, _) = droplet.contact(droplet.impact_velocity);
    let message = "a drop that is repeated hits the wall";
    checker.require(speed > 0.0, &path.at("impact_velocity"), message, "> 0");
    speeds(checker, path, droplet);
}

fn speeds(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let speeds = droplet.recorded_speeds();
    let at = path.at("record.speeds");
    for (n, pair) in speeds.windows(2).enumerate() {
        let message = "speeds that are recorded ascend";
        let allowed = format!("> {}", number(pair[0]));
        checker.require(pair[0] < pair[1], &at.index(n + 1), message, allowed);
    }
    if let (Some(slowest), Some(fastest)) = (speeds.first(), speeds.last()) {
        let own = droplet.impact_velocity;
        let message = format!("the drops' own speed, {} m/s, is not among them", number(own));
        let allowed = format!("speeds from {} or less to {} or more", number(own), number(own));
        checker.require((*slowest..=*fastest).contains(&own), &at, message, allowed);
    }
}

/// Refuses the keys of particles for a film, which has none.
fn without_particles(checker: &mut Checker, path: &Path, droplet: &Droplet) {
    let given = [
        ("spacing", droplet.spacing != 0.0),
        ("symmetry", droplet.symmetry != DropletSymmetry::Auto),
        ("placement", droplet.placement != Placement::Lattice),
        ("kernel", droplet.kernel != Kernel::default()),
        ("support", droplet.support != Droplet::DEFAULT_SUPPORT),
        ("precision", droplet.precision != Precision::Single),
        ("density_diffusion", droplet.density_diffusion != Droplet::DEFAULT_DENSITY_DIFFUSION),
        ("corrected_diffusion", !droplet.corrected_diffusion),
        ("shifting", droplet.shifting.is_some()),
        ("fluid.sound_speed", droplet.fluid.sound_speed.is_some()),
    ];
    for (key, is_given) in given {
        let message = "a film has no particles, which this key describes";
        checker.require(!is_given, &path.at(key), message, "no such key, or another `method`");
    }
}

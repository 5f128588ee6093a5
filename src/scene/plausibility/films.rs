//! Drops of closed forms that say little of what they land on.

use super::{Path, Reviewer, number};
use crate::scene::{Droplet, DropletMethod};

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    let films = scene.droplets().filter(|(_, droplet)| droplet.method == DropletMethod::Film);
    for (name, droplet) in films {
        let path = Path::default().key("body").key(name).key("method");
        insulated(reviewer, &path, (name, droplet));
        depleted(reviewer, &path, (name, droplet));
    }
}

/// Fourier number of a film over D/U from which on it has cooled through while its drop still comes down.
const COOLED: f64 = 0.25;

/// Warns of films that have given their heat before fresh fluid has ceased to come: metals on what conducts. They are as
/// thin from the first as they get.
fn depleted(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let fluid = &droplet.fluid;
    let (speed, _) = droplet.contact(droplet.normal_speed());
    if fluid.conductivity == 0.0 || speed <= 0.0 {
        return;
    }
    let own = fluid.effusivity();
    let taken = reviewer.scene.effusivity_below(name).map_or(1.0, |below| below / (below + own));
    let spread = droplet.spread_diameter() / droplet.diameter;
    let thickness = 2.0 / 3.0 * droplet.diameter / spread.powi(2);
    let diffusivity = fluid.conductivity / (fluid.density * fluid.specific_heat);
    let fourier = taken.powi(2) * diffusivity * droplet.diameter / speed / thickness.powi(2);
    if fourier < COOLED {
        return;
    }
    let message = format!(
        "the temperature under the middle of the drop is expected to be too low, by a fifth to nine tenths, and heat by up to \
         a third, as this film has cooled through while the drop still comes down (a(D/U)/δ² = {} of what is in contact, \
         right below {COOLED}); did you mean `sph`?",
        number((100.0 * fourier).round() / 100.0)
    );
    reviewer.warn(path, message);
}

/// Effusivity of what lies below over that of the fluid below which heat follows the wetted area: mercury on polymers.
const INSULATES: f64 = 0.15;

/// Warns of films on what conducts next to nothing, whose heat follows the wetted area (`docs/fidelity.md`).
fn insulated(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some(below) = reviewer.scene.effusivity_below(name) else { return };
    if droplet.fluid.conductivity == 0.0 || below >= INSULATES * droplet.fluid.effusivity() {
        return;
    }
    let message = "heat is expected to be too low by a tenth to a half, as on what conducts less than a seventh of the fluid it \
                   follows the wetted area, which correlations tell to no better; did you mean `sph`?";
    reviewer.warn(path, message.to_owned());
}

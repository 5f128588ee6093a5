//! Drops of closed forms that say little of what they land on.

use super::{Path, Reviewer};
use crate::scene::resolution::INSULATES;
use crate::scene::{Droplet, DropletMethod};

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    let films = scene.droplets().filter(|(_, droplet)| droplet.method == DropletMethod::Film);
    for (name, droplet) in films {
        let path = Path::default().key("body").key(name).key("method");
        insulated(reviewer, &path, (name, droplet));
    }
}

/// Warns of films on what conducts next to nothing, whose heat follows the wetted area (`docs/fidelity.md`).
fn insulated(reviewer: &mut Reviewer, path: &Path, (name, droplet): (&str, &Droplet)) {
    let Some(below) = reviewer.scene.effusivity_below(name) else { return };
    if droplet.fluid.conductivity == 0.0 || below >= INSULATES * droplet.fluid.effusivity() {
        return;
    }
    let message = "heat is expected to be too low by a tenth to a half, as on what conducts less than a tenth of the fluid it \
                   follows the wetted area, which correlations tell to no better; did you mean `sph`?";
    reviewer.warn(path, message.to_owned());
}

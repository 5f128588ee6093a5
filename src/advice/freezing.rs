//! Frozen skins that particles do not resolve.

use super::{Path, Reviewer, number};
use crate::closed_form::{Conductor, FreezingContact};
use crate::laws::Freezing;
use crate::scene::{Droplet, FirstContact, Scene};
use crate::warning;

/// Time at which a drop has spread, over D/U (M. Pasandideh-Fard et al. 1998, Int. J. Heat Mass Transfer 41, 2929–2945,
/// doi 10.1016/S0017-9310(98)00023-4).
const SPREADING: f64 = 8.0 / 3.0;
/// Thickness of the skin over the distance of particles from which on a particle at the wall is rigid.
const RIGID: f64 = 0.5;

pub fn review(reviewer: &mut Reviewer) {
    for (name, droplet) in reviewer.scene.droplets() {
        let Some(skin) = skin_after_spreading(reviewer.scene, (name, droplet)) else { continue };
        if skin < RIGID * droplet.spacing {
            let path = Path::default().key("body").key(name).key("spacing");
            let thickness = format!("{skin:.2e}");
            let finer = number(two_digits(skin / RIGID));
            reviewer.warn(&path, warning::skin_thinner_than_particles(thickness, finer));
        }
    }
}

/// Thickness of what is frozen by the time at which a drop has spread [m], of half spaces in perfect contact; `None`
/// where nothing freezes on contact.
fn skin_after_spreading(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Option<f64> {
    let Freezing { melting, specific_heat, conductivity } = scene.freezing_of(name)?;
    let FirstContact { below_temperature, .. } = scene.first_contact(name)?;
    let speed = droplet.normal_speed_at_contact();
    // A wall without effusivity keeps its temperature.
    let effusivity = scene.effusivity_below(name).unwrap_or(f64::MAX.sqrt());
    let fluid = &droplet.fluid;
    let contact = FreezingContact {
        wall: Conductor { conductivity: effusivity, heat_capacity: effusivity },
        frozen: Conductor { conductivity, heat_capacity: fluid.density * specific_heat },
        molten: Conductor {
            conductivity: fluid.conductivity,
            heat_capacity: fluid.density * fluid.specific_heat,
        },
        latent: fluid.density * melting.latent_heat,
        melts_at: 0.5 * (melting.solidus + melting.liquidus),
        wall_temperature: below_temperature,
        fluid_temperature: droplet.initial_temperature,
    };
    let freezes = speed > 0.0 && below_temperature < contact.melts_at && contact.freezes();
    freezes.then(|| contact.front(SPREADING * droplet.diameter / speed))
}

/// A length rounded down to two digits [m].
fn two_digits(length: f64) -> f64 {
    let unit = 10f64.powf(length.log10().floor() - 1.0);
    (length / unit).floor() * unit
}

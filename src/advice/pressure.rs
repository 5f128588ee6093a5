//! Drops too thin for pressure that is solved at the end of steps.

use super::Reviewer;
use crate::limits::two_digits;
use crate::scene::locate::Path;
use crate::scene::{Droplet, PressureAdvance, ViscousAdvance};
use crate::warning;

/// Reynolds number of the fastest flow from which on density varies by several per cent and steps cost more than they
/// save: wax at 5 is within 0.5 % of its density, water at 2000 within 4 % and mercury at 9000 within 5 %.
const THIN: f64 = 30.0;

/// Reynolds number of the fastest flow of a droplet.
pub fn reynolds(droplet: &Droplet) -> f64 {
    droplet.fluid.density * droplet.fastest_flow() * droplet.diameter
        / droplet.reference_viscosity()
}

/// Returns true if a drop's particles may have their pressure solved at the end of steps, and their fluid is thick
/// enough.
pub fn may_be_solved(droplet: &Droplet) -> bool {
    let takes = droplet.fluid.sound_speed.is_none() && droplet.viscous != ViscousAdvance::Explicit;
    takes && droplet.has_particles() && reynolds(droplet) <= THIN
}

pub fn review(reviewer: &mut Reviewer) {
    let solved = |(_, droplet): &(&str, &Droplet)| {
        droplet.has_particles() && droplet.pressure == PressureAdvance::Implicit
    };
    for (name, droplet) in reviewer.scene.droplets().filter(solved) {
        let reynolds = reynolds(droplet);
        if reynolds > THIN {
            let path = Path::default().key("body").key(name).key("pressure");
            reviewer.warn(&path, warning::pressure_of_thin_fluid(two_digits(reynolds), THIN));
        }
    }
}

//! Drops too thin for pressure that is solved at the end of steps.

use super::Reviewer;
use crate::limits::two_digits;
use crate::scene::locate::Path;
use crate::scene::{Droplet, PressureAdvance};
use crate::warning;

/// Reynolds number of the fastest flow from which on density varies by several per cent and steps cost more than they
/// save: wax at 5 is within 0.5 % of its density, water at 2000 within 4 % and mercury at 9000 within 5 %.
const THIN: f64 = 30.0;

pub fn review(reviewer: &mut Reviewer) {
    let solved = |(_, droplet): &(&str, &Droplet)| {
        droplet.has_particles() && droplet.pressure == PressureAdvance::Implicit
    };
    for (name, droplet) in reviewer.scene.droplets().filter(solved) {
        let flow = droplet.fluid.density * droplet.fastest_flow() * droplet.diameter;
        let reynolds = flow / droplet.reference_viscosity();
        if reynolds > THIN {
            let path = Path::default().key("body").key(name).key("pressure");
            reviewer.warn(&path, warning::pressure_of_thin_fluid(two_digits(reynolds), THIN));
        }
    }
}

//! The time since which fluid no longer moves on the wall.

use super::cloud::{Cloud, Ledger};
use super::frozen::RIGID;
use super::method::Method;
use super::wall_heat::Touching;

/// Fraction of the fluid on the wall that counts as all of it: single particles at the edge come and go.
const ALMOST_ALL: f64 = 0.99;

/// Notes since when all fluid that touches the wall is frozen; nothing for fluids that stay liquid.
pub fn note_arrest(ledger: &mut Ledger, cloud: &Cloud, touching: &[Touching], method: &Method) {
    let (Some(arrest), Some(phases)) = (&mut ledger.arrest, &method.phases) else { return };
    let (mut mass, mut frozen) = (0.0, 0.0);
    for touching in touching {
        let part = touching.share * touching.mass;
        mass += part;
        if phases.frozen(cloud.contents()[touching.particle]) >= RIGID {
            frozen += part;
        }
    }
    let is_arrested = mass > 0.0 && frozen >= ALMOST_ALL * mass;
    *arrest = match (is_arrested, *arrest > 0.0) {
        (true, true) => *arrest,
        (true, false) => ledger.time,
        (false, _) => 0.0,
    };
}

//! Cracks whose damage is as wide as the body.

use super::Reviewer;
use crate::limits::number;
use crate::scene::locate::Path;
use crate::scene::{Shape, Solid};
use crate::warning;

/// Largest length of damage over the smallest extent of the body's section.
const LARGEST_PART: f64 = 1.0 / 3.0;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, solid) in scene.solids() {
        let Some(law) = solid.damage() else { continue };
        let extent = smallest_extent(solid);
        if law.length > LARGEST_PART * extent {
            let path = Path::default().key("body").key(name).key("material");
            let [length, extent] = [law.length, extent].map(number);
            reviewer.warn(&path, warning::damage_wider_than_body(length, extent));
        }
    }
}

/// Smallest extent of the section in which cracks run [m].
fn smallest_extent(solid: &Solid) -> f64 {
    let across = match solid.shape {
        Shape::Box([x, ..]) => x,
        Shape::Disc(disc) => 2.0 * disc.radius,
    };
    across.min(solid.shape.thickness())
}

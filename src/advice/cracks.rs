//! Cracks whose damage is as wide as the body, those that a shock opens within one step, and those of plates that a bath
//! cools unevenly.

use super::Reviewer;
use super::flaws::is_shocked;
use crate::laws::heat::unevenness;
use crate::limits::number;
use crate::quantity::percent;
use crate::scene::Solid;
use crate::scene::locate::Path;
use crate::warning;

/// Largest length of damage over the smallest extent of the body's section.
const LARGEST_PART: f64 = 1.0 / 3.0;

/// Factor of lengths that are equal to rounding.
const SLACK: f64 = 1.0 + 1e-9;

/// Fourier number `κt/L²` of an extent L that is cooled suddenly on both sides, at which stress in its surfaces has fallen
/// to 55 % of its peak: to `1 − 4 √(κt/(π L²))`.
const PASSED: f64 = 0.04;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, solid) in scene.solids() {
        if let Some(biot) = solid.biot_in_bath().filter(|&biot| biot > Solid::THIN) {
            let path = Path::default().key("body").key(name).key("bath");
            let part = percent(unevenness(biot));
            reviewer.warn(&path, warning::plate_unevenly_warm(format!("{biot:.2}"), part));
        }
        let Some(law) = solid.damage() else { continue };
        let extent = smallest_extent(solid);
        if law.length > LARGEST_PART * extent * SLACK {
            let path = Path::default().key("body").key(name).key("material");
            let [length, extent] = [law.length, extent].map(number);
            reviewer.warn(&path, warning::damage_wider_than_body(length, extent));
        }
        let Some(layer) = solid.strata().first().copied() else { continue };
        let time = PASSED * extent * extent / layer.constants.diffusivity();
        let step = scene.step;
        if step > time && is_shocked(scene, (name, solid), 0.5 * extent) {
            let [step, time] = [step, time].map(|time| format!("{time:.1e}"));
            let path = Path::default().key("body").key(name).key("material");
            reviewer.warn(&path, warning::crack_peak_missed(step, time));
        }
    }
}

/// Smallest extent of the body, or of the section, in which cracks run [m].
fn smallest_extent(solid: &Solid) -> f64 {
    solid.extents_of_cracks().into_iter().fold(f64::INFINITY, f64::min)
}

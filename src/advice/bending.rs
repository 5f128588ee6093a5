//! Slender solids of large strain whose mesh is too coarse to bend.

use super::{Reviewer, number};
use crate::scene::locate::Path;
use crate::scene::{LargeStrain, Mechanics};
use crate::warning;

/// Largest extent over the smallest from which on a body is slender.
const SLENDER: f64 = 3.0;
/// Error of the deflection under its own weight of cantilevers ten times as long as thick, square and plane, at ratios
/// of Poisson of 0.3 and 0.45, with one and with two elements across.
const ERRORS: [&str; 2] = ["20 to 60 %", "1 to 8 %"];
/// Number of elements across with which that error is below 2 %.
const ENOUGH: f64 = 4.0;

pub fn review(reviewer: &mut Reviewer) {
    for (name, solid) in reviewer.scene.large_strains() {
        let Some((across, smallest)) = coarse(solid) else { continue };
        let path = Path::default().key("body").key(name).at("mesh.spacing");
        let elements = if across == 1 { "one element is" } else { "two elements are" };
        let (error, fine) = (ERRORS[across - 1], number(smallest / ENOUGH));
        let other = if solid.conducts() { "" } else { ", or `mesh.order = 2`" };
        let found = warning::bending_unresolved(elements, number(smallest), error, fine, other);
        reviewer.warn(&path, found);
    }
}

/// Number of elements across a slender body that are too few, and its smallest extent [m].
fn coarse(solid: &LargeStrain) -> Option<(usize, f64)> {
    let [x, y, z] = solid.extents();
    let extents = if solid.dimension == 2 { vec![x, z] } else { vec![x, y, z] };
    let smallest = solid.smallest();
    let largest = extents.into_iter().fold(0.0, f64::max);
    let across = (smallest / solid.spacing()).round().max(1.0) as usize;
    let is_coarse = across <= ERRORS.len() && largest >= SLENDER * smallest;
    // The extents of a part are not its thickness.
    let is_known =
        solid.mechanics == Mechanics::Fem && solid.order() == 1 && solid.part().is_none();
    (is_coarse && is_known).then_some((across, smallest))
}

//! Checks every number of a scene against its plausible range.

use super::{Reviewer, implausible};
use crate::limits::plausible::{CRYOGENIC, Cold, STRAND_VISCOSITY};
use crate::scene::locate::Path;
use crate::scene::schema::Schema;

pub fn review(reviewer: &mut Reviewer, schema: &Schema, cold: Cold) {
    let copies = reviewer.scene.copied_materials();
    // Pastes are thicker than any drop.
    let of_strand = |name| Path::default().key("body").key(name).at("fluid.viscosity");
    let of_strands: Vec<Path> =
        reviewer.scene.filaments().map(|(name, _)| of_strand(name)).collect();
    let is_of_strand = |path: &Path| of_strands.iter().any(|own| path.is_within(own));
    let mut warned_list = None;
    schema.numbers(reviewer.source, &mut |place, limits, value| {
        // In a list, only the first number out of range is reported: the others are hardly better.
        let is_said = place.list().is_some() && place.list() == warned_list;
        if limits.is_usual(value) || is_said {
            return;
        }
        let path = place.path();
        let Some(mut range) = limits.plausible(cold) else { return };
        let is_cold = range.unit == "K" && (CRYOGENIC..range.lowest).contains(&value);
        if is_cold && reviewer.is_in_degrees(&path, value) {
            return;
        }
        if range.unit == STRAND_VISCOSITY.unit && is_of_strand(&path) {
            range = STRAND_VISCOSITY.clone();
        }
        let Some(finding) = implausible(&range, value) else { return };
        if !copies.iter().any(|copy| path.is_within(copy)) {
            warned_list = place.list();
            reviewer.warn(&path, finding);
        }
    });
}

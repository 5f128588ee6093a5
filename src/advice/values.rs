//! Checks every number of a scene against its plausible range.

use super::{Reviewer, implausible};
use crate::limits::plausible::{Cold, STRAND_VISCOSITY};
use crate::scene::locate::Path;
use crate::scene::schema::Schema;

pub fn review(reviewer: &mut Reviewer, schema: &Schema, cold: Cold) {
    let copies = reviewer.scene.copied_materials();
    // Pastes are thicker than any drop.
    let of_strand = |name| Path::default().key("body").key(name).at("fluid.viscosity");
    let of_strands: Vec<Path> =
        reviewer.scene.filaments().map(|(name, _)| of_strand(name)).collect();
    let mut warned_list = None;
    schema.numbers(reviewer.source, &mut |place, limits, value| {
        // In a list, only the first number out of range is reported: the others are hardly better.
        let is_said = place.list().is_some() && place.list() == warned_list;
        if limits.is_usual(value) || is_said {
            return;
        }
        let Some(finding) = limits.plausible(cold).and_then(|range| implausible(&range, value))
        else {
            return;
        };
        let path = place.path();
        let is_thick = of_strands.contains(&path) && STRAND_VISCOSITY.holds(value);
        if !is_thick && !copies.iter().any(|copy| path.is_within(copy)) {
            warned_list = place.list();
            reviewer.warn(&path, finding);
        }
    });
}

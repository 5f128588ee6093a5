//! Checks every number of a scene against its plausible range.

use super::{Reviewer, implausible};
use crate::limits::plausible::Cold;
use crate::scene::schema::Schema;

pub fn review(reviewer: &mut Reviewer, schema: &Schema, cold: Cold) {
    let copies = reviewer.scene.copied_materials();
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
        if !copies.iter().any(|copy| path.is_within(copy)) {
            warned_list = place.list();
            reviewer.warn(&path, finding);
        }
    });
}

//! Every number of a scene against its plausible range.

use super::{Reviewer, implausible};
use crate::scene::schema::Schema;
use crate::scene::types::Scene;

pub fn review(reviewer: &mut Reviewer, schema: &Schema) {
    let is_cryogenic = is_cryogenic(reviewer.scene);
    let copies = reviewer.scene.copied_materials();
    let mut warned_list = None;
    schema.numbers(reviewer.source, &mut |place, limits, value| {
        // Of a list, the first number that is out of range: the others are hardly better.
        let is_said = place.list().is_some() && place.list() == warned_list;
        if limits.is_usual(value) || is_said {
            return;
        }
        let Some(message) =
            limits.plausible(is_cryogenic).and_then(|range| implausible(&range, value))
        else {
            return;
        };
        let path = place.path();
        if !copies.iter().any(|copy| path.is_within(copy)) {
            warned_list = place.list();
            reviewer.warn(&path, message);
        }
    });
}

/// Density below which a liquid is hydrogen or helium [kg/m³].
const LIGHTEST_COMMON: f64 = 150.0;

/// Whether cold temperatures are believed, as around the lightest liquids.
pub fn is_cryogenic(scene: &Scene) -> bool {
    scene.droplets().any(|(_, droplet)| droplet.fluid.density < LIGHTEST_COMMON)
}

//! Temperatures at which constants of the library do not hold.

use super::{Reviewer, number};
use crate::limits::TEMPERATURE;
use crate::scene::locate::{Path, Step};
use crate::scene::schema::Schema;
use crate::scene::{NamedSubstance, Source};
use crate::warning;

/// Warns of each substance whose constants are taken beyond their range, or that a body is colder or hotter than, on the
/// first such temperature.
pub fn review(reviewer: &mut Reviewer, schema: &Schema) {
    for named in reviewer.source.substances() {
        let [low, high] = named.substance.sheet().valid;
        let at = named.at.filter(|at| !(low..=high).contains(at));
        let mut outside = at.map(|at| (named.table.clone(), at));
        schema.numbers(reviewer.source, &mut |place, limits, value| {
            if limits.noun != Some(TEMPERATURE) || (low..=high).contains(&value) {
                return;
            }
            let path = place.path();
            if outside.is_none() && is_met(reviewer.source, named, &path) {
                outside = Some((path, value));
            }
        });
        if let Some((path, value)) = outside {
            let [low, high, value] = [low, high, value].map(number);
            let name = named.substance.name;
            reviewer.warn(&path, warning::substance_out_of_range(name, low, high, value));
        }
    }
}

/// Returns true if a temperature is one that the body of a substance has from outside or from the start.
fn is_met(source: &Source, named: &NamedSubstance, path: &Path) -> bool {
    let [Step::Key(root), Step::Key(body), Step::Key(key), ..] = path.steps() else { return false };
    if root != "body" || !matches!(key.as_str(), "initial_temperature" | "faces") {
        return false;
    }
    let body = Path::default().key("body").key(body);
    if named.table.is_within(&body) {
        return true;
    }
    let is_named = |place: &Path| source.value(place).and_then(|value| value.as_str());
    let layers = (0..).map(|i| body.key("layers").index(i).key("material"));
    let layers = layers.take_while(|place| source.value(place).is_some());
    layers.chain([body.key("material")]).any(|place| {
        is_named(&place)
            .is_some_and(|name| Path::default().key("material").key(name) == named.table)
    })
}

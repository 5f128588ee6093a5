//! Temperatures at which constants of the library do not hold.

use super::{Reviewer, number};
use crate::laws::{Fluid, Property};
use crate::limits::TEMPERATURE;
use crate::scene::locate::{Path, Step};
use crate::scene::schema::Schema;
use crate::scene::{Body, Droplet, NamedSubstance, Scene};
use crate::warning;

/// Difference of temperatures [K], and of constants relative to them, below which those of another temperature will do.
const CLOSE: f64 = 1.0;
const ALIKE: f64 = 0.02;

/// Warns of each substance whose constants are taken beyond their range, or that a body is colder or hotter than, on
/// the temperature that is farthest off; of drops that are of another temperature than their constants; and of solids
/// whose mean expansion counts from another temperature than theirs without stress.
pub fn review(reviewer: &mut Reviewer, schema: &Schema) {
    let scene = reviewer.scene;
    for named in &scene.substances {
        let [low, high] = named.valid;
        let slack = NamedSubstance::ROUNDED;
        let holds = |value: f64| (low - slack..=high + slack).contains(&value);
        let at = named.at.filter(|at| !holds(*at));
        let mut outside = at.map(|at| (named.table.clone(), at));
        schema.numbers(reviewer.source, &mut |place, limits, value| {
            if limits.noun != Some(TEMPERATURE) || holds(value) {
                return;
            }
            let path = place.path();
            let beyond = |value: f64| (low - value).max(value - high);
            let is_worse = outside.as_ref().is_none_or(|(_, other)| beyond(value) > beyond(*other));
            if is_worse && is_met(scene, named, &path) {
                outside = Some((path, value));
            }
        });
        if let Some((path, value)) = outside {
            let [low, high, value] = [low, high, value].map(number);
            let name = named.substance.name;
            let finding = match named.at.filter(|at| holds(*at)).map(number) {
                Some(at) => warning::substance_away_from_its_constants(name, low, high, value, at),
                None => warning::substance_out_of_range(name, low, high, value),
            };
            reviewer.warn(&path, finding);
        }
    }
    for (name, body) in &scene.body {
        for named in scene.substances_of(name) {
            expansion(reviewer, (name, body), named);
        }
    }
    for (name, droplet) in scene.droplets() {
        let path = Path::default().key("body").key(name).key("initial_temperature");
        for named in scene.substances_of(name) {
            drops(reviewer, &path, droplet, named);
        }
    }
}

/// Returns true if a temperature is one that the body of a substance has from outside, its bath too, or from the start.
fn is_met(scene: &Scene, named: &NamedSubstance, path: &Path) -> bool {
    let [Step::Key(root), Step::Key(body), Step::Key(key), ..] = path.steps() else { return false };
    root == "body"
        && matches!(key.as_str(), "initial_temperature" | "faces" | "bath")
        && scene.substances_of(body).any(|own| own == named)
}

/// Warns of a drop whose temperature was set after its constants had been taken.
fn drops(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet, named: &NamedSubstance) {
    let (start, None, Some(taken)) = (droplet.initial_temperature, named.at, named.taken) else {
        return;
    };
    if (start - taken).abs() < CLOSE {
        return;
    }
    let (then, now) = (named.constants_at(taken), named.constants_at(start));
    let changed = then.iter().zip(&now).filter(|((key, old), (_, new))| {
        constant(&droplet.fluid, key) == Some(*old) && (new / old - 1.0).abs() > ALIKE
    });
    let changed: Vec<_> = changed
        .map(|((key, old), (_, new))| {
            let [new, old] = [*new, *old].map(|value| number(digits(value)));
            format!("{key} = {new} instead of {old}")
        })
        .collect();
    if !changed.is_empty() {
        let (name, taken) = (named.substance.name, number(taken));
        let finding = warning::constants_of_other_temperature(name, taken, changed.join(", "));
        reviewer.warn(path, finding);
    }
}

/// Warns of a body whose temperature without stress was set after its mean expansion had been taken.
fn expansion(reviewer: &mut Reviewer, (name, body): (&str, &Body), named: &NamedSubstance) {
    let (Some(&then), Some(now)) = (named.stress_free.get(name), body.temperature_without_stress())
    else {
        return;
    };
    let means = [then, now].map(|free| named.mean_expansion_from(free));
    let [Some(old), Some(new)] = means else { return };
    let keeps = body.materials().iter().any(|choice| {
        let properties = choice.material().properties();
        properties.iter().any(|(key, own)| *key == "expansion" && **own == Property::Constant(old))
    });
    if (now - then).abs() < CLOSE || (new / old - 1.0).abs() < ALIKE || !keeps {
        return;
    }
    let path = Path::default().key("body").key(name).key("initial_temperature");
    let [then, now] = [then, now].map(number);
    let [new, old] = [new, old].map(|value| number(digits(value)));
    let name = named.substance.name;
    reviewer.warn(&path, warning::expansion_from_other_temperature(name, then, now, new, old));
}

fn constant(fluid: &Fluid, key: &str) -> Option<f64> {
    match key {
        "density" => Some(fluid.density),
        "viscosity" => fluid.viscosity.constant(),
        "specific_heat" => Some(fluid.specific_heat),
        "conductivity" => Some(fluid.conductivity),
        "surface_tension" => Some(fluid.surface_tension),
        _ => None,
    }
}

/// Rounds to four digits.
fn digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

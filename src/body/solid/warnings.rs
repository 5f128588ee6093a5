//! Warnings about a state of a solid: heat of particles, and melting fronts.

use super::crack::Coarse;
use super::cracking::DamageAway;
use super::{SolidBody, flaw_reading, point_quantities, totals};
use crate::body::Reading;
use crate::limits::{number, two_digits};
use crate::quantity::percent;
use crate::scene::{Flaw, lateral_extents};
use crate::warning::{self, Finding, Warning};

/// Share of the transferred heat that particles may create or lose without a warning.
const MOST_DRIFT: f64 = 0.05;
/// Support radius from which on particles have enough neighbours on every mesh [particle spacings].
const SAFE_SUPPORT: f64 = 2.0;

/// Scatter of fronts over the tolerance below which there is no warning: the scatter bounds their error.
const SAFE: f64 = 1.25;
/// Largest ratio of element counts to those of the present mesh up to which a finer mesh is proposed.
const FARTHEST: f64 = 8.0;

/// Returns `None` if finite elements conduct the heat, or if particles conserve it.
pub fn of_particles(body: &SolidBody, state: &[f64]) -> Option<Finding> {
    let fallback = body.solid.fallback_particles()?;
    if fallback > 0 {
        let particles = body.plan.mesh.nodes();
        return Some(warning::particles_lack_neighbours(fallback, particles, SAFE_SUPPORT));
    }
    let heat = body.heat_of(state);
    let (stored, totals) = (body.solid.heat_stored(heat), body.solid.heat_totals(heat));
    let passed = stored.abs().max(totals.brought_in.abs()).max(totals.lost.abs());
    let part = body.solid.heat_drift(heat).abs() / passed;
    let [shown, most] = [part, MOST_DRIFT].map(|part| format!("{:.0}", 100.0 * part));
    (part > MOST_DRIFT).then(|| warning::particles_lose_heat(shown, most))
}

/// Opening of a crack over the size of its elements from which on it has torn a part off.
const TORN: f64 = 2.0;
/// Damage from which on it counts without cracks, its part of all energy of damage from which on it does beside them,
/// and the part of the largest that the mean reaches where it is even.
const DAMAGED: f64 = 0.05;
const COSTLY: f64 = 0.1;
const EVEN: f64 = 0.8;
const NO_SCATTER: &str = "`scatter = 0.05` of `fracture` makes elements differ as grains do";
const MORE_THAN_IT_BEARS: &str = "with `scatter` as there is, look for stress beyond the strength everywhere, as \
                                  heat makes in plane strain; AT2 is damaged from the first load on";

/// Returns `None` unless a crack has opened so wide that a part is loose.
pub fn of_torn_parts(body: &SolidBody, state: &[f64]) -> Option<Finding> {
    let opening = body.opening_of_cracks(state);
    (opening > TORN).then(|| warning::torn_apart(format!("{opening:.0}")))
}

/// Elastic shear strain over the root of three, and displacement over the smallest extent, from which on strain counts
/// as large.
const LARGE_STRAIN: f64 = 0.1;
const LARGE_DISPLACEMENT: f64 = 0.5;

/// Warns of a stress or a displacement that small strain does not hold for.
pub fn of_large_strain(body: &SolidBody, reading: &Reading, value: f64) -> Option<Warning> {
    let large = match *reading {
        Reading::Total(place) if totals::is_von_mises(place) => {
            let strain = value / (3.0 * body.shear_modulus?);
            let percents = format!("{:.0}", 100.0 * strain);
            (strain > LARGE_STRAIN).then(|| format!("elastic strain is {percents} %"))
        }
        Reading::Point { quantity, .. } if point_quantities()[quantity].is_displacement() => {
            let [width, depth] = lateral_extents(&body.shape);
            let least = width.min(depth).min(body.shape.thickness());
            (value.abs() > LARGE_DISPLACEMENT * least).then(|| {
                format!("a point has moved by {value:.1e} m in a body of {} m", number(least))
            })
        }
        _ => None,
    };
    large.map(|what| warning::strain_is_large(what).at(&body.name))
}

/// Warns of a worst depth of a flaw that its formula does not hold for, or over which the mesh is too coarse.
pub fn of_worst_depth(body: &SolidBody, reading: &Reading, value: f64) -> Option<Warning> {
    let Reading::Flaw { flaw, quantity } = *reading else { return None };
    let crack = body.crack(flaw).ok().filter(|_| flaw_reading::is_worst_depth(quantity))?;
    let (name, reach) = crack.searched()?;
    let part = value / reach;
    if part > Flaw::SHALLOW {
        let finding = warning::flaw_worst_is_deep(name, percent(part), percent(Flaw::SHALLOW));
        return Some(finding.at(&body.name).of_subject(format!("{name} is deep")));
    }
    let coarse = crack.too_few_elements_over(value)?;
    Some(unresolved(body, coarse).of_subject(format!("{name} is shallow")))
}

/// Warns of a flaw along which the mesh is too coarse.
fn unresolved(body: &SolidBody, Coarse { name, elements, finer }: Coarse) -> Warning {
    let finding = warning::flaw_unresolved(name, format!("{elements:.1}"), format!("{finer:.0e}"));
    finding.at(&body.name)
}

/// Returns `None` unless all of the body but its cracks is damaged alike, and that damage counts beside theirs.
pub fn of_even_damage(body: &SolidBody, state: &[f64]) -> Option<Finding> {
    let DamageAway { most, mean, part, scatters } = body.damage_away(state);
    let counts = if body.max_damage(state) > most { part > COSTLY } else { most > DAMAGED };
    let is_torn = body.opening_of_cracks(state) > TORN;
    let remedy = if scatters { MORE_THAN_IT_BEARS } else { NO_SCATTER };
    (counts && mean > EVEN * most && !is_torn)
        .then(|| warning::damage_is_even(format!("{most:.2}"), format!("{mean:.2}"), remedy))
}

/// Longest element at a free side over the thickness with which a risk of failure is right to some per cent: within
/// about a thickness of the side stress falls to what a free face bears.
const AT_RIM: f64 = 0.5;

/// Returns `None` unless a risk of failure is read on a mesh that is coarse at a free side.
pub fn of_rim(body: &SolidBody) -> Option<Finding> {
    body.solid.flaws()?;
    let free = body.solid.free_faces();
    let length = |axis: usize, high: bool| {
        let own = &body.plan.mesh.axes[axis];
        free.is_free(axis, high).then(|| {
            let [start, end] = own.bounds(if high { own.elements() - 1 } else { 0 });
            end - start
        })
    };
    let lengths = [(0, false), (0, true), (1, false), (1, true)];
    let longest = lengths.into_iter().filter_map(|(axis, high)| length(axis, high));
    let part = longest.fold(0.0, f64::max) / body.shape.thickness();
    (part > AT_RIM).then(|| {
        let finer = two_digits(0.5 * AT_RIM * body.shape.thickness());
        warning::risk_unresolved_near_rim(format!("{part:.1}"), finer)
    })
}

/// Returns the flaws along which the mesh is too coarse, and those that have grown too deep for their formula.
pub fn of_flaws(body: &SolidBody, state: &[f64]) -> Vec<Warning> {
    let coarse = body.cracks.iter().filter_map(|(_, crack)| crack.too_few_elements());
    let grown = body.grown_parts(state).filter(|(_, part)| *part > Flaw::SHALLOW);
    let has_grown = |(name, part): (&str, f64)| {
        let finding = warning::flaw_has_grown(name, percent(part), percent(Flaw::SHALLOW));
        finding.at(&body.name).of_subject(format!("{name} has grown"))
    };
    coarse.map(|own| unresolved(body, own)).chain(grown.map(has_grown)).collect()
}

/// Returns `None` if nothing melts or the front keeps the tolerance.
pub fn of_fronts(body: &SolidBody, state: &[f64]) -> Option<Finding> {
    let heat = body.heat_of(state);
    let off = body.solid.liquid_scatter(heat) / body.solid.liquid_volume(heat);
    let denser = off / body.tolerance;
    (denser > SAFE).then(|| {
        let remedy = match denser {
            near if near <= FARTHEST => {
                format!(
                    "about {near:.1} times as many elements where the front stands would keep it"
                )
            }
            _ => format!("this mesh keeps a `fidelity.tolerance` of {:.0e}", 1.5 * off),
        };
        let volume = format!("{}.liquid_volume", body.name);
        warning::front_scatters(volume, percent(off), percent(body.tolerance), remedy)
    })
}

//! What a user should know of a state: where particles that conduct heat, and fronts that melt, are not to be trusted.

use super::SolidBody;
use crate::quantity::percent;

/// Part of the heat that passed which particles may make or lose before a user is told.
const MOST_DRIFT: f64 = 0.05;
/// Support radius from which on particles have neighbours enough on every mesh [distances of particles].
const SAFE_SUPPORT: f64 = 2.0;

/// Scatter of fronts over the tolerance from which on a user is told: it is what they err by at most.
const SAFE: f64 = 1.25;
/// Numbers of elements over those of a mesh up to which a finer one is proposed.
const FARTHEST: f64 = 8.0;

/// Nothing where finite elements conduct the heat, or where nothing is amiss.
pub fn of_particles(body: &SolidBody, state: &[f64]) -> Option<String> {
    let fallback = body.solid.fallback_particles()?;
    let name = &body.name;
    if fallback > 0 {
        return Some(format!(
            "{name}: {fallback} of {} particles conduct by the plain operator, as they have too few neighbours for \
             the corrected one: temperatures are wrong by tens of per cent, or grow without end; an `sph.support` \
             of {SAFE_SUPPORT} or more would do",
            body.plan.mesh.nodes()
        ));
    }
    let heat = body.heat_of(state);
    let (stored, totals) = (body.solid.heat_stored(heat), body.solid.heat_totals(heat));
    let passed = stored.abs().max(totals.brought_in.abs()).max(totals.lost.abs());
    let part = body.solid.heat_drift(heat).abs() / passed;
    (part > MOST_DRIFT).then(|| {
        format!(
            "{name}: particles have made or lost {:.0} % of the heat, more than {:.0} %, as their distances grow too \
             fast (`heat_drift`): a `mesh.growth` nearer 1, or `heat = \"fem\"`, would keep it",
            100.0 * part,
            100.0 * MOST_DRIFT
        )
    })
}

/// Nothing where nothing melts or the front is as good as asked for.
pub fn of_fronts(body: &SolidBody, state: &[f64]) -> Option<String> {
    let heat = body.heat_of(state);
    let off = body.solid.liquid_scatter(heat) / body.solid.liquid_volume(heat);
    let name = &body.name;
    let denser = off / body.tolerance;
    (denser > SAFE).then(|| {
        let remedy = match denser {
            near if near <= FARTHEST => {
                format!("about {near:.1} times as many elements where the front stands would keep it")
            }
            _ => format!("a `fidelity.tolerance` of {:.0e} is what this mesh keeps", 1.5 * off),
        };
        format!(
            "{name}: {name}.liquid_volume errs by up to about {} of itself, and temperatures behind the front by as much of \
             what they rise above that of melting, as the front goes from node to node, more than the tolerance of {}: \
             {remedy}",
            percent(off),
            percent(body.tolerance)
        )
    })
}

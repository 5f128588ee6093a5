//! What may be wrong with a state of a solid: the heat of particles, and fronts that melt.

use super::SolidBody;
use crate::quantity::percent;
use crate::warning::{self, Finding};

/// Part of the heat that passed which particles may make or lose without a warning.
const MOST_DRIFT: f64 = 0.05;
/// Support radius from which on particles have neighbours enough on every mesh [distances of particles].
const SAFE_SUPPORT: f64 = 2.0;

/// Scatter of fronts over the tolerance up to which no warning follows: it bounds their error.
const SAFE: f64 = 1.25;
/// Numbers of elements over those of a mesh up to which a finer one is proposed.
const FARTHEST: f64 = 8.0;

/// Nothing where finite elements conduct the heat, or where particles keep it.
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

/// Nothing where nothing melts or the front keeps the tolerance.
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

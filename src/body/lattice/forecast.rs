//! Cost of lattices, and notes on their model.

use super::plan;
use crate::limits::number;
use crate::method::lattice::LatticePlan;
use crate::scene::{Lattice, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct LatticeForecast {
    pub name: String,
    pub particles: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Memory [B].
    pub memory: f64,
    /// Time of all steps of the default experiment [s].
    pub run_time: f64,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Memory of an unknown in the factor, the responses of links that change, and the state, per power of the unknowns
/// [B].
const MEMORY: f64 = 4000.0;
/// Time of an unknown in a communication step [s]: some two steps of three iterations each, measured on beams of 1600
/// to 15 000 unknowns.
const STEP: f64 = 6e-6;

impl LatticeForecast {
    pub fn of(scene: &Scene, name: &str, lattice: &Lattice) -> Self {
        let plan = plan::plan_of(lattice);
        let particles = plan.strip.count();
        let unknowns = 3 * particles;
        let steps = (scene.stop_time / scene.step).ceil();
        Self {
            name: name.to_owned(),
            particles,
            unknowns,
            memory: MEMORY * unknowns as f64,
            run_time: STEP * steps * unknowns as f64,
            notes: notes(lattice),
        }
    }
}

/// Returns notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(lattice: &Lattice) -> Vec<String> {
    let plan = plan::plan_of(lattice);
    let spacing = plan.strip.fitted_spacing();
    let mut notes = vec![
        format!(
            "{} particles {spacing:.3e} m apart, {} over the depth{}",
            plan.strip.count(),
            plan.strip.layers(),
            ligament(&plan)
        ),
        "the strip is in equilibrium at every time, in plane stress and with small rotations; inertia, weight and creep \
         are left out (docs/theory/lattice.md)"
            .to_owned(),
        energy(&plan),
    ];
    notes.extend(stability(&plan));
    notes
}

/// Number of particles above a notch, in words.
fn ligament(plan: &LatticePlan) -> String {
    plan.strip.notch.map_or(String::new(), |notch| {
        let above = (plan.strip.depth - notch.depth)
            / (plan.strip.arrangement.unit() * plan.strip.fitted_spacing());
        format!(", of which {above:.0} above the notch")
    })
}

/// Strength and energy of a crack, which runs across the rows of links.
fn energy(plan: &LatticePlan) -> String {
    let (strength, energy) = plan.strength_and_energy();
    format!(
        "links along the pull soften at {} MPa, and a straight crack takes about {} J/m²",
        number((strength / 1e4).round() / 100.0),
        number((energy * 10.0).round() / 10.0)
    )
}

/// Elongations of a softening link over those of its neighbours below which it breaks suddenly.
const SLOW_ENOUGH: f64 = 2.0;

/// Notes links so long that they break suddenly.
fn stability(plan: &LatticePlan) -> Option<String> {
    let spacing = plan.strip.fitted_spacing();
    let law = plan.softening.of_link(spacing, plan.sheet.young, 1.0);
    (law.knee - 1.0 < SLOW_ENOUGH).then(|| {
        format!(
            "links stretch by only {:.2} times their elastic limit to the knee of their law, so that they break one by one \
             with jumps of the load: a `spacing` of {:.1e} or less makes them soften",
            law.knee - 1.0,
            spacing * (law.knee - 1.0) / SLOW_ENOUGH
        )
    })
}

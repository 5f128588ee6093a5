//! Cost of lattices, and notes on their model.

use super::plan;
use crate::limits::{number, two_digits, two_digits_below};
use crate::method::lattice::{LatticePlan, MovingLattice};
use crate::scene::{Lattice, LatticeArrangement, LatticeSupport, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct LatticeForecast {
    pub name: String,
    pub particles: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Time step of a strip with inertia [s].
    pub time_step: Option<f64>,
    /// Time steps of the default experiment, or its communication steps.
    pub steps: f64,
    /// Memory [B].
    pub memory: f64,
    /// Time of all steps of the default experiment, whose inputs are zero [s].
    pub run_time: f64,
    /// Time per length of what the input of a strip in equilibrium prescribes, while links soften [s/m].
    pub time_per_metre: Option<f64>,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Memory of an unknown in the factor, the responses of links that change, and the state, per power of the unknowns
/// [B].
const MEMORY: f64 = 4000.0;
/// Time of an unknown in a communication step [s]: some two steps of three iterations each, measured on beams of 1600
/// to 15 000 unknowns.
const STEP: f64 = 6e-6;
/// Time of an unknown in a step of the strip's own in which links soften [s]: 5e-6 to 12e-6 were measured on beams of
/// 1700 to 12 000 unknowns that are bent until they are in two, and 1e-6 where they break at once.
const OWN_STEP: f64 = 8e-6;
/// Memory of a particle in motion with its links [B], and its time in a time step [s].
const MOVING_MEMORY: f64 = 1000.0;
const MOVING: f64 = 6e-8;
/// Least square of the highest frequency of hexagons, times the spacing over the speed of waves in a bar, and that of
/// random particles over that of hexagons.
const LEAST: f64 = 6.0;
const UNEVEN: f64 = 1.6;

impl LatticeForecast {
    pub fn of(scene: &Scene, name: &str, lattice: &Lattice) -> Self {
        let plan = plan::plan_of(lattice);
        let particles = plan.strip.count();
        let unknowns = 3 * particles;
        let exchanges = (scene.stop_time / scene.step).ceil();
        let time_step = lattice.inertia.then(|| time_step(lattice));
        let steps = time_step.map_or(exchanges, |dt| (scene.stop_time / dt).max(exchanges));
        let [memory, of_step] = match lattice.inertia {
            true => [MOVING_MEMORY * particles as f64, MOVING * particles as f64],
            false => [MEMORY * unknowns as f64, STEP * unknowns as f64],
        };
        Self {
            name: name.to_owned(),
            particles,
            unknowns,
            time_step,
            steps,
            memory,
            run_time: of_step * steps,
            time_per_metre: (!lattice.inertia)
                .then(|| OWN_STEP * unknowns as f64 / plan.longest_step()),
            notes: notes(lattice),
        }
    }
}

/// Estimate of the time step [s]: below a Poisson's ratio of 0.2 particles spin fastest, at
/// `ω² s²/c² = 14.4 (1 − 3ν)/(1 − ν²)`.
fn time_step(lattice: &Lattice) -> f64 {
    let Lattice { material, arrangement, .. } = lattice;
    let ratio = material.poisson;
    let spin = 14.4 * (1.0 - 3.0 * ratio) / (1.0 - ratio * ratio);
    let uneven = if *arrangement == LatticeArrangement::Random { UNEVEN } else { 1.0 };
    let spacing = plan::plan_of(lattice).strip.fitted_spacing();
    let crossing = spacing * (material.density / material.young).sqrt();
    MovingLattice::SHARE * 2.0 * crossing / (uneven * spin.max(LEAST)).sqrt()
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
        if lattice.inertia { IN_MOTION } else { AT_REST }.to_owned(),
        energy(lattice, &plan),
    ];
    notes.extend(coarse(lattice, &plan));
    notes.extend(stability(&plan));
    notes.extend(sudden(lattice, &plan));
    notes
}

const AT_REST: &str = "the strip is in equilibrium at every time, in plane stress and with small rotations; inertia, \
                       weight and creep are left out (docs/theory/lattice.md)";
const IN_MOTION: &str = "the strip moves in plane stress, its links turn by any angle, and supports hold it in both \
                         directions; weight, creep and contact of parts that were not neighbours are left out \
                         (docs/theory/lattice.md)";

/// Number of particles above a notch, in words.
fn ligament(plan: &LatticePlan) -> String {
    plan.strip.notch.map_or(String::new(), |notch| {
        let above = (plan.strip.depth - notch.depth)
            / (plan.strip.arrangement.unit() * plan.strip.fitted_spacing());
        format!(", of which {above:.0} above the notch")
    })
}

/// Energy of a crack over that of a link per area, in strips that are pulled until they are in two, at ν = 0 to
/// 0.2, about the middle of samples from 0.84 to 1.24, from 1.24 to 1.74 and from 0.91 to 1.37
/// (`tests/verification/lattice.rs`): a crack that begins at two places takes more than a straight one. At ν = 1/3, where
/// links do not bend, `along` takes half of that.
fn share_of_crack(arrangement: LatticeArrangement) -> f64 {
    match arrangement {
        LatticeArrangement::Across => 1.1,
        LatticeArrangement::Along => 1.3,
        LatticeArrangement::Random => 1.1,
    }
}

/// Strength, and energy of a link and of a crack.
fn energy(lattice: &Lattice, plan: &LatticePlan) -> String {
    let (strength, energy) = plan.strength_and_energy();
    let tenths = |value: f64| number((value * 10.0).round() / 10.0);
    let area = plan.softening.area().map_or_else(String::new, |area| {
        format!("the area below their law is {} J/m², ", two_digits(area))
    });
    let stored = if area.is_empty() { "" } else { ", with what it stores up to that" };
    format!(
        "links soften at {} MPa; {area}a link takes {} J/m²{stored}, and a crack some {} J/m², a quarter more or less \
         by sample",
        number((strength / 1e4).round() / 100.0),
        tenths(energy),
        tenths(share_of_crack(lattice.arrangement) * energy)
    )
}

/// Part of the energy of a crack that a pulled strip may store at its strength without breaking at once: all of it where
/// stress falls evenly with the opening, less where it falls steeply at first.
const STORED: f64 = 0.5;

/// Notes pulled strips that break suddenly, as they store more energy than their crack takes.
fn sudden(lattice: &Lattice, plan: &LatticePlan) -> Option<String> {
    let is_pulled = matches!(lattice.support, LatticeSupport::Ends) && !lattice.inertia;
    let (strength, energy) = plan.strength_and_energy();
    let stored = 0.5 * strength * strength * lattice.length / lattice.material.young;
    let crack = share_of_crack(lattice.arrangement) * energy;
    (is_pulled && stored > STORED * crack).then(|| {
        format!(
            "pulled to its strength the strip stores {stored:.0} J/m², and a crack takes {crack:.0}: it breaks suddenly, \
             which takes minutes that the forecast leaves out; approach the strength in small steps of the input, or set \
             `inertia = true`"
        )
    })
}

/// Particles over the depth of a bent strip, above its notch, from which on peaks are within a tenth.
const FINE: f64 = 8.0;

/// Notes bent strips with few particles in the way of a crack.
fn coarse(lattice: &Lattice, plan: &LatticePlan) -> Option<String> {
    let LatticeSupport::ThreePoint(_) = lattice.support else { return None };
    let below = plan.strip.notch.map_or(0.0, |notch| notch.depth);
    let rows = (plan.strip.depth - below) / plan.strip.fitted_spacing();
    (rows < FINE).then(|| {
        format!(
            "a crack has {rows:.1} spacings to go, of which two below the load stay intact: loads after the peak are too \
             high, and the peak by some 5 %; a `spacing` of {:.1e} or less has them",
            (plan.strip.depth - below) / (2.0 * FINE)
        )
    })
}

/// Elongations of a softening link over those of its neighbours below which it breaks suddenly.
const SLOW_ENOUGH: f64 = 2.0;

/// Notes links so long that they break suddenly.
fn stability(plan: &LatticePlan) -> Option<String> {
    let spacing = plan.strip.fitted_spacing();
    let law = plan.softening.of_link(spacing, plan.sheet.young, 1.0);
    (law.knee - 1.0 < SLOW_ENOUGH).then(|| {
        format!(
            "links stretch by only {} times their elastic limit to the knee of their law, so that they break one by \
             one with jumps of the load: a `spacing` of {} or less makes them soften",
            two_digits(law.knee - 1.0),
            two_digits_below(spacing * (law.knee - 1.0) / SLOW_ENOUGH)
        )
    })
}

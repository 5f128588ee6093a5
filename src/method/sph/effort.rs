//! How many time steps a run of droplets takes, and for how long they are computed.
//!
//! Times are sums of what time steps, listings of neighbours and sheets of the free surface take. Each was
//! found from processor times of some fifty runs, many of which differ in one of these alone: of 226 to 8378
//! particles, free and on walls, with and without tension and heat, on one thread. Other work ran on the machine
//! meanwhile, which lengthens such times by some tenths; times of a step were set lower by about that, by judgement.
//! Beyond that range times are in proportion to particles and steps.

use std::f64::consts::PI;

use super::images::copies;
use super::method::Method;
use super::plan::{DropletPlan, Release};
use super::rings::PLACES;
use crate::scene::Precision;

/// What the effort of a run depends on beside the droplet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSettings {
    /// End of the run [s].
    pub stop: f64,
    /// Time between two readings of the droplet [s].
    pub reading: f64,
    /// Time between two exchanges with what is below: one advance [s].
    pub exchange: f64,
    /// Diameter over which drops are expected to spread on what is below, over their own; nothing in free space.
    pub spread: Option<f64>,
}

/// What a run takes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Time steps.
    pub steps: f64,
    /// Time to compute on one thread of a processor of 2024 with AVX-512 [s].
    pub seconds: f64,
}

/// Times for each particle [s]: of a time step in free space, more of it above a wall, more for each particle
/// at the wall, whose images are near, and more with heat.
const STEP: f64 = 0.55e-6;
const STEP_AT_WALL: f64 = 0.10e-6;
const STEP_IN_FILM: f64 = 0.50e-6;
const STEP_WITH_HEAT: f64 = 0.10e-6;
/// Of a time step with tension, of an impulse of tension for all particles and for those near a surface, and of
/// listing those anew.
const TENSION_STEP: f64 = 0.42e-6;
const TENSION_IMPULSE: f64 = 1.2e-6;
const TENSION_NEAR_SURFACE: f64 = 6.0e-6;
const TENSION_LISTING: f64 = 0.5e-6;
const TENSION_LISTING_AT_WALL: f64 = 2.3e-6;
/// Layers of particles at a free surface that tension has to do with.
const LAYERS: f64 = 1.0;
/// Of the beginning of an advance, and for each particle at the wall with heat; of a reading, for each particle
/// or image at the wall.
const ADVANCE: f64 = 1.0e-6;
const ADVANCE_ABOVE_HEAT: f64 = 4.0e-6;
const READING: f64 = 2.5e-6;
/// Growth with the number of neighbours, and of double precision.
const BY_NEIGHBOURS: f64 = 0.7;
const USUAL_SUPPORT: f64 = 3.0;
const DOUBLE: f64 = 2.7;
/// A plane model's tension beside that of a drop.
const PLANE_TENSION: f64 = 0.25;
/// Tension of rings beside that of particles.
const RING_TENSION: f64 = 0.6;
/// Speed of what is pressed out below a drop over that of the drop: bounds time steps by sound.
const PRESSED_OUT: f64 = 3.0;
const PRESSED_OUT_IN_PLANE: f64 = 5.0;
/// Places in time at which a run is looked at.
const SAMPLES: usize = 200;

impl Effort {
    pub fn of(plan: &DropletPlan, run: RunSettings) -> Self {
        let method = Method::of(plan);
        let length = run.stop / SAMPLES as f64;
        let rates = |n: usize| rates_at(plan, &method, run, (n as f64 + 0.5) * length);
        (0..SAMPLES).map(rates).fold(Self::default(), |sum, rate| Self {
            steps: sum.steps + length * rate.steps,
            seconds: sum.seconds + length * rate.seconds,
        })
    }
}

/// A drop at a time.
struct Drop {
    particles: f64,
    /// Speed of its fastest particles [m/s].
    fastest: f64,
    /// Share of its particles that lie at the wall, and that lie near its free surface.
    at_wall: f64,
    near_surface: f64,
}

/// Steps and computing time for a second of the run.
fn rates_at(plan: &DropletPlan, method: &Method, run: RunSettings, time: f64) -> Effort {
    let released = plan.drops().filter(|release| release.time <= time);
    let drops: Vec<Drop> =
        released.map(|release| drop_at(plan, &release, run.spread, time)).collect();
    let particles: f64 = drops.iter().map(|drop| drop.particles).sum();
    if particles == 0.0 {
        return Effort::default();
    }
    let mean = |share: fn(&Drop) -> f64| {
        drops.iter().map(|drop| drop.particles * share(drop)).sum::<f64>() / particles
    };
    let (at_wall, near_surface) = (mean(|drop| drop.at_wall), mean(|drop| drop.near_surface));
    let fastest = drops.iter().map(|drop| drop.fastest).fold(0.0, f64::max);
    let units = &method.units;
    let stable = method.stable_step(fastest / units.speed, gravity(plan, method)) * units.time();
    let steps = (run.exchange / stable - 1e-9).ceil().max(1.0);
    let turn = method.turn(run.exchange / steps / units.time()).min(steps);
    let impulses = (steps / turn).ceil();
    let exact = if plan.precision == Precision::Double { DOUBLE } else { 1.0 };
    let walled = f64::from(u8::from(run.spread.is_some()));
    let heated = if method.conduction > 0.0 { walled } else { 0.0 };
    let pairs = neighbours(plan).powf(BY_NEIGHBOURS) * exact;
    let tension_factor = if method.surface.is_some() { exact * tension(plan) } else { 0.0 };
    // In a plane model's thin film most particles have images.
    let of_wall = walled * (STEP_AT_WALL + STEP_IN_FILM * at_wall);
    let of_steps = STEP * pairs + of_wall * pairs.max(1.0) + STEP_WITH_HEAT * heated;
    let listing = TENSION_LISTING + TENSION_LISTING_AT_WALL * walled;
    let of_advance = steps * (of_steps + TENSION_STEP * tension_factor)
        + ADVANCE
        + ADVANCE_ABOVE_HEAT * heated * at_wall
        + tension_factor
            * (listing + impulses * (TENSION_IMPULSE + TENSION_NEAR_SURFACE * near_surface));
    let of_reading = READING * copies(plan.mirrors) * walled * at_wall;
    let seconds = particles * (of_advance / run.exchange + of_reading / run.reading);
    Effort { steps: steps / run.exchange, seconds }
}

/// A drop grows on the wall as `√(3 U t/D)` at first, and no wider than it is expected to spread.
fn drop_at(plan: &DropletPlan, release: &Release, spread: Option<f64>, time: f64) -> Drop {
    let diameter = release.diameter;
    let gravity = plan.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let speed = release.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
    let falling = -release.velocity[2];
    let across = diameter / plan.spacing;
    let gap = (release.centre[2] - 0.5 * diameter).max(0.0);
    let age = time - release.time;
    let fallen = falling * age + 0.5 * gravity * age * age;
    let (down, spread) = spread.map_or((0.0, 1.0), |spread| (fallen - gap, spread));
    let speed = (speed * speed + 2.0 * gravity * fallen.min(gap)).sqrt();
    let area = (3.0 * down.max(0.0) / diameter).min(spread * spread);
    let pressed = match (down > 0.0, plan.dimension) {
        (false, _) => 1.0,
        (true, 2) => PRESSED_OUT_IN_PLANE,
        (true, _) => PRESSED_OUT,
    };
    // A film on its disc, beside a ball: free surface over that of the ball.
    let surface = (0.5 * area).max(1.0);
    let (on_wall, layer) = match plan.axes() {
        2 => (4.0 / PI * area.sqrt() / across, 4.0 * LAYERS / across),
        _ => (1.5 * area / across, 6.0 * LAYERS / across),
    };
    Drop {
        particles: plan.particles_of(release.diameter),
        fastest: pressed * speed,
        at_wall: on_wall.min(1.0),
        near_surface: (layer * surface).min(1.0),
    }
}

/// Magnitude of gravity in the units of the method.
fn gravity(plan: &DropletPlan, method: &Method) -> f64 {
    let gravity = plan.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    gravity * method.units.length / method.units.speed.powi(2)
}

/// Number of neighbours of a particle over that of the usual support in three dimensions.
fn neighbours(plan: &DropletPlan) -> f64 {
    let of_ball = |support: f64| 4.0 / 3.0 * PI * support.powi(3);
    let number = match plan.dimension {
        _ if plan.axisymmetric => PLACES as f64 * PI * plan.support.powi(2),
        2 => PI * plan.support.powi(2),
        _ => of_ball(plan.support),
    };
    number / of_ball(USUAL_SUPPORT)
}

/// Points of the grid of the free surface for each particle, beside those of the usual support.
fn tension(plan: &DropletPlan) -> f64 {
    match plan.dimension {
        _ if plan.axisymmetric => RING_TENSION,
        2 => PLANE_TENSION,
        _ => (USUAL_SUPPORT / plan.support).powi(3),
    }
}

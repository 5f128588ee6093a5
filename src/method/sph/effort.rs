//! Number of time steps of a run of droplets, and its computing time.
//!
//! Computing times are sums over time steps, neighbour lists and sheets of the free surface. Each
//! contribution was fitted to processor times of some fifty runs, many of which differ in that
//! contribution alone. The runs had 226 to 8378 particles, free and on walls, with and without
//! tension and heat, on one thread. Other work on the machine lengthened these times by some
//! tenths, so the times of a step were set lower by about that, by judgement. Outside the range of
//! these runs, times are proportional to particles and steps.

use std::f64::consts::PI;

use super::images::copies;
use super::method::Method;
use super::plan::{DropletPlan, Release};
use super::rings::PLACES;
use crate::scene::Precision;

/// Settings of a run, besides the droplet, that determine its effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSettings {
    /// End of the run [s].
    pub stop: f64,
    /// Time between two readings of the droplet [s].
    pub reading: f64,
    /// Time between two exchanges with the body below: one advance [s].
    pub exchange: f64,
    /// Expected spread diameter of drops on the surface below, over their own diameter; `None` in
    /// free space.
    pub spread: Option<f64>,
}

/// Steps and computing time of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Number of time steps.
    pub steps: f64,
    /// Computing time on one thread of a 2024 processor with AVX-512 [s].
    pub seconds: f64,
}

/// Times per particle [s] of a time step: in free space; in addition above a wall; in addition for
/// each particle at the wall, whose images are near; in addition with heat.
const STEP: f64 = 0.55e-6;
const STEP_AT_WALL: f64 = 0.10e-6;
const STEP_IN_FILM: f64 = 0.50e-6;
const STEP_WITH_HEAT: f64 = 0.10e-6;
/// Times per particle [s] of: a time step with tension; an impulse of tension, for all particles
/// and for those near a surface; a listing of the latter.
const TENSION_STEP: f64 = 0.42e-6;
const TENSION_IMPULSE: f64 = 1.2e-6;
const TENSION_NEAR_SURFACE: f64 = 6.0e-6;
const TENSION_LISTING: f64 = 0.5e-6;
const TENSION_LISTING_AT_WALL: f64 = 2.3e-6;
/// Number of particle layers at a free surface that tension involves.
const LAYERS: f64 = 1.0;
/// Times [s] of: the beginning of an advance, alone and for each particle at the wall with heat; a
/// reading, for each particle or image at the wall.
const ADVANCE: f64 = 1.0e-6;
const ADVANCE_ABOVE_HEAT: f64 = 4.0e-6;
const READING: f64 = 2.5e-6;
/// Time of a time step for each particle at the wall of a fluid that freezes [s], between that of small drops of tin, 1 µs,
/// and of a film of water that is as thin as its particles, 4 µs.
const STEP_OF_FREEZING: f64 = 1.5e-6;
/// Exponent of growth with the number of neighbours, the usual support radius over Δx, and the
/// factor of double precision.
const BY_NEIGHBOURS: f64 = 0.7;
const USUAL_SUPPORT: f64 = 3.0;
const DOUBLE: f64 = 2.7;
/// Cost of tension in a plane model relative to that of a drop.
const PLANE_TENSION: f64 = 0.25;
/// Cost of tension of rings relative to that of particles.
const RING_TENSION: f64 = 0.6;
/// Speed of the fluid ejected below a drop over that of the drop; it limits time steps by the speed
/// of sound.
const PRESSED_OUT: f64 = 3.0;
const PRESSED_OUT_IN_PLANE: f64 = 5.0;
/// Rate over ν/D² at which viscosity takes a drop's speed on a wall. It matters where sound does not limit steps.
const RESISTANCE: f64 = 10.0;
/// Number of instants at which a run is sampled.
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

/// A drop at one time.
struct Drop {
    particles: f64,
    /// Speed of its fastest particles [m/s].
    fastest: f64,
    /// Fraction of its particles at the wall, and near its free surface.
    at_wall: f64,
    near_surface: f64,
}

/// Steps and computing time per second of the run.
fn rates_at(plan: &DropletPlan, method: &Method, run: RunSettings, time: f64) -> Effort {
    let released = plan.drops().filter(|release| release.time <= time);
    let drops: Vec<Drop> =
        released.map(|release| drop_at((plan, method), &release, run.spread, time)).collect();
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
    let of_viscosity = STEP * pairs.max(0.1) * (method.step_cost() - 1.0);
    let freezes = if method.phases.is_some() { walled } else { 0.0 };
    let of_freezing = STEP_OF_FREEZING * freezes * at_wall;
    let of_advance = steps
        * (of_steps + of_viscosity + of_freezing + TENSION_STEP * tension_factor)
        + ADVANCE
        + ADVANCE_ABOVE_HEAT * heated * at_wall
        + tension_factor
            * (listing + impulses * (TENSION_IMPULSE + TENSION_NEAR_SURFACE * near_surface));
    let of_reading = READING * copies(plan.mirrors) * walled * at_wall;
    let seconds = particles * (of_advance / run.exchange + of_reading / run.reading);
    Effort { steps: steps / run.exchange, seconds }
}

/// State of a drop that spreads as `√(3 U t/D)` at first, up to the expected diameter.
fn drop_at(
    (plan, method): (&DropletPlan, &Method),
    release: &Release,
    spread: Option<f64>,
    time: f64,
) -> Drop {
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
    let left = if method.solves_pressure && speed > 0.0 {
        let kinematic = method.viscosity * method.units.length * method.units.speed;
        (-RESISTANCE * kinematic * down.max(0.0) / (speed * diameter * diameter)).exp()
    } else {
        1.0
    };
    let area = (3.0 * down.max(0.0) / diameter).min(spread * spread);
    let pressed = match (down > 0.0, plan.dimension) {
        (false, _) => 1.0,
        (true, 2) => PRESSED_OUT_IN_PLANE,
        (true, _) => PRESSED_OUT,
    };
    // Free surface of a film on its disc over that of the ball.
    let surface = (0.5 * area).max(1.0);
    let (on_wall, layer) = match plan.axes() {
        2 => (4.0 / PI * area.sqrt() / across, 4.0 * LAYERS / across),
        _ => (1.5 * area / across, 6.0 * LAYERS / across),
    };
    Drop {
        particles: plan.particles_of(release.diameter),
        fastest: pressed * speed * left,
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

/// Number of grid points of the free surface per particle, relative to the usual support.
fn tension(plan: &DropletPlan) -> f64 {
    match plan.dimension {
        _ if plan.axisymmetric => RING_TENSION,
        2 => PLANE_TENSION,
        _ => (USUAL_SUPPORT / plan.support).powi(3),
    }
}

//! What drops that are replayed will cost.

use super::knowledge::{SAMPLES, plans};
use super::notes;
use crate::body::droplet::forecast::{DropletForecast, PARTICLE_MEMORY, exchange_time};
use crate::body::solid::plan;
use crate::body::{link, threads_for};
use crate::method::sph::{DropletSph, Effort, RunSettings};
use crate::scene::{Droplet, Scene};

/// Time that a drop takes in an exchange while it gives something [s], as measured with 20 rings.
const GIVE: f64 = 1.5e-4;

/// Estimates without recording anything; that every drop gives something in twenty exchanges.
pub fn forecast(scene: &Scene, name: &str, droplet: &Droplet) -> DropletForecast {
    let plans = plans(scene, (name, droplet));
    let threads = threads_for(scene.solver.threads, true) as f64;
    let (mut particles, mut time_step, mut steps, mut recording) = (0, 0.0, 0.0, 0.0);
    for (plan, duration) in &plans {
        let (count, step) = DropletSph::forecast(plan);
        let between = duration / SAMPLES as f64;
        let spread = Some(droplet.spread_diameter() / droplet.diameter);
        let run = RunSettings { stop: *duration, reading: between, exchange: between, spread };
        let effort = Effort::of(plan, run);
        (particles, time_step) = (particles.max(count), step);
        steps += effort.steps;
        recording += effort.seconds / threads;
    }
    let exchanges = |length: f64| (scene.stop_time / length).ceil();
    let of_solid = scene.coupling_from(name).and_then(|index| {
        let coupling = &scene.coupling[index];
        let solid = coupling.solid()?;
        let plan = plan(scene, solid, scene.solid(solid)?);
        let parts = link::parts(coupling.interval.unwrap_or(f64::INFINITY), scene.step);
        let length = scene.step / parts as f64;
        Some(exchanges(length) * exchange_time(&plan, length))
    });
    let giving = (droplet.recorded_time(droplet.impact_velocity) / scene.step).clamp(1.0, 20.0);
    let replaying = GIVE * giving * droplet.drops() as f64;
    let mut notes = notes(scene, (name, droplet));
    notes.extend((!plans.is_empty()).then(|| {
        format!("to record takes about {recording:.1} s, all that follows about {replaying:.1} s")
    }));
    DropletForecast {
        name: name.into(),
        particles,
        time_step,
        steps,
        memory: PARTICLE_MEMORY * particles as f64,
        run_time: recording + replaying + of_solid.unwrap_or(0.0),
        notes,
    }
}

//! What drops that are replayed will cost.

use super::knowledge::{SAMPLES, is_known, plans};
use super::notes;
use crate::body::droplet::forecast::{DropletForecast, PARTICLE_MEMORY, exchange_time};
use crate::body::solid::plan;
use crate::body::{link, threads_for};
use crate::method::sph::{DropletSph, Effort, RunSettings};
use crate::scene::{Droplet, Scene};

/// Time that a drop takes in an exchange while it gives something [s], as measured with 20 rings.
const GIVE: f64 = 1.5e-4;

/// What is computed before drops of a scene can be repeated, as far as this process does not know it: a sentence each.
pub fn to_be_recorded(scene: &Scene) -> Vec<String> {
    let recorded = scene.droplets().filter(|(_, droplet)| droplet.is_replayed());
    let unknown = recorded
        .filter(|&(name, droplet)| droplet.has_particles() && !is_known(scene, (name, droplet)));
    let sentence = |(name, droplet)| {
        let Recording { particles, seconds, .. } = Recording::of(scene, (name, droplet));
        format!(
            "{name}: one impact of {particles} particles is computed first, in about {seconds:.1} s"
        )
    };
    unknown.map(sentence).collect()
}

/// What recording takes.
#[derive(Default)]
struct Recording {
    particles: usize,
    time_step: f64,
    steps: f64,
    seconds: f64,
}

impl Recording {
    fn of(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Self {
        let threads = threads_for(scene.solver.threads, true) as f64;
        let spread = Some(droplet.spread_diameter() / droplet.diameter);
        let mut all = Self::default();
        for (plan, duration) in plans(scene, (name, droplet)) {
            let (count, step) = DropletSph::forecast(&plan);
            let between = duration / SAMPLES as f64;
            let run = RunSettings { stop: duration, reading: between, exchange: between, spread };
            let effort = Effort::of(&plan, run);
            all.particles = all.particles.max(count);
            all.time_step = step;
            all.steps += effort.steps;
            all.seconds += effort.seconds / threads;
        }
        all
    }
}

/// Estimates without recording anything; that every drop gives something in twenty exchanges.
pub fn forecast(scene: &Scene, name: &str, droplet: &Droplet) -> DropletForecast {
    let recording = Recording::of(scene, (name, droplet));
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
    let Recording { particles, time_step, steps, seconds } = recording;
    notes.extend((particles > 0).then(|| {
        format!("to record takes about {seconds:.1} s, all that follows about {replaying:.1} s")
    }));
    DropletForecast {
        name: name.into(),
        particles,
        time_step,
        steps,
        memory: PARTICLE_MEMORY * particles as f64,
        run_time: seconds + replaying + of_solid.unwrap_or(0.0),
        notes,
    }
}

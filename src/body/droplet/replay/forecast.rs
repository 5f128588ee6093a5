//! Cost of replayed drops.

use super::knowledge::{SAMPLES, is_known, plans};
use super::notes;
use crate::body::droplet::forecast::{DropletForecast, PARTICLE_MEMORY, exchange_time};
use crate::body::solid::plan;
use crate::body::{link, threads_for};
use crate::closed_form::cooling_film::fourier_number;
use crate::method::record::{NEAR, turns_of_film};
use crate::method::sph::{DropletSph, Effort, RunSettings};
use crate::scene::{Droplet, Scene};

/// Time per drop in an exchange while it transfers heat [s], measured with 20 rings.
const GIVE: f64 = 1.5e-4;

/// Returns a sentence for each recording that must be computed because this process does not hold it yet.
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

/// Cost of a recording.
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

/// Estimates the cost without recording. The number of drops on demand is unknown, so a note states the cost of each
/// drop.
pub fn forecast(scene: &Scene, name: &str, droplet: &Droplet) -> DropletForecast {
    let recording = Recording::of(scene, (name, droplet));
    let in_time = || droplet.arrivals().iter().filter(|arrival| arrival.time < scene.stop_time);
    let drops = if droplet.is_on_demand() { 0 } else { in_time().count() };
    let replaying = Replaying::of(scene, (name, droplet), drops).seconds();
    let mut notes = notes(scene, (name, droplet));
    let Recording { particles, time_step, steps, seconds } = recording;
    notes.extend((particles > 0).then(|| {
        format!("to record takes about {seconds:.1} s, all that follows about {replaying:.1} s")
    }));
    notes.extend(droplet.is_on_demand().then(|| {
        let of_one = Replaying::of(scene, (name, droplet), 1).seconds() - replaying;
        format!("each drop that is released takes about {of_one:.2e} s more")
    }));
    DropletForecast {
        name: name.into(),
        particles,
        drawn: 0,
        time_step,
        steps,
        memory: PARTICLE_MEMORY * particles as f64,
        run_time: seconds + replaying,
        notes,
    }
}

/// Cost of replaying drops.
struct Replaying {
    drops: f64,
    of_solid: f64,
}

impl Replaying {
    fn of(scene: &Scene, (name, droplet): (&str, &Droplet), drops: usize) -> Self {
        let cooling = Cooling::of(droplet);
        let interval = scene.coupling_from(name).and_then(|index| scene.coupling[index].interval);
        let exchanges = match interval {
            Some(interval) => {
                let parts = link::parts(interval, scene.step);
                (scene.stop_time / scene.step).ceil() * parts as f64
            }
            None => cooling.exchanges(scene, drops),
        };
        let length = scene.stop_time / exchanges;
        let of_solid = scene.coupling_from(name).and_then(|index| {
            let solid = scene.coupling[index].solid()?;
            let plan = plan(scene, solid, scene.solid(solid)?);
            Some(exchanges * exchange_time(&plan, length, droplet.initial_temperature))
        });
        let giving = (cooling.duration() / length).clamp(1.0, exchanges);
        Self { drops: GIVE * giving * drops as f64, of_solid: of_solid.unwrap_or(0.0) }
    }

    fn seconds(&self) -> f64 {
        self.drops + self.of_solid
    }
}

/// Expected cooling of a drop's film.
struct Cooling {
    /// Recorded time of the drop [s].
    recorded: f64,
    /// Time until half of its heat has been transferred [s].
    half: f64,
}

impl Cooling {
    /// Cooling of a film as thick as the drop's volume over its largest footprint, with constant temperature at its
    /// lower face.
    fn of(droplet: &Droplet) -> Self {
        let fluid = &droplet.fluid;
        let recorded = droplet.recorded_time(droplet.speed_at_contact());
        let thickness = droplet.diameter.powi(3) / (1.5 * droplet.spread_diameter().powi(2));
        let diffusivity = fluid.conductivity / (fluid.density * fluid.specific_heat);
        let half = fourier_number(0.5) * thickness.powi(2) / diffusivity;
        Self { recorded, half }
    }

    /// Time until hardly any heat remains [s].
    fn duration(&self) -> f64 {
        self.recorded + fourier_number(0.999) / fourier_number(0.5) * self.half
    }

    /// Number of parts of steps at which the wall is evaluated: when drops touch down, and while they cool near the
    /// ends of a step.
    fn exchanges(&self, scene: &Scene, drops: usize) -> f64 {
        let ages = turns_of_film(self.recorded, self.half).into_iter();
        let cuts = |age: &f64| *age < scene.stop_time && 2.0 * NEAR * age < scene.step;
        let cuts = 1.0 + ages.filter(cuts).count() as f64;
        let steps = (scene.stop_time / scene.step).ceil();
        steps * (1.0 + cuts * drops as f64 / steps).min(link::MOST_PARTS as f64)
    }
}

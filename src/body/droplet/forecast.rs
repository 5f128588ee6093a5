//! Cost of droplets.

use super::{is_large, notes, plan_of, replay};
use crate::advice::may_be_solved;
use crate::body::solid::{PRODUCT_RATE, exchanged_heat_time, plan};
use crate::body::{link, threads_for};
use crate::limits::two_digits;
use crate::math::chebyshev::products;
use crate::method::fem::{Plan, particle_cost};
use crate::method::sph::{DropletSph, Effort, RunSettings};
use crate::scene::{Droplet, PressureAdvance, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct DropletForecast {
    pub name: String,
    /// Number of particles once all drops are released, without mirror images.
    pub particles: usize,
    /// The same with mirror images, in files; 0 where nothing moves.
    pub drawn: usize,
    /// Time step at rest [s].
    pub time_step: f64,
    /// Time steps of the default experiment.
    pub steps: f64,
    /// Memory [B].
    pub memory: f64,
    /// Time to run the default experiment, including the exchanges of a solid below [s].
    pub run_time: f64,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Memory of a particle and its neighbours [B].
pub const PARTICLE_MEMORY: f64 = 1.5e3;
/// Time per node of the solid in an exchange, in addition to its own step [s]. It was measured on boxes of 10 000 to
/// 110 000 nodes, as the difference from the same droplet above a wall.
const EXCHANGE: f64 = 2.2e-7;
/// Gain by solved pressure that is worth a note, and a time of a run that nobody minds [s].
const WORTH: f64 = 2.0;
const SHORT: f64 = 2.0;

impl DropletForecast {
    /// Estimates the cost without building the droplet.
    pub fn of(scene: &Scene, name: &str, droplet: &Droplet) -> Self {
        if droplet.is_replayed() {
            return replay::forecast(scene, name, droplet);
        }
        let mut sph = plan_of(droplet, None, None);
        sph.fluid.freezing = scene.freezing_of(name);
        let (particles, time_step) = DropletSph::forecast(&sph);
        let threads = threads_for(scene.solver.threads, is_large(particles)) as f64;
        let contact = scene.coupling_from(name).and_then(|index| {
            let coupling = &scene.coupling[index];
            let solid = coupling.solid()?;
            let plan = plan(scene, solid, scene.solid(solid)?);
            Some((link::interval(coupling, droplet, &plan), plan))
        });
        let mut notes = notes(scene, name, droplet);
        notes.extend(contact.as_ref().map(|&(interval, _)| link::note(interval)));
        let parts = contact.as_ref().map_or(1, |&(interval, _)| link::parts(interval, scene.step));
        let exchange = scene.step / parts as f64;
        let has_wall = contact.is_some() || scene.wall_under(name).is_some();
        let effort = Effort::of(
            &sph,
            RunSettings {
                stop: scene.stop_time,
                reading: scene.step,
                exchange,
                spread: has_wall.then(|| droplet.spread_diameter() / droplet.diameter),
            },
        );
        let exchanges = (scene.stop_time / exchange).ceil();
        let of_solid = contact.map_or(0.0, |(_, plan)| {
            exchanges * exchange_time(&plan, exchange, droplet.initial_temperature)
        });
        let run_time = effort.seconds / threads + of_solid;
        notes.extend(note_on_solved_pressure(scene, name, droplet, run_time));
        Self {
            name: name.into(),
            particles,
            drawn: particles
                * droplet
                    .mirrors()
                    .map(|mirrored| if mirrored { 2 } else { 1 })
                    .iter()
                    .product::<usize>(),
            time_step,
            steps: effort.steps,
            memory: PARTICLE_MEMORY * particles as f64,
            run_time,
            notes,
        }
    }
}

/// Notes that a run of this time would be much shorter if pressure were solved at the end of steps.
fn note_on_solved_pressure(
    scene: &Scene,
    name: &str,
    droplet: &Droplet,
    run_time: f64,
) -> Option<String> {
    let is_solved = droplet.pressure == PressureAdvance::Implicit;
    if run_time <= SHORT || is_solved || !may_be_solved(droplet) {
        return None;
    }
    let solved = Droplet { pressure: PressureAdvance::Implicit, ..droplet.clone() };
    let solved = DropletForecast::of(scene, name, &solved).run_time;
    (run_time > WORTH * solved).then(|| {
        let [times, from, to] = [run_time / solved, run_time, solved].map(two_digits);
        format!(
            "`pressure = \"implicit\"` would shorten this run some {times} times, from {from} to {to} s: sound limits the \
             time steps of a fluid this thick"
        )
    })
}

/// Time of a solid for an exchange of some length [s] with a fluid of a temperature [K].
pub fn exchange_time(plan: &Plan, length: f64, temperature: f64) -> f64 {
    let nodes = plan.mesh.nodes() as f64;
    let of_particles = particle_cost(plan).map_or(0.0, |cost| {
        let (sub_steps, products) = products(cost.bound, length);
        // The solid advances twice over the exchange: without the droplet's heat, and with it.
        2.0 * (sub_steps * products * cost.neighbours) as f64 * nodes / PRODUCT_RATE
    });
    EXCHANGE * nodes + of_particles + exchanged_heat_time(plan, length, temperature)
}

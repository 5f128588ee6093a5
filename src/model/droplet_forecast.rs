//! What droplets will cost.

use super::contact::Contact;
use super::{PARTICLES_WORTH_THREADS, droplets, plan, resolve_threads};
use crate::body::sph::DropletSph;
use crate::scene::{Droplet, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct DropletForecast {
    pub name: String,
    /// Number of particles once all drops are released, images at mirrors left out.
    pub particles: usize,
    /// At rest [s].
    pub time_step: f64,
    /// Time steps of the default experiment.
    pub steps: f64,
    /// Memory [B].
    pub memory: f64,
    /// Time to run the default experiment [s].
    pub run_time: f64,
    /// What was chosen or left out, and why.
    pub notes: Vec<String>,
}

/// Memory of a particle with its neighbours [B], and particles that a thread advances by a time step a
/// second: measured while a drop spreads on a wall, on a processor of 2024 with AVX-512.
const PARTICLE_MEMORY: f64 = 1.5e3;
const PARTICLE_RATE: f64 = 1.4e6;

impl DropletForecast {
    /// Estimates without building the droplet.
    pub(super) fn of(scene: &Scene, name: &str, droplet: &Droplet) -> Self {
        let (particles, time_step) = DropletSph::forecast(&droplets::plan_of(droplet, None, None));
        let threads =
            resolve_threads(scene.solver.threads, particles >= PARTICLES_WORTH_THREADS) as f64;
        let contact = scene.coupling_from(name).and_then(|index| {
            let coupling = &scene.coupling[index];
            let solid = coupling.solid()?;
            let plan = plan(scene, solid, scene.solid(solid)?);
            Some(Contact::of(coupling, droplet, (0, &plan), Default::default(), time_step))
        });
        let mut notes = droplets::notes(droplet);
        notes.extend(contact.as_ref().map(Contact::note));
        let steps = scene.stop_time / time_step;
        Self {
            name: name.into(),
            particles,
            time_step,
            steps,
            memory: PARTICLE_MEMORY * particles as f64,
            run_time: steps * particles as f64 / (PARTICLE_RATE * threads),
            notes,
        }
    }
}

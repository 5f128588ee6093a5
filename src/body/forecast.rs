//! Cost of a scene.

pub use super::droplet::DropletForecast;
use super::exchanges::ExchangeForecast;
use super::filament::FilamentForecast;
use super::large_strain::LargeStrainForecast;
use super::lattice::LatticeForecast;
use super::reduced;
use super::solid::forecast_solid;
pub use super::solid::{BodyForecast, ParticleForecast};
use crate::scene::Scene;

/// Cost of a scene, estimated before it is built.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// Costs of the solids.
    pub bodies: Vec<BodyForecast>,
    pub droplets: Vec<DropletForecast>,
    pub large_strains: Vec<LargeStrainForecast>,
    pub filaments: Vec<FilamentForecast>,
    pub lattices: Vec<LatticeForecast>,
    /// Number of communication steps of the default experiment.
    pub steps: f64,
    /// Exchanges between solids in contact.
    pub exchanges: ExchangeForecast,
}

impl Forecast {
    /// Time to build the model and run the default experiment, with all stresses read in every step [s].
    pub fn run_time(&self) -> f64 {
        let of_solid = |body: &BodyForecast| body.build_time + (self.steps + 1.0) * body.step_time;
        let of_bodies = self.bodies.iter().map(of_solid);
        let of_large_strains = self.large_strains.iter().map(|body| body.run_time);
        let all = of_bodies.chain(self.droplets.iter().map(|body| body.run_time));
        let of_filaments = self.filaments.iter().map(|body| body.run_time);
        let of_lattices = self.lattices.iter().map(|body| body.run_time);
        let all = all.chain(of_large_strains).chain(of_filaments).chain(of_lattices);
        // From zero: a sum of nothing is negative zero.
        all.fold(0.0, |sum, time| sum + time) + self.exchanges.time
    }
}

/// Memory and output that a body needs.
pub struct Need<'a> {
    pub name: &'a str,
    /// [B]
    pub memory: f64,
    /// Its size in words, and what makes it smaller.
    pub size: String,
    pub remedy: &'static str,
    /// Places in a file of the body; `None` of a solid with a mesh, whose files have cells.
    pub particles: Option<usize>,
}

impl Forecast {
    /// The needs of all bodies.
    pub fn needs(&self) -> Vec<Need<'_>> {
        let solids = self.bodies.iter().map(|body| {
            let unknowns: f64 = body.unknowns.iter().map(|&count| count as f64).sum();
            Need {
                name: &body.name,
                memory: body.memory,
                size: format!("{unknowns:.2e} unknowns"),
                remedy: "a larger `mesh.spacing`",
                particles: None,
            }
        });
        let droplets = self.droplets.iter().map(|droplet| Need {
            name: &droplet.name,
            memory: droplet.memory,
            size: format!("{:.2e} particles", droplet.particles as f64),
            remedy: "a larger `spacing`",
            particles: Some(droplet.drawn),
        });
        let large_strains = self.large_strains.iter().map(|body| Need {
            name: &body.name,
            memory: body.memory,
            size: format!("{:.2e} nodes", body.nodes as f64),
            remedy: "a larger `mesh.spacing`",
            particles: Some(body.drawn),
        });
        let filaments = self.filaments.iter().map(|body| Need {
            name: &body.name,
            memory: body.memory,
            size: format!("{:.2e} {}", body.count as f64, body.of),
            remedy: "a smaller `most` or a larger `spacing`",
            particles: Some(body.count),
        });
        let lattices = self.lattices.iter().map(|body| Need {
            name: &body.name,
            memory: body.memory,
            size: format!("{} particles", body.particles),
            remedy: "a larger `spacing`",
            particles: Some(body.particles),
        });
        solids.chain(droplets).chain(large_strains).chain(filaments).chain(lattices).collect()
    }
}

/// Estimates the cost of a scene without building it.
pub fn forecast(scene: &Scene) -> Forecast {
    let solids = scene.solids().map(|(name, solid)| {
        let full = forecast_solid(scene, name, solid);
        if scene.is_reduced(name) { reduced::forecast(scene, name, full) } else { full }
    });
    let droplets = droplet_forecasts(scene);
    let steps = (scene.stop_time / scene.step).ceil();
    let bodies: Vec<BodyForecast> = solids.collect();
    let exchanges = ExchangeForecast::of(scene, &bodies);
    let large_strains = scene.large_strains();
    let large_strains =
        large_strains.map(|(name, solid)| LargeStrainForecast::of(scene, name, solid)).collect();
    let filaments = scene.filaments().map(|(name, own)| FilamentForecast::of(scene, name, own));
    let lattices = scene.lattices().map(|(name, own)| LatticeForecast::of(scene, name, own));
    Forecast {
        bodies,
        droplets: droplets.collect(),
        large_strains,
        filaments: filaments.collect(),
        lattices: lattices.collect(),
        steps,
        exchanges,
    }
}

/// Estimates the cost of the scene's droplets alone.
fn droplet_forecasts(scene: &Scene) -> impl Iterator<Item = DropletForecast> {
    scene.droplets().map(|(name, droplet)| DropletForecast::of(scene, name, droplet))
}

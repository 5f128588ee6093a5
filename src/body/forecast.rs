//! What a scene will cost.

pub use super::droplet::DropletForecast;
use super::solid::forecast_solid;
pub use super::solid::{BodyForecast, ParticleForecast};
use crate::scene::Scene;

/// What a scene will cost, estimated before it is built.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// Of the solids.
    pub bodies: Vec<BodyForecast>,
    pub droplets: Vec<DropletForecast>,
    /// Communication steps of the default experiment.
    pub steps: f64,
}

impl Forecast {
    /// Time to build the model and to run the default experiment, all stresses read in every step [s].
    pub fn run_time(&self) -> f64 {
        let of_solid = |body: &BodyForecast| body.build_time + (self.steps + 1.0) * body.step_time;
        let solids = self.bodies.iter().map(of_solid).sum::<f64>();
        solids + self.droplets.iter().map(|body| body.run_time).sum::<f64>()
    }
}

/// What a scene will cost, without building it.
pub fn forecast(scene: &Scene) -> Forecast {
    let solids = scene.solids().map(|(name, solid)| forecast_solid(scene, name, solid));
    let droplets = droplet_forecasts(scene);
    let steps = (scene.stop_time / scene.step).ceil();
    Forecast { bodies: solids.collect(), droplets: droplets.collect(), steps }
}

/// The same of its droplets alone.
fn droplet_forecasts(scene: &Scene) -> impl Iterator<Item = DropletForecast> {
    scene.droplets().map(|(name, droplet)| DropletForecast::of(scene, name, droplet))
}

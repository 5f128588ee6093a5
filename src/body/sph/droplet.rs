//! The droplet as a body.

use super::failure::Failure;
use super::plan::DropletPlan;
use super::wall::WallExchange;

/// Droplets above a wall: everything known before time starts. What changes is a flat vector, whose
/// length grows when a droplet is released.
pub struct DropletSph {
    plan: DropletPlan,
    threads: usize,
}

/// Sums over the fluid, images at mirrors included (a plane model: per metre of depth).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DropletTotals {
    /// [kg]
    pub mass: f64,
    /// [kg m/s]
    pub momentum: [f64; 3],
    /// [J]
    pub kinetic_energy: f64,
    /// Elastic energy of the weak compression [J].
    pub compression_energy: f64,
    /// Energy of the free surface [J], from the pair forces.
    pub surface_energy: f64,
    /// Heat content above the initial temperature of each droplet [J], negative when cooled.
    pub heat: f64,
    /// Given to the wall since time zero [J] and [N s].
    pub heat_to_wall: f64,
    pub impulse_to_wall: [f64; 3],
    /// Heat that the corrected operator made, for which no pair accounts [J].
    pub heat_drift: f64,
    /// Diameter of the circle round all fluid that is near the wall [m].
    pub spread_diameter: f64,
    /// Height of the highest particle above the wall [m].
    pub height: f64,
    pub max_speed: f64,
    pub max_pressure: f64,
    /// Lowest and highest density over the density at rest.
    pub density_range: [f64; 2],
    /// Time steps made since time zero.
    pub steps: f64,
}

/// The particles of a state, images at mirrors left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParticleFields {
    /// [m]
    pub position: Vec<[f64; 3]>,
    /// [m/s]
    pub velocity: Vec<[f64; 3]>,
    /// [kg]
    pub mass: Vec<f64>,
    /// [kg/m³]
    pub density: Vec<f64>,
    /// [Pa]
    pub pressure: Vec<f64>,
    /// [K]
    pub temperature: Vec<f64>,
}

impl DropletSph {
    pub fn new(plan: DropletPlan, threads: usize) -> Self {
        Self { plan, threads }
    }

    pub fn plan(&self) -> &DropletPlan {
        &self.plan
    }

    pub fn initial_state(&self) -> Vec<f64> {
        vec![self.threads as f64]
    }

    /// Whether a vector may be a state of this model.
    pub fn accepts(&self, state: &[f64]) -> bool {
        state.len() == 1
    }

    /// Advances by `duration` [s] with as many time steps as stability asks, under a temperature of
    /// each wall cell [K], held. A failure leaves the state as it was.
    pub fn advance(
        &self,
        _state: &mut Vec<f64>,
        _wall_temperature: &[f64],
        _duration: f64,
    ) -> Result<(), Failure> {
        Ok(())
    }

    /// What the wall got during the last step; nothing before the first.
    pub fn exchange(&self, _state: &[f64]) -> WallExchange {
        let cells = self.plan.wall.as_ref().map_or(0, |wall| wall.cells.len());
        WallExchange::none(cells)
    }

    pub fn totals(&self, _state: &[f64]) -> DropletTotals {
        DropletTotals::default()
    }

    pub fn particles(&self, _state: &[f64]) -> ParticleFields {
        ParticleFields::default()
    }

    /// Number of particles that the whole plan will have, and the time step at rest [s].
    pub fn forecast(_plan: &DropletPlan) -> (usize, f64) {
        (0, 0.0)
    }
}

//! Sums over the fluid of a state.

use super::frozen::solid_fractions;
use crate::method::sph::cloud::{Cloud, Ledger};
use crate::method::sph::images::copies;
use crate::method::sph::lumps::body_of_fluid;
use crate::method::sph::method::Method;
use crate::method::sph::plan::DropletPlan;
use crate::method::sph::spread::{Film, spread_diameter};
use crate::method::sph::units::{compression_energy, pressure};
use crate::method::sph::viscous::AT_YIELD;

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
    /// Energy of free and wetted surface, against a dry wall [J].
    pub surface_energy: f64,
    /// Heat content above the temperature of the first droplet, now and when released [J].
    pub heat: f64,
    pub heat_released: f64,
    /// Heat [J] and impulse [N s] transferred to the wall since time zero.
    pub heat_to_wall: f64,
    /// Heat given to the air since time zero [J].
    pub heat_to_air: f64,
    pub impulse_to_wall: [f64; 3],
    /// Impulse of gravity since time zero [N s].
    pub impulse_of_gravity: [f64; 3],
    /// Diameter of the film that the body of fluid forms on the wall, see `spread::spread_diameter` [m].
    pub spread_diameter: f64,
    /// Height of the highest particle of the body of fluid above the wall [m].
    pub height: f64,
    /// Mass [kg] and number of particles (images excluded) detached from the body of fluid, in
    /// lumps of less than a tenth of a drop's mass.
    pub stray_mass: f64,
    pub stray_particles: f64,
    pub max_speed: f64,
    pub max_pressure: f64,
    /// Lowest and highest density over the density at rest.
    pub density_range: [f64; 2],
    /// Lowest and highest temperature [K].
    pub temperature_range: [f64; 2],
    /// Mean temperature by mass [K].
    pub mean_temperature: f64,
    /// Mass of fluid that yields [kg], and the largest shear rate of the rest in the last time step [1/s]; zero for
    /// fluids without a yield stress.
    pub yielded_mass: f64,
    pub creep: f64,
    /// Iterations of pressure and viscosity so far; 0 where pressure is not solved.
    pub iterations: f64,
    /// Frozen fraction of the mass, mass of frozen fluid [kg], latent heat that it has given off [J], and time since
    /// which all fluid on the wall is frozen [s], 0 while some is not; zero for fluids that stay liquid.
    pub solid_fraction: f64,
    pub frozen_mass: f64,
    pub latent_heat: f64,
    pub arrest_time: f64,
    /// Number of time steps since time zero, and of particles, images excluded.
    pub steps: f64,
    pub particles: f64,
    /// Number of drops released so far, and of requested drops that wait.
    pub released: f64,
    pub waiting: f64,
}

impl DropletTotals {
    /// Fraction of the mass that yields; 0 before the first drop.
    pub fn yielded_fraction(&self) -> f64 {
        if self.mass > 0.0 { self.yielded_mass / self.mass } else { 0.0 }
    }
}

/// Computes the sums over the fluid, with the shape of drops.
pub fn totals(
    plan: &DropletPlan,
    method: &Method,
    ledger: &Ledger,
    cloud: &Cloud,
) -> DropletTotals {
    let mut totals = sums(plan, method, ledger, cloud);
    let (units, images) = (&method.units, copies(plan.mirrors));
    let body = body(plan, ledger, cloud);
    for (i, &in_body) in body.iter().enumerate() {
        if in_body {
            totals.height = totals.height.max(cloud.position[i][2] * units.length);
        } else {
            totals.stray_mass += images * cloud.mass[i] * units.mass();
            totals.stray_particles += 1.0;
        }
    }
    // Without a wall there is nothing to spread on, even if particles fall low.
    if plan.wall.is_some() {
        let places = wetting_places(plan, cloud, &body);
        totals.spread_diameter = plan.spacing * spread_diameter(&places, Film::of(plan));
    }
    totals
}

/// Computes the sums over the fluid but for those of its shape.
pub fn sums(plan: &DropletPlan, method: &Method, ledger: &Ledger, cloud: &Cloud) -> DropletTotals {
    let units = &method.units;
    let images = copies(plan.mirrors);
    let heat_unit = units.energy() / method.heat_unit;
    let mut totals = DropletTotals {
        surface_energy: ledger.surface_energy,
        heat_to_wall: ledger.heat_to_wall,
        heat_to_air: ledger.heat_to_air.unwrap_or(0.0),
        impulse_to_wall: ledger.impulse_to_wall,
        impulse_of_gravity: ledger.impulse_of_gravity,
        heat_released: ledger.heat_released,
        steps: ledger.steps,
        iterations: ledger.iterations.unwrap_or(0.0),
        particles: cloud.len() as f64,
        released: ledger.released,
        waiting: (ledger.requests.as_ref())
            .map_or(0.0, |requests| requests.waiting(ledger.released) as f64),
        density_range: [f64::INFINITY, f64::NEG_INFINITY],
        temperature_range: [f64::INFINITY, f64::NEG_INFINITY],
        max_pressure: f64::NEG_INFINITY,
        ..DropletTotals::default()
    };
    if method.flow.yield_stress() > 0.0 {
        totals.creep = ledger.creep.unwrap_or(0.0) / units.time();
        totals.yielded_mass = images * units.mass() * yielded_mass(method, cloud);
    }
    if let Some(freezing) = plan.fluid.freezing.filter(|_| cloud.content.is_some()) {
        if !cloud.mass.is_empty() {
            totals.solid_fraction = mean_by_mass(cloud, &solid_fractions(method, cloud));
        }
        let mass: f64 = cloud.mass.iter().sum();
        totals.frozen_mass = totals.solid_fraction * images * units.mass() * mass;
        totals.latent_heat = totals.frozen_mass * freezing.melting.latent_heat;
        totals.arrest_time = ledger.arrest.unwrap_or(0.0);
    }
    let reference = plan.reference_temperature();
    for i in 0..cloud.len() {
        let mass = images * cloud.mass[i];
        let speed = cloud.velocity[i].iter().map(|v| v * v).sum::<f64>();
        totals.mass += mass * units.mass();
        for a in 0..3 {
            let share = if a < 2 && plan.even()[a] { 0.0 } else { mass };
            totals.momentum[a] += share * cloud.velocity[i][a] * units.mass() * units.speed;
        }
        totals.kinetic_energy += 0.5 * mass * speed * units.energy();
        totals.compression_energy += mass * compression_energy(cloud.density[i]) * units.energy();
        totals.heat += mass * heat_unit * cloud.contents()[i];
        totals.max_speed = totals.max_speed.max(speed.sqrt() * units.speed);
        totals.max_pressure =
            totals.max_pressure.max(pressure(cloud.density[i]) * units.pressure());
        let [low, high] = totals.density_range;
        let ratio = 1.0 + cloud.density[i];
        totals.density_range = [low.min(ratio), high.max(ratio)];
        let [low, high] = totals.temperature_range;
        let temperature = cloud.temperature[i] + reference;
        totals.temperature_range = [low.min(temperature), high.max(temperature)];
    }
    totals.mean_temperature = reference
        + match cloud.content {
            Some(_) => mean_by_mass(cloud, &cloud.temperature),
            None => totals.heat / (totals.mass * plan.fluid.specific_heat),
        };
    totals
}

fn mean_by_mass(cloud: &Cloud, values: &[f64]) -> f64 {
    let sum: f64 = cloud.mass.iter().zip(values).map(|(mass, value)| mass * value).sum();
    sum / cloud.mass.iter().sum::<f64>()
}

/// Mass over ρ₀H^d of particles at their yield stress.
fn yielded_mass(method: &Method, cloud: &Cloud) -> f64 {
    let limit = AT_YIELD * method.flow.yield_stress();
    let stresses = cloud.stress.iter().flatten();
    let yields = |stress: &[f64; 6]| stress.iter().map(|s| s * s).sum::<f64>() >= limit * limit;
    let yielding = stresses.zip(&cloud.mass).filter(|(stress, _)| yields(stress));
    // A sum of no numbers is −0.
    yielding.fold(0.0, |sum, (_, mass)| sum + mass)
}

/// Returns for each particle whether it belongs to the body of fluid.
fn body(plan: &DropletPlan, ledger: &Ledger, cloud: &Cloud) -> Vec<bool> {
    let places: Vec<_> = cloud.position.iter().map(|x| x.map(|x| x * plan.support)).collect();
    let mass = copies(plan.mirrors) * cloud.mass.iter().sum::<f64>();
    body_of_fluid(&places, &cloud.mass, plan.mirrors, mass / ledger.released.max(1.0))
}

/// Height over Δx below which a particle counts as on the wall: twice that of the first layer,
/// which leaves it room to move.
const AT_WALL: f64 = 1.5;

/// Places over Δx, about their middle, of all particles of the body that touch the wall; images at
/// mirrors included.
fn wetting_places(plan: &DropletPlan, cloud: &Cloud, body: &[bool]) -> Vec<[f64; 2]> {
    let spacing = 1.0 / plan.support;
    let at_wall = |&i: &usize| body[i] && cloud.position[i][2] < AT_WALL * spacing;
    let wetting: Vec<usize> = (0..cloud.len()).filter(at_wall).collect();
    let mass: f64 = wetting.iter().map(|&i| cloud.mass[i]).sum();
    let middle = |a: usize| match plan.even()[a] {
        true => 0.0,
        false => wetting.iter().map(|&i| cloud.mass[i] * cloud.position[i][a]).sum::<f64>() / mass,
    };
    let middle = [middle(0), middle(1)];
    let sides = |a: usize| if plan.mirrors[a] { &[1.0, -1.0][..] } else { &[1.0] };
    let images = |i: usize| {
        let [x, y] = [0, 1].map(|a| (cloud.position[i][a] - middle[a]) / spacing);
        sides(0).iter().flat_map(move |p| sides(1).iter().map(move |q| [p * x, q * y]))
    };
    wetting.into_iter().flat_map(images).collect()
}

//! The droplet as a body.

use std::f64::consts::PI;
use std::sync::OnceLock;

use super::acceptance::{self, Released};
use super::cloud::{
    Cloud, Ledger, WallNumbers, cloud_of, flatten, layout, ledger_of, particles_in,
};
use super::effort::particles_of;
use super::failure::Failure;
use super::images::copies;
use super::loops::PART;
use super::lumps::body_of_fluid;
use super::method::Method;
use super::placement::place;
use super::plan::{DropletPlan, Release};
use super::spread::spread_diameter;
use super::stepper::Stepper;
use super::surface::{Surface, SurfaceResponse};
use super::units::{compression_energy, density, pressure};
use super::wall::WallExchange;
use super::wall_points::WallPoints;
use crate::math::allowance::Allowance;
use crate::math::parallel::Team;
use crate::state::{Layout, store};

/// Droplets above a wall: everything known before time starts. What changes is a flat vector, whose
/// length grows when a droplet is released.
pub struct DropletSph {
    plan: DropletPlan,
    method: Method,
    threads: usize,
    /// Of a solid below whose temperature somebody else computes; nothing where that is held.
    below: SurfaceResponse,
    /// What there is after each release, found when a state from elsewhere is looked at.
    released: OnceLock<Vec<Released>>,
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
    /// Energy of free and wetted surface, against a dry wall [J].
    pub surface_energy: f64,
    /// Heat content above the temperature of the first droplet, now and when released [J].
    pub heat: f64,
    pub heat_released: f64,
    /// Given to the wall since time zero [J] and [N s].
    pub heat_to_wall: f64,
    pub impulse_to_wall: [f64; 3],
    /// Impulse of gravity since time zero [N s].
    pub impulse_of_gravity: [f64; 3],
    /// Diameter of the film that the body of fluid makes on the wall, see [`spread_diameter`] [m].
    pub spread_diameter: f64,
    /// Height of the body of fluid above the wall: of its highest particle [m].
    pub height: f64,
    /// Mass [kg] and number of particles, images left out, that have come off the body of fluid: in lumps
    /// of less than a tenth of a drop's mass.
    pub stray_mass: f64,
    pub stray_particles: f64,
    pub max_speed: f64,
    pub max_pressure: f64,
    /// Lowest and highest density over the density at rest.
    pub density_range: [f64; 2],
    /// Lowest and highest temperature [K].
    pub temperature_range: [f64; 2],
    /// Time steps made since time zero, and particles there are, images left out.
    pub steps: f64,
    pub particles: f64,
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
    /// `threads` = 0 is taken for 1.
    ///
    /// # Panics
    /// If the plan's planes and periods do not go together, see [`Extent`](super::Extent).
    pub fn new(plan: DropletPlan, threads: usize) -> Self {
        let method = Method::of(&plan);
        let below = response_below(&plan, &method);
        Self { plan, method, threads, below, released: OnceLock::new() }
    }

    pub fn plan(&self) -> &DropletPlan {
        &self.plan
    }

    /// Time zero: what is released then, nothing else.
    pub fn initial_state(&self) -> Vec<f64> {
        let (mut ledger, mut cloud) = (self.empty_ledger(), Cloud::default());
        // What stands too close to be listed is listed, and refused, again by the first step.
        let _ = self.release(&mut ledger, &mut cloud);
        flat(&mut ledger, &mut cloud)
    }

    /// A state at time zero of given particles, in place of the plan's droplets.
    pub fn state_of(&self, particles: &ParticleFields) -> Vec<f64> {
        let units = &self.method.units;
        let reference = self.reference_temperature();
        let mut cloud = Cloud::default();
        for i in 0..particles.mass.len() {
            let position = particles.position[i].map(|x| x / units.length);
            let velocity = particles.velocity[i].map(|v| v / units.speed);
            let mass = particles.mass[i] / units.mass();
            cloud.push(position, velocity, mass, particles.temperature[i] - reference);
            cloud.density[i] = particles.density[i] / units.density - 1.0;
        }
        let released = self.plan.releases.len() as f64;
        let mut ledger = Ledger { released, ..self.empty_ledger() };
        // As above.
        let _ = self.prime(&mut ledger, &mut cloud);
        flat(&mut ledger, &mut cloud)
    }

    /// Number of particles of a state.
    pub fn particles_in(&self, state: &[f64]) -> usize {
        particles_in(state, self.wall()).unwrap_or(0)
    }

    /// Refuses a vector that no run of these droplets leads to, with what is wrong with it.
    pub fn check_state(&self, state: &[f64]) -> Result<(), String> {
        let released = |drops: usize| self.released()[drops];
        let coldest = |cloud: &Cloud| self.coldest(cloud);
        acceptance::check(state, (&self.plan, &self.method, self.wall()), coldest, released)
    }

    /// What there is after none, one, … of the releases.
    fn released(&self) -> &[Released] {
        self.released.get_or_init(|| {
            let (mut ledger, mut cloud) = (Ledger::default(), Cloud::default());
            let mut all = vec![Released::default()];
            for release in &self.plan.releases {
                self.add(release, &mut ledger, &mut cloud);
                let before = all[all.len() - 1];
                all.push(Released {
                    particles: before.particles + cloud.len(),
                    mass: before.mass + cloud.mass.iter().sum::<f64>(),
                });
                cloud = Cloud::default();
            }
            all
        })
    }

    /// Advances by `duration` [s] with as many time steps as stability asks, under a temperature of
    /// each wall cell [K], held. A failure leaves the state as it was.
    pub fn advance(
        &self,
        state: &mut Vec<f64>,
        wall_temperature: &[f64],
        duration: f64,
    ) -> Result<(), Failure> {
        self.advance_within(state, wall_temperature, duration, &Allowance::default())
    }

    /// The same, as part of a step that may not compute without end.
    pub fn advance_within(
        &self,
        state: &mut Vec<f64>,
        wall_temperature: &[f64],
        duration: f64,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        let surface = self.surface(state, wall_temperature);
        self.advance_above(state, &surface, duration, allowance).map(|_| ())
    }

    /// Advances by `duration` [s] above a surface that answers to the heat it gets; the rises of its cells by
    /// that heat at the end [K m²]. A failure leaves the state as it was.
    pub fn advance_above(
        &self,
        state: &mut Vec<f64>,
        surface: &Surface,
        duration: f64,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, Failure> {
        let mut team = self.team(self.particles_in(state));
        let (mut ledger, mut cloud) =
            (ledger_of(state, self.wall()), cloud_of(state, self.wall(), &team));
        ledger.exchange = WallExchange::none(self.wall().cells);
        ledger.exchange.duration = duration;
        let surface = surface.above(self.reference_temperature());
        let method = &self.method;
        let cells = method.wall.as_ref();
        let mut points =
            cells.map(|cells| WallPoints::new(&method.points, cells, &surface, duration));
        let end = ledger.time + duration;
        while ledger.time < end {
            let next =
                self.plan.releases.get(ledger.released as usize).map_or(end, |r| r.time.min(end));
            let rest = next - ledger.time;
            if rest > 0.0 {
                let points = points.as_mut();
                Stepper::new(method, &team, &mut cloud, &mut ledger, points)
                    .advance(rest, allowance)?;
            }
            ledger.time = next;
            if self.release(&mut ledger, &mut cloud)? {
                team = self.team(cloud.len());
            }
        }
        let (temperature, time) = (self.coldest(&cloud), ledger.time);
        if temperature <= 0.0 {
            return Err(Failure::BelowAbsoluteZero { temperature, time });
        }
        let mut rises = Vec::new();
        if let Some(points) = points {
            (ledger.exchange, rises) = points.settle();
            let (heat, impulse) = points.totals();
            ledger.heat_to_wall += heat;
            (0..3).for_each(|n| ledger.impulse_to_wall[n] += impulse[n]);
            if !self.below.is_empty() {
                ledger.memory.advance(&self.below, duration, points.cell_heat());
            }
        }
        flatten(state, &mut ledger, &mut cloud, &team);
        Ok(rises)
    }

    /// Lowest temperature of a particle [K]; without end where there is none.
    fn coldest(&self, cloud: &Cloud) -> f64 {
        let coldest = cloud.temperature.iter().copied().fold(f64::INFINITY, f64::min);
        coldest + self.reference_temperature()
    }

    /// The wall under temperatures [K] that are known at the beginning of a step.
    fn surface(&self, state: &[f64], temperature: &[f64]) -> Surface {
        if self.below.is_empty() {
            return Surface::held(temperature);
        }
        let memory = ledger_of(state, self.wall()).memory;
        Surface::remembered(temperature, self.below.clone(), &memory)
    }

    /// What the wall got during the last step; nothing before the first.
    pub fn exchange(&self, state: &[f64]) -> WallExchange {
        ledger_of(state, self.wall()).exchange
    }

    /// Counts what the wall got before the last step as part of that.
    pub fn add_exchange(&self, state: &mut [f64], earlier: &WallExchange) {
        let mut ledger = ledger_of(state, self.wall());
        ledger.exchange.add(earlier);
        store(&mut ledger, state);
    }

    pub fn totals(&self, state: &[f64]) -> DropletTotals {
        let (ledger, cloud) = (ledger_of(state, self.wall()), self.cloud(state));
        totals(&self.plan, &self.method, &ledger, &cloud)
    }

    pub fn particles(&self, state: &[f64]) -> ParticleFields {
        let cloud = self.cloud(state);
        let units = &self.method.units;
        let reference = self.reference_temperature();
        let within = |mut x: [f64; 3]| {
            self.method.images.wrap(&mut x);
            x.map(|x| x * units.length)
        };
        ParticleFields {
            position: cloud.position.iter().map(|&x| within(x)).collect(),
            velocity: cloud.velocity.iter().map(|v| v.map(|v| v * units.speed)).collect(),
            mass: cloud.mass.iter().map(|m| m * units.mass()).collect(),
            density: cloud.density.iter().map(|r| (1.0 + r) * units.density).collect(),
            pressure: cloud.density.iter().map(|&r| pressure(r) * units.pressure()).collect(),
            temperature: cloud.temperature.iter().map(|t| t + reference).collect(),
        }
    }

    /// Number of particles that the whole plan will have, and its time step at the speed of the
    /// fastest droplet [s].
    pub fn forecast(plan: &DropletPlan) -> (usize, f64) {
        let particles: f64 = plan.releases.iter().map(|r| particles_of(plan, r)).sum();
        let speed = |r: &Release| r.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let fastest = plan.releases.iter().map(speed).fold(0.0, f64::max);
        let method = Method::of(plan);
        let gravity = plan.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let units = &method.units;
        let gravity = gravity * units.length / units.speed.powi(2);
        let step = method.stable_step(fastest / units.speed, gravity) * units.time();
        (particles.round() as usize, step)
    }

    fn wall(&self) -> WallNumbers {
        let cells = self.plan.wall.as_ref().map_or(0, |wall| wall.cells.len());
        WallNumbers { cells, exponentials: self.below.len() }
    }

    fn empty_ledger(&self) -> Ledger {
        Ledger::none(self.wall())
    }

    /// The fields of a state; nothing of a length that fits no number of particles.
    pub fn layout(&self, state: &[f64]) -> Option<Layout> {
        particles_in(state, self.wall()).map(|count| layout(self.wall(), count))
    }

    /// The zero of the model's temperatures [K].
    fn reference_temperature(&self) -> f64 {
        self.plan.releases.first().map_or(0.0, |release| release.temperature)
    }

    fn cloud(&self, state: &[f64]) -> Cloud {
        cloud_of(state, self.wall(), &Team::new(1))
    }

    /// Adds all droplets whose time has come; whether there are any.
    fn release(&self, ledger: &mut Ledger, cloud: &mut Cloud) -> Result<bool, Failure> {
        let before = cloud.len();
        while let Some(release) =
            self.plan.releases.get(ledger.released as usize).filter(|r| r.time <= ledger.time)
        {
            self.add(release, ledger, cloud);
            ledger.released += 1.0;
        }
        if cloud.len() > before {
            self.prime(ledger, cloud)?;
        }
        Ok(cloud.len() > before)
    }

    fn prime(&self, ledger: &mut Ledger, cloud: &mut Cloud) -> Result<(), Failure> {
        let team = self.team(cloud.len());
        Stepper::new(&self.method, &team, cloud, ledger, None).prime()
    }

    /// Threads for some particles; no more than there are parts for them.
    fn team(&self, particles: usize) -> Team {
        Team::new(self.threads.min(particles.div_ceil(PART)))
    }

    fn add(&self, release: &Release, ledger: &mut Ledger, cloud: &mut Cloud) {
        let plan = &self.plan;
        let units = &self.method.units;
        let points = place(plan.placement, release.diameter, plan.spacing, plan.dimension);
        let volume = match plan.dimension {
            2 => PI / 4.0 * release.diameter.powi(2),
            _ => PI / 6.0 * release.diameter.powi(3),
        };
        let mass = plan.fluid.density * volume / units.mass();
        let temperature = release.temperature - self.reference_temperature();
        let images = copies(plan.mirrors);
        // Under the pressure that its surface keeps up, so that it does not begin to ring.
        let curvature = 2.0 * (plan.dimension as f64 - 1.0) / release.diameter;
        let compressed = density(plan.fluid.surface_tension * curvature / units.pressure());
        for (point, share) in points {
            let at = [0, 1, 2].map(|a| (release.centre[a] + point[a]) / units.length);
            if (0..2).any(|a| plan.mirrors[a] && at[a] < 0.0) {
                continue;
            }
            let velocity = release.velocity.map(|v| v / units.speed);
            cloud.push(at, velocity, share * mass, temperature);
            *cloud.density.last_mut().expect("one was just added") = compressed;
            let heat = units.energy() / self.method.heat_unit;
            ledger.heat_released += images * share * mass * heat * temperature;
        }
    }
}

/// Shortest time over a step of the fluid, and longest, for which the response of a solid below is that of a
/// half space.
const REMEMBERED: [f64; 2] = [0.1, 1e4];

fn response_below(plan: &DropletPlan, method: &Method) -> SurfaceResponse {
    let effusivity = plan.wall.as_ref().and_then(|wall| wall.effusivity);
    let step = method.stable_step(0.0, 0.0) * method.units.time();
    effusivity.filter(|_| method.conduction > 0.0).map_or_else(SurfaceResponse::default, |e| {
        SurfaceResponse::of_half_space(e, REMEMBERED.map(|part| part * step))
    })
}

fn flat(ledger: &mut Ledger, cloud: &mut Cloud) -> Vec<f64> {
    let mut state = Vec::new();
    flatten(&mut state, ledger, cloud, &Team::new(1));
    state
}

/// Sums over the fluid.
fn totals(plan: &DropletPlan, method: &Method, ledger: &Ledger, cloud: &Cloud) -> DropletTotals {
    let units = &method.units;
    let images = copies(plan.mirrors);
    let heat_unit = units.energy() / method.heat_unit;
    let mut totals = DropletTotals {
        surface_energy: ledger.surface_energy,
        heat_to_wall: ledger.heat_to_wall,
        impulse_to_wall: ledger.impulse_to_wall,
        impulse_of_gravity: ledger.impulse_of_gravity,
        heat_released: ledger.heat_released,
        steps: ledger.steps,
        particles: cloud.len() as f64,
        density_range: [f64::INFINITY, f64::NEG_INFINITY],
        temperature_range: [f64::INFINITY, f64::NEG_INFINITY],
        max_pressure: f64::NEG_INFINITY,
        ..DropletTotals::default()
    };
    let reference = plan.releases.first().map_or(0.0, |release| release.temperature);
    for i in 0..cloud.len() {
        let mass = images * cloud.mass[i];
        let speed = cloud.velocity[i].iter().map(|v| v * v).sum::<f64>();
        totals.mass += mass * units.mass();
        for a in 0..3 {
            let mirrored = a < 2 && plan.mirrors[a];
            let share = if mirrored { 0.0 } else { mass };
            totals.momentum[a] += share * cloud.velocity[i][a] * units.mass() * units.speed;
        }
        totals.kinetic_energy += 0.5 * mass * speed * units.energy();
        totals.compression_energy += mass * compression_energy(cloud.density[i]) * units.energy();
        totals.heat += mass * heat_unit * cloud.temperature[i];
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
    let body = body(plan, ledger, cloud);
    for (i, &in_body) in body.iter().enumerate() {
        if in_body {
            totals.height = totals.height.max(cloud.position[i][2] * units.length);
        } else {
            totals.stray_mass += images * cloud.mass[i] * units.mass();
            totals.stray_particles += 1.0;
        }
    }
    // Without a wall there is nothing to spread on, however low particles fall.
    if plan.wall.is_some() {
        let places = wetting_places(plan, cloud, &body);
        totals.spread_diameter = plan.spacing * spread_diameter(&places, plan.dimension);
    }
    totals
}

/// Whether each particle belongs to the body of fluid.
fn body(plan: &DropletPlan, ledger: &Ledger, cloud: &Cloud) -> Vec<bool> {
    let places: Vec<_> = cloud.position.iter().map(|x| x.map(|x| x * plan.support)).collect();
    let mass: f64 = cloud.mass.iter().sum();
    body_of_fluid(&places, &cloud.mass, mass / ledger.released.max(1.0))
}

/// Height over Δx below which a particle's middle is at the wall: that of its first layer, with as much
/// again to move in.
const AT_WALL: f64 = 1.5;

/// Places over Δx, round their middle, of all particles of the body that lie on the wall; images at
/// mirrors included.
fn wetting_places(plan: &DropletPlan, cloud: &Cloud, body: &[bool]) -> Vec<[f64; 2]> {
    let spacing = 1.0 / plan.support;
    let at_wall = |&i: &usize| body[i] && cloud.position[i][2] < AT_WALL * spacing;
    let wetting: Vec<usize> = (0..cloud.len()).filter(at_wall).collect();
    let mass: f64 = wetting.iter().map(|&i| cloud.mass[i]).sum();
    let middle = |a: usize| match plan.mirrors[a] {
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

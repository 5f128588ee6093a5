//! The droplet as a body.

mod demand;
mod extremes;
mod half_space;
mod totals;

use super::acceptance::{self, Released};
use super::cloud::{
    Cloud, HeadNumbers, Ledger, cloud_of, flatten, layout, ledger_of, particles_in,
};
use super::failure::Failure;
use super::images::copies;
use super::loops::PART;
use super::method::{Method, StepShares};
use super::placement::{place, rings};
use super::plan::{DropletPlan, Release};
use super::stepper::Stepper;
use super::units::{density, pressure};
use super::wall_points::WallPoints;
use crate::port::WallExchange;
use crate::port::{Surface, SurfaceResponse};
use crate::runtime::allowance::Allowance;
use crate::runtime::made_once::MadeOnce;
use crate::runtime::parallel::Team;
use crate::state::{Layout, store};

pub use extremes::WarmPlace;
pub use totals::DropletTotals;
use totals::totals;

/// Droplets above a wall: everything known before time starts. What changes is a flat vector, whose
/// length grows when a droplet is released.
pub struct DropletSph {
    plan: DropletPlan,
    method: Method,
    threads: usize,
    /// Of a solid below whose temperature somebody else computes; nothing where that is held.
    below: SurfaceResponse,
    /// What there is after each release, found when a state from elsewhere is looked at; of drops on demand, which
    /// are all alike, after none and one.
    released: MadeOnce<Vec<Released>>,
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
        Self::with_shares(plan, threads, StepShares::default())
    }

    /// With other time steps than those of scenes, to see where they fail.
    pub fn with_shares(plan: DropletPlan, threads: usize, shares: StepShares) -> Self {
        let method = Method::with_shares(&plan, shares);
        let below = response_below(&plan, &method);
        Self { plan, method, threads, below, released: MadeOnce::new() }
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
            // They are as the plan's fluid has become.
            cloud.initial[i] = 0.0;
        }
        let released = self.plan.releases.len() as f64;
        let mut ledger = Ledger { released, ..self.empty_ledger() };
        // As above.
        let _ = self.prime(&mut ledger, &mut cloud);
        flat(&mut ledger, &mut cloud)
    }

    /// Number of particles of a state.
    pub fn particles_in(&self, state: &[f64]) -> usize {
        particles_in(state, self.head()).unwrap_or(0)
    }

    /// Refuses a vector that no run of these droplets leads to, with what is wrong with it.
    pub fn check_state(&self, state: &[f64]) -> Result<(), String> {
        let released = |drops: usize| self.released_after(drops);
        let coldest = |cloud: &Cloud| self.coldest(cloud);
        acceptance::check(state, (&self.plan, &self.method, self.head()), coldest, released)
    }

    fn released_after(&self, drops: usize) -> Released {
        let all = self.released();
        match (&self.plan.demand, all) {
            (Some(_), [_, one]) => Released {
                particles: drops.saturating_mul(one.particles),
                mass: drops as f64 * one.mass,
            },
            _ => all[drops],
        }
    }

    /// What there is after none, one, … of the releases.
    fn released(&self) -> &[Released] {
        self.released.get_or_make(|| {
            let (mut ledger, mut cloud) = (Ledger::default(), Cloud::default());
            let mut all = vec![Released::default()];
            let expected = self.plan.demand.as_ref().map(|demand| &demand.expected);
            for release in self.plan.releases.iter().chain(expected) {
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
            (ledger_of(state, self.head()), cloud_of(state, self.head(), &team));
        ledger.exchange = WallExchange::none(self.head().cells);
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
        let memory = ledger_of(state, self.head()).memory;
        Surface::remembered(temperature, self.below.clone(), &memory)
    }

    /// What the wall got during the last step; nothing before the first.
    pub fn exchange(&self, state: &[f64]) -> WallExchange {
        ledger_of(state, self.head()).exchange
    }

    /// Counts what the wall got before the last step as part of that.
    pub fn add_exchange(&self, state: &mut [f64], earlier: &WallExchange) {
        let mut ledger = ledger_of(state, self.head());
        ledger.exchange.add(earlier);
        store(&mut ledger, state);
    }

    pub fn totals(&self, state: &[f64]) -> DropletTotals {
        let (ledger, cloud) = (ledger_of(state, self.head()), self.cloud(state));
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
        let particles: f64 = plan.drops().map(|r| plan.particles_of(r.diameter)).sum();
        let speed = |r: Release| r.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let fastest = plan.drops().map(speed).fold(0.0, f64::max);
        let method = Method::of(plan);
        let gravity = plan.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let units = &method.units;
        let gravity = gravity * units.length / units.speed.powi(2);
        let step = method.stable_step(fastest / units.speed, gravity) * units.time();
        (particles.round() as usize, step)
    }

    fn head(&self) -> HeadNumbers {
        let cells = self.plan.wall.as_ref().map_or(0, |wall| wall.cells.len());
        let most = self.plan.demand.as_ref().map(|demand| demand.most);
        HeadNumbers { cells, exponentials: self.below.len(), most }
    }

    fn empty_ledger(&self) -> Ledger {
        Ledger::none(self.head())
    }

    /// The fields of a state; nothing of a length that fits no number of particles.
    pub fn layout(&self, state: &[f64]) -> Option<Layout> {
        particles_in(state, self.head()).map(|count| layout(self.head(), count))
    }

    /// The zero of the model's temperatures [K].
    fn reference_temperature(&self) -> f64 {
        self.plan.reference_temperature()
    }

    fn cloud(&self, state: &[f64]) -> Cloud {
        cloud_of(state, self.head(), &Team::new(1))
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
        let mut points = place(plan.placement, release.diameter, plan.spacing, plan.axes());
        if plan.axisymmetric {
            points = rings(&points);
        }
        let mass = plan.fluid.density * plan.volume(release.diameter) / units.mass();
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

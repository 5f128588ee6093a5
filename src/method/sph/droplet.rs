//! The droplet as a body.

mod demand;
mod extremes;
mod fed;
mod frozen;
mod half_space;
mod resting;
mod sleep;
mod totals;

use super::acceptance::{self, Released};
use super::cloud::{
    Cloud, HeadNumbers, Ledger, cloud_of, flatten, layout, ledger_of, particles_in,
};
use super::failure::Failure;
use super::feed::Column;
use super::images::copies;
use super::loops::PART;
use super::method::{Method, StepShares};
use super::placement::{place, rings};
use super::plan::{DropletPlan, Release};
use super::stepper::Stepper;
use super::units::{density, pressure};
use super::wall_points::WallPoints;
use crate::inputs::Trend;
use crate::port::WallExchange;
use crate::port::{Surface, SurfaceResponse};
use crate::runtime::allowance::Allowance;
use crate::runtime::made_once::MadeOnce;
use crate::runtime::parallel::Team;
use crate::state::{Layout, store};

pub use extremes::WarmPlace;
pub use fed::Laid;
pub use totals::DropletTotals;
use totals::{sums, totals};

/// Droplets above a wall: everything known before time starts. The variables of state form a flat
/// vector, which grows when a droplet is released.
pub struct DropletSph {
    plan: DropletPlan,
    method: Method,
    /// The column of a nozzle.
    column: Option<Column>,
    threads: usize,
    /// Response of a solid below that somebody else computes; `None` for a wall of prescribed
    /// temperature.
    below: SurfaceResponse,
    /// Particles after each release, computed when a state from outside is first checked. Drops on
    /// demand are all alike, so two entries suffice: after none and after one.
    released: MadeOnce<Vec<Released>>,
}

/// A step of the model in progress.
struct Run<'a> {
    method: &'a Method,
    team: Team,
    cloud: Cloud,
    ledger: Ledger,
    points: Option<WallPoints<'a>>,
    /// Temperature of the air above the model's reference [K].
    air: Trend,
    allowance: &'a Allowance,
}

impl Run<'_> {
    /// Advances the particles that there are [s].
    fn advance(&mut self, duration: f64) -> Result<(), Failure> {
        let Self { method, team, cloud, ledger, points, air, allowance } = self;
        let mut stepper = Stepper::new(method, team, cloud, ledger, points.as_mut());
        stepper.air = *air;
        stepper.advance(duration, allowance)
    }
}

/// The particles of a state, images at mirrors excluded.
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
    /// Frozen fraction of each particle; empty for a fluid that stays liquid.
    pub solid_fraction: Vec<f64>,
    /// Width of each segment of a strand; empty for particles [m].
    pub width: Vec<f64>,
    /// Largest damage of the links of each particle of a lattice, damage of concrete; empty for others.
    pub damage: Vec<f64>,
    /// Displacement [m] and von Mises stress [Pa] of each node of a solid of large strain; empty for others.
    pub displacement: Vec<[f64; 3]>,
    pub von_mises: Vec<f64>,
}

impl DropletSph {
    /// Creates the droplets of a plan; `threads` = 0 means 1.
    ///
    /// # Panics
    /// If the plan's planes and periods are incompatible, see [`Extent`](super::Extent).
    pub fn new(plan: DropletPlan, threads: usize) -> Self {
        Self::with_shares(plan, threads, StepShares::default())
    }

    /// Uses time steps other than those of scenes, to find where they fail.
    pub fn with_shares(plan: DropletPlan, threads: usize, shares: StepShares) -> Self {
        let method = Method::with_shares(&plan, shares);
        let below = response_below(&plan, &method);
        let column = plan.feed.map(|feed| Column::of(&plan, &feed, &method.units));
        Self { plan, method, column, threads, below, released: MadeOnce::new() }
    }

    pub fn plan(&self) -> &DropletPlan {
        &self.plan
    }

    /// State at time zero: it contains the drops released then.
    pub fn initial_state(&self) -> Vec<f64> {
        let (mut ledger, mut cloud) = (self.empty_ledger(), self.no_particles());
        // Particles too close to be listed are refused again by the first step.
        let _ = match self.plan.feed {
            Some(feed) => self.begin_feed(&feed, &mut ledger, &mut cloud),
            None => self.release(&mut ledger, &mut cloud).map(|_| ()),
        };
        flat(&mut ledger, &mut cloud)
    }

    /// A state at time zero with these particles in place of the plan's droplets.
    pub fn state_of(&self, particles: &ParticleFields) -> Vec<f64> {
        let units = &self.method.units;
        let reference = self.reference_temperature();
        let mut cloud = self.no_particles();
        for i in 0..particles.mass.len() {
            let position = particles.position[i].map(|x| x / units.length);
            let velocity = particles.velocity[i].map(|v| v / units.speed);
            let mass = particles.mass[i] / units.mass();
            cloud.push(position, velocity, mass, particles.temperature[i] - reference);
            cloud.density[i] = particles.density[i] / units.density - 1.0;
            // The particles' state equals that of the plan's fluid.
            cloud.initial[i] = 0.0;
            if let (Some(phases), Some(content)) = (&self.method.phases, &mut cloud.content) {
                content[i] = phases.content(cloud.temperature[i]);
            }
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

    /// Returns the reason why no run of these droplets leads to a vector.
    pub fn check_state(&self, state: &[f64]) -> Result<(), String> {
        let released = |drops: usize| self.released_after(drops);
        let coldest = |cloud: &Cloud| self.coldest(cloud);
        let model = (&self.plan, &self.method, self.head());
        let waits = |cloud: &Cloud, next: usize| !self.is_clear(cloud, &self.plan.releases[next]);
        acceptance::check(state, model, self.column.as_ref(), coldest, released, waits)
    }

    fn released_after(&self, drops: usize) -> Released {
        if let Some(column) = &self.column {
            return Released {
                particles: drops.saturating_mul(column.places.len()),
                mass: drops as f64 * column.layer_mass(),
            };
        }
        let all = self.released();
        match (&self.plan.demand, all) {
            (Some(_), [_, one]) => Released {
                particles: drops.saturating_mul(one.particles),
                mass: drops as f64 * one.mass,
            },
            _ => all[drops],
        }
    }

    /// Particles after none, one, … of the releases.
    fn released(&self) -> &[Released] {
        self.released.get_or_make(|| {
            let (mut ledger, mut cloud) = (Ledger::default(), self.no_particles());
            let mut all = vec![Released::default()];
            let expected = self.plan.demand.as_ref().map(|demand| &demand.expected);
            for release in self.plan.releases.iter().chain(expected) {
                self.add(release, &mut ledger, &mut cloud);
                let before = all[all.len() - 1];
                all.push(Released {
                    particles: before.particles + cloud.len(),
                    mass: before.mass + cloud.mass.iter().sum::<f64>(),
                });
                cloud = self.no_particles();
            }
            all
        })
    }

    /// Advances by `duration` [s] at a prescribed temperature of each wall cell [K], in as many
    /// time steps as stability requires. A failure leaves the state unchanged.
    pub fn advance(
        &self,
        state: &mut Vec<f64>,
        wall_temperature: &[f64],
        duration: f64,
    ) -> Result<(), Failure> {
        let surface = self.surface(state, [wall_temperature; 2]);
        self.advance_above(state, &surface, duration, &Allowance::default()).map(|_| ())
    }

    /// Advances by `duration` [s] above a surface that responds to the heat it receives. Returns
    /// the rises of its cells due to that heat at the end [K m²]. A failure leaves the state
    /// unchanged.
    pub fn advance_above(
        &self,
        state: &mut Vec<f64>,
        surface: &Surface,
        duration: f64,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, Failure> {
        self.advance_by(state, surface, duration, allowance, |run| {
            let end = run.ledger.time + duration;
            while run.ledger.time < end {
                let due = self.plan.releases.get(run.ledger.released as usize);
                // One that is due waits until the end.
                let due = due.filter(|release| release.time > run.ledger.time);
                let next = due.map_or(end, |release| release.time.min(end));
                let rest = next - run.ledger.time;
                if rest > 0.0 {
                    run.advance(rest)?;
                }
                run.ledger.time = next;
                if self.release(&mut run.ledger, &mut run.cloud)? {
                    run.team = self.team(run.cloud.len());
                }
            }
            Ok(())
        })
    }

    /// Advances by `duration` [s] as `steps` does with the particles of a state above a surface.
    fn advance_by(
        &self,
        state: &mut Vec<f64>,
        surface: &Surface,
        duration: f64,
        allowance: &Allowance,
        steps: impl FnOnce(&mut Run) -> Result<(), Failure>,
    ) -> Result<Vec<f64>, Failure> {
        let team = self.team(self.particles_in(state));
        let (mut ledger, cloud) =
            (ledger_of(state, self.head()), cloud_of(state, self.head(), &team));
        ledger.exchange = WallExchange::none(self.head().cells);
        ledger.exchange.duration = duration;
        let surface = surface.above(self.reference_temperature());
        let method = &self.method;
        let cells = method.wall.as_ref();
        let mut points =
            cells.map(|cells| WallPoints::new(&method.points, cells, &surface, duration));
        if let (Some(points), Some(heat)) = (&mut points, &method.wall_heat) {
            points.resistance = heat.resistance_above(&surface);
        }
        let air = Trend::default();
        let mut run = Run { method, team, cloud, ledger, points, air, allowance };
        steps(&mut run)?;
        let Run { team, mut cloud, mut ledger, points, .. } = run;
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

    /// Lowest temperature of a particle [K]; infinite if there is none.
    fn coldest(&self, cloud: &Cloud) -> f64 {
        let coldest = cloud.temperature.iter().copied().fold(f64::INFINITY, f64::min);
        coldest + self.reference_temperature()
    }

    /// The wall over a step with prescribed temperatures [K] at its beginning and its end. One with a response of its own
    /// goes on from the mean of both as the heat spreads in it.
    pub fn surface(&self, state: &[f64], [begin, end]: [&[f64]; 2]) -> Surface {
        if self.below.is_empty() {
            return Surface::following([begin, end]);
        }
        let memory = ledger_of(state, self.head()).memory;
        let mean: Vec<f64> = begin.iter().zip(end).map(|(a, b)| 0.5 * (a + b)).collect();
        Surface::remembered(&mean, self.below.clone(), &memory)
    }

    /// Heat and impulse that the wall received during the last step; zero before the first.
    pub fn exchange(&self, state: &[f64]) -> WallExchange {
        ledger_of(state, self.head()).exchange
    }

    /// Adds the exchange of an earlier part of the step to that of the last.
    pub fn add_exchange(&self, state: &mut [f64], earlier: &WallExchange) {
        let mut ledger = ledger_of(state, self.head());
        ledger.exchange.add(earlier);
        store(&mut ledger, state);
    }

    pub fn totals(&self, state: &[f64]) -> DropletTotals {
        let (ledger, cloud) = (ledger_of(state, self.head()), self.cloud(state));
        totals(&self.plan, &self.method, &ledger, &cloud)
    }

    /// Sums over the fluid but for those of the shape of drops, which are zero.
    pub fn sums(&self, state: &[f64]) -> DropletTotals {
        let (ledger, cloud) = (ledger_of(state, self.head()), self.cloud(state));
        sums(&self.plan, &self.method, &ledger, &cloud)
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
            solid_fraction: frozen::solid_fractions(&self.method, &cloud),
            ..ParticleFields::default()
        }
    }

    /// Number of particles of the whole plan, and its time step at the speed of the fastest droplet
    /// [s].
    pub fn forecast(plan: &DropletPlan) -> (usize, f64) {
        Self::expected_of(plan, &Method::of(plan))
    }

    /// As [`Self::forecast`], for the own plan.
    pub fn expected(&self) -> (usize, f64) {
        Self::expected_of(&self.plan, &self.method)
    }

    fn expected_of(plan: &DropletPlan, method: &Method) -> (usize, f64) {
        let speed = |r: Release| r.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let of_feed = plan.feed.map_or(0.0, |feed| feed.fastest);
        let fastest = plan.drops().map(speed).fold(of_feed, f64::max);
        let gravity = plan.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let units = &method.units;
        let gravity = gravity * units.length / units.speed.powi(2);
        let step = method.stable_step(fastest / units.speed, gravity) * units.time();
        (plan.particles(), step)
    }

    fn no_particles(&self) -> Cloud {
        Cloud::none(self.head())
    }

    fn head(&self) -> HeadNumbers {
        let cells = self.plan.wall.as_ref().map_or(0, |wall| wall.cells.len());
        let most = self.plan.demand.as_ref().map(|demand| demand.most);
        HeadNumbers {
            cells,
            exponentials: self.below.len(),
            most,
            stressed: !self.method.flow.is_newtonian(),
            freezes: self.method.phases.is_some(),
            solves_pressure: self.method.solves_pressure,
            cools: self.method.cooling.is_some(),
            fed: self.plan.feed.is_some(),
        }
    }

    fn empty_ledger(&self) -> Ledger {
        Ledger::none(self.head())
    }

    /// Fields of a state; `None` if its length fits no number of particles.
    pub fn layout(&self, state: &[f64]) -> Option<Layout> {
        particles_in(state, self.head()).map(|count| layout(self.head(), count))
    }

    /// Zero of the model's temperatures [K].
    fn reference_temperature(&self) -> f64 {
        self.plan.reference_temperature()
    }

    fn cloud(&self, state: &[f64]) -> Cloud {
        cloud_of(state, self.head(), &Team::new(1))
    }

    /// Adds all droplets whose release time has been reached, up to the first whose place fluid
    /// occupies; returns true if there are any.
    fn release(&self, ledger: &mut Ledger, cloud: &mut Cloud) -> Result<bool, Failure> {
        let before = cloud.len();
        while let Some(release) = self.next_due(ledger).filter(|r| self.is_clear(cloud, r)) {
            self.add(release, ledger, cloud);
            ledger.released += 1.0;
        }
        if cloud.len() > before {
            self.prime(ledger, cloud)?;
        }
        Ok(cloud.len() > before)
    }

    /// The next of the plan's drops, if its time has been reached.
    fn next_due(&self, ledger: &Ledger) -> Option<&Release> {
        let next = self.plan.releases.get(ledger.released as usize);
        next.filter(|release| release.time <= ledger.time)
    }

    /// Release time of the plan's drop that waits because fluid occupies its place [s].
    pub fn late_release(&self, state: &[f64]) -> Option<f64> {
        let ledger = ledger_of(state, self.head());
        self.next_due(&ledger).map(|release| release.time)
    }

    fn prime(&self, ledger: &mut Ledger, cloud: &mut Cloud) -> Result<(), Failure> {
        let team = self.team(cloud.len());
        Stepper::new(&self.method, &team, cloud, ledger, None).prime()
    }

    /// Threads for a number of particles: at most one per part.
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
        // At the pressure that balances surface tension, so that the drop does not start to
        // oscillate.
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

/// Shortest and longest time, over a step of the fluid, for which the response of a solid below is
/// that of a half space.
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

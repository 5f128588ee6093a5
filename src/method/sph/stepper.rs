//! Steps in time.
//!
//! Kick, drift, kick with one evaluation of each rate: density and temperature are advanced with
//! rates at the middle of the step, velocities with accelerations at its ends, so the scheme is of
//! second order and its pressure waves are neither damped nor amplified by it (Adami, Hu & Adams
//! 2012, J. Comput. Phys. 231, 7057–7075, doi 10.1016/j.jcp.2012.05.005). Surface tension, which changes
//! slowly, acts as impulses between rounds of steps.

mod densities;
mod exposed;
mod frozen;
mod shift;
mod wall;

pub use self::densities::conducting;
use self::densities::drift;
use super::cloud::{Cloud, Ledger, Part, UNKNOWNS};
use super::failure::Failure;
use super::free_surface::FreeSurface;
use super::frozen::{Moved, Pieces};
use super::images::copies;
use super::kick::{DENSITIES, FARTHEST, FASTEST, Motion, Times, kick};
use super::loops::{PART, PairSum, for_all};
use super::method::Method;
use super::momentum::Momentum;
use super::neighbours::{Displacements, Neighbours};
use super::order::space_order;
use super::pulls::{Bounded, balanced};
use super::units::pressure;
use super::viscous;
use super::wall_points::WallPoints;
use crate::inputs::Trend;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// State of a run between two communication points.
pub struct Stepper<'a, 'p> {
    method: &'a Method,
    team: &'a Team,
    cloud: &'a mut Cloud,
    ledger: &'a mut Ledger,
    neighbours: Neighbours,
    /// Points of the wall; `None` where there is none.
    points: Option<&'a mut WallPoints<'p>>,
    /// True if heat is conducted: not where all temperatures are equal.
    heats: bool,
    /// Inputs and results of the loops over pairs, in memory that is reused.
    records: Vec<[f64; 8]>,
    annexes: Vec<[f64; 4]>,
    /// Density of each particle.
    densities: Vec<f64>,
    accelerations: Vec<[[f64; 3]; 2]>,
    /// Free surfaces, where they have tension.
    free_surface: FreeSurface,
    /// Kicks whose reaction the wall has not received yet.
    pending_kicks: Vec<Times>,
    /// Frozen fluid.
    frozen: Pieces,
    /// Temperature of the air above the reference [K], and whether free surfaces have been found.
    pub air: Trend,
    exposed: bool,
    /// Velocities that held particles have lost, and whose impulse the wall has not received yet; empty where none was
    /// held.
    stopped: Vec<[f64; 3]>,
}

/// Name of the loop over time steps in messages.
const STEPS: &str = "time steps of a droplet";
/// Growth of the blocks' surroundings at which the particles are sorted anew.
const GROWTH: f64 = 1.2;
/// Mean path over H after which particles are shifted.
const SHIFT_WAY: f64 = 0.05;

impl<'a, 'p> Stepper<'a, 'p> {
    pub fn new(
        method: &'a Method,
        team: &'a Team,
        cloud: &'a mut Cloud,
        ledger: &'a mut Ledger,
        points: Option<&'a mut WallPoints<'p>>,
    ) -> Self {
        let surface = points.as_ref().map(|points| points.surface);
        let changes = surface.is_some_and(|surface| surface.changes());
        let walls = surface.into_iter().flat_map(|surface| &surface.base);
        let differ = differ(cloud.temperature.iter().chain(walls).copied());
        let rests = points.as_ref().is_some_and(|points| !points.resting.is_empty());
        let heats = method.conduction > 0.0 && (differ || changes || rests);
        Self {
            method,
            team,
            cloud,
            ledger,
            neighbours: Neighbours::default(),
            points,
            heats,
            records: Vec::new(),
            annexes: Vec::new(),
            densities: Vec::new(),
            accelerations: Vec::new(),
            free_surface: FreeSurface::default(),
            pending_kicks: Vec::new(),
            frozen: Pieces::NONE,
            air: Trend::default(),
            exposed: false,
            stopped: Vec::new(),
        }
    }

    /// Unknowns that a time step advances, or as many as take as long.
    fn work(&self) -> usize {
        self.cloud.len() * UNKNOWNS * self.method.step_cost() as usize
    }

    /// Returns true if particles must be sorted: they have mixed, or must be wrapped into a period.
    fn needs_sorting(&self) -> bool {
        self.neighbours.surrounded() > GROWTH * self.ledger.surrounded
            || self.method.images.are_beyond_period(&self.cloud.position)
    }

    fn sort(&mut self) {
        self.push_wall_by_stopped();
        self.cloud.position.iter_mut().for_each(|x| self.method.images.wrap(x));
        let order = space_order(&self.cloud.position, self.team);
        self.cloud.permute(&order, self.team);
        self.neighbours = Neighbours::of(&self.cloud.position, self.team);
        self.ledger.surrounded = self.neighbours.surrounded();
        self.free_surface.forget();
        self.frozen = Pieces::of(self.method, self.cloud);
    }

    /// Lists neighbours for predicted displacements of the particles.
    fn list(&mut self, displacements: &Displacements) -> Result<(), Failure> {
        self.neighbours.prepare(
            &self.cloud.position,
            displacements,
            &self.method.images,
            self.team,
        );
        if let Some(at) = self.neighbours.crowded() {
            let at = at.map(|x| x * self.method.units.length);
            return Err(Failure::Crowded { at, time: self.ledger.time });
        }
        if let Some(setting) = &self.method.surface {
            self.free_surface.prepare(setting, self.cloud, displacements, self.team);
        }
        Ok(())
    }

    /// Advances by `duration` [s]. Neighbour lists are made anew, so that the result depends on the
    /// state alone; the order of the particles is part of the state, and is kept while it is good.
    pub fn advance(&mut self, duration: f64, allowance: &Allowance) -> Result<(), Failure> {
        let method = self.method;
        self.neighbours = Neighbours::of(&self.cloud.position, self.team);
        match self.needs_sorting() {
            true => self.sort(),
            false => self.frozen = Pieces::of(method, self.cloud),
        }
        if method.implicit {
            self.list(&Displacements::none(self.cloud.len()))?;
        }
        let mut rest = duration / method.units.time();
        let mut motion = self.kick(Times::NONE);
        let mut longest = method.first_step(motion.most_accelerated());
        while rest > 0.0 && self.cloud.len() > 0 {
            let stable = method.stable_step(motion.fastest(), motion.most_accelerated());
            let stable = stable.min(longest);
            if !stable.is_finite() || stable <= 0.0 {
                return Err(self.not_finite("velocity"));
            }
            // Equal steps to the end, so that none is tiny.
            let steps = (rest / stable).ceil();
            allowance.foresee(steps, STEPS, self.work())?;
            let dt = rest / steps;
            let turn = method.turn(dt).min(steps);
            motion = self.round(dt, turn, steps, allowance)?;
            longest = method.next_step(dt);
            rest = if turn == steps { 0.0 } else { rest - turn * dt };
        }
        self.push_wall(&motion.pushed);
        self.push_wall_by_stopped();
        Ok(())
    }

    /// Computes order and accelerations of particles at their positions, for a start.
    pub fn prime(&mut self) -> Result<(), Failure> {
        self.sort();
        self.list(&Displacements::none(self.cloud.len()))?;
        self.accelerate(Times::NONE);
        self.apply_tension();
        Ok(())
    }

    /// Advances by several steps without surface tension, the first of some remaining ones;
    /// impulses of half their duration act at both ends.
    fn round(
        &mut self,
        dt: f64,
        turn: f64,
        steps: f64,
        allowance: &Allowance,
    ) -> Result<Motion, Failure> {
        let impulse = 0.5 * turn * dt;
        let mut left = turn;
        let mut motion = None;
        while left > 0.0 {
            allowance.spend(1.0, STEPS, self.work())?;
            let begins = (left == turn).then_some(impulse);
            let ends = (left == 1.0).then_some(impulse);
            motion = Some(self.step(dt, steps - (turn - left), [begins, ends])?);
            left -= 1.0;
        }
        Ok(motion.expect("a round has a step"))
    }

    /// Advances by one step with surface tension at its ends, the first of some remaining ones.
    fn step(
        &mut self,
        dt: f64,
        steps: f64,
        [begins, ends]: [Option<f64>; 2],
    ) -> Result<Motion, Failure> {
        let motion = self.begin(dt, begins)?;
        let speed = motion.root_mean_square_speed(self.cloud.len(), self.method.even);
        self.ledger.way += dt * speed;
        if self.ledger.way > SHIFT_WAY {
            self.shift()?;
        }
        let mut displacements = Displacements { of_blocks: motion.velocities, steps };
        if self.needs_sorting() {
            self.sort();
            displacements = Displacements::along(&self.cloud.velocity, steps, self.team);
        }
        self.list(&displacements.times(dt))?;
        self.find_exposed();
        self.drift_to_middle(dt);
        self.change_density_and_heat(dt);
        if let Some(cooling) = &self.method.cooling {
            let time = self.ledger.time;
            let air = self.air.mean([time, time + dt * self.method.units.time()]);
            cooling.act(self.method, self.cloud, self.ledger, (dt, air));
        }
        self.frozen.update(self.method, self.cloud);
        let times = match self.method.implicit {
            true => Times::NONE,
            false => Times { dt: 0.5 * dt, tension: ends },
        };
        self.accelerate(times);
        if ends.is_some() {
            self.apply_tension();
        }
        let motion = self.kick(times);
        self.ledger.time += dt * self.method.units.time();
        self.ledger.steps += 1.0;
        if !motion.sound {
            self.check()?;
        }
        Ok(motion)
    }

    /// Changes velocities before the particles move: by half of the step's accelerations, or, with
    /// implicit viscosity, by all of them, because viscosity responds to all.
    fn begin(&mut self, dt: f64, impulse: Option<f64>) -> Result<Motion, Failure> {
        if !self.method.implicit {
            let motion = self.kick(Times { dt: 0.5 * dt, tension: impulse });
            self.push_wall(&motion.pushed);
            return Ok(motion);
        }
        let before = match self.method.solves_pressure {
            true => self.cloud.velocity.clone(),
            false => Vec::new(),
        };
        let motion = self.kick(Times { dt, tension: impulse.map(|half| 2.0 * half) });
        self.push_wall(&motion.pushed);
        self.apply_viscosity(dt, &before)?;
        Ok(self.kick(Times::NONE))
    }

    /// Changes velocities by viscosity over a step, and by pressure where it is solved; the velocities `before` are
    /// then a first guess of those after it.
    fn apply_viscosity(&mut self, dt: f64, before: &[[f64; 3]]) -> Result<(), Failure> {
        let (method, team) = (self.method, self.team);
        if method.fed {
            let radius = viscous::reach(method);
            self.neighbours.narrow(&self.cloud.position, &method.images, radius, team);
        }
        let blocks = &self.neighbours.blocks;
        let step = viscous::advance(method, self.cloud, &self.frozen, blocks, (dt, before), team)
            .map_err(|reason| Failure::Viscosity { reason, time: self.ledger.time })?;
        team.for_each(&mut self.cloud.velocity, |i, velocity| {
            (0..3).for_each(|a| velocity[a] += step.changes[i][a]);
        });
        if let Some(iterations) = &mut self.ledger.iterations {
            *iterations += step.iterations as f64;
        }
        if let Some(stress) = &mut self.cloud.stress {
            *stress = step.stresses;
            self.ledger.creep = Some(step.creep);
        }
        self.push_by_nozzle(step.by_nozzle.map(|force| dt * force));
        let Some(points) = &mut self.points else { return Ok(()) };
        let momentum = method.units.mass() * method.units.speed;
        for (i, pull) in step.by_wall.iter().enumerate().filter(|(_, pull)| **pull != [0.0; 3]) {
            let impulse = pull.map(|a| -momentum * self.cloud.mass[i] * dt * a);
            points.push(method.place(self.cloud.position[i]), impulse);
        }
        Ok(())
    }

    /// Moves particles to the middle of a step, and records the inputs of the rates there.
    fn drift_to_middle(&mut self, dt: f64) {
        let method = self.method;
        let count = self.cloud.len();
        let annexed = self.heats || method.needs_moments();
        let moved = self.frozen_moved(0.5 * dt);
        self.records.resize(count, [0.0; 8]);
        self.densities.resize(count, 0.0);
        self.annexes.resize(if annexed { count } else { 0 }, [0.0; 4]);
        let mut annexes = self.annexes.chunks_mut(PART);
        let noted = self.records.chunks_mut(PART).zip(self.densities.chunks_mut(PART));
        let parts = self.cloud.parts(PART).into_iter().zip(noted);
        let mut parts: Vec<_> = parts.map(|(part, noted)| (part, noted, annexes.next())).collect();
        self.team.for_each(&mut parts, |_, (part, (records, densities), annexes)| {
            drift(part, 0.5 * dt);
            for (k, record) in records.iter_mut().enumerate() {
                let ([x, y, z], [u, v, w]) = (part.position[k], part.velocity[k]);
                let density = part.density[k];
                let diffused = density + part.potential[k];
                *record = [x, y, z, u, v, w, part.mass[k] / (1.0 + density), diffused];
                densities[k] = density;
            }
            for (k, annex) in annexes.iter_mut().flat_map(|list| list.iter_mut()).enumerate() {
                let [x, y, z] = part.gradient[k];
                // First order in time, so that no temperature leaves the range of its neighbours.
                *annex = [x, y, z, method.potential(part, k)];
            }
        });
        for Moved { particle, position: [x, y, z], velocity: [u, v, w] } in &moved {
            self.records[*particle][..6].copy_from_slice(&[*x, *y, *z, *u, *v, *w]);
        }
        self.place_frozen(&moved);
    }

    /// Changes velocities by the accelerations; the reaction on the wall waits for [`Self::push_wall`].
    fn kick(&mut self, times: Times) -> Motion {
        let gravity = self.method.gravity;
        let mut motion = self.kick_particles(times);
        self.note_stopped(&motion);
        self.push_by_nozzle(motion.by_nozzle);
        if self.frozen.any_is_free() {
            motion = self.make_rigid(times, motion);
        }
        if times == Times::NONE {
            return motion;
        }
        let images = copies(self.method.mirrors);
        let momentum = self.method.units.mass() * self.method.units.speed;
        for (impulse, gravity) in self.ledger.impulse_of_gravity.iter_mut().zip(gravity) {
            *impulse += images * momentum * motion.mass * times.dt * gravity;
        }
        self.pending_kicks.push(times);
        motion
    }

    fn kick_particles(&mut self, times: Times) -> Motion {
        let (gravity, bonds) = (self.method.gravity, self.frozen.bonds());
        let kick = |part: &mut Part| kick(part, times, gravity, bonds);
        Motion::of(self.team.map_each(&mut self.cloud.parts(PART), kick))
    }

    /// Computes accelerations for velocities extrapolated over some times with the accelerations of
    /// the step before.
    fn accelerate(&mut self, times: Times) {
        if self.method.solves_pressure {
            // Pressure and viscosity act in the next step.
            return;
        }
        let method = self.method;
        let cloud = &*self.cloud;
        let frozen = &self.frozen;
        let velocity = |i: usize| match frozen.bond(i).is_rigid() {
            true => cloud.velocity[i],
            false => ahead(cloud, i, times, method.gravity),
        };
        let mut records = std::mem::take(&mut self.records);
        fill(&mut records, cloud.len(), self.team, |i| {
            record(cloud, i, velocity(i), pressure(cloud.density[i]))
        });
        let factors = self.viscous_factors();
        let memory = std::mem::take(&mut self.accelerations);
        let acceleration = match factors.is_empty() {
            true => self.over_pairs(&momentum::<false>(method, cloud, &records, &[]), memory),
            false => self.over_pairs(&momentum::<true>(method, cloud, &records, &factors), memory),
        };
        self.accelerations = std::mem::replace(&mut self.cloud.acceleration, acceleration);
        self.records = records;
    }

    /// Factors of viscosity of all particles in sums over pairs; empty where all are 1.
    fn viscous_factors(&self) -> Vec<[f64; 4]> {
        if self.frozen.are_none() || self.method.pair_viscosity == 0.0 {
            return Vec::new();
        }
        self.team.map(self.cloud.len(), |i| [self.frozen.bond(i).sticking(), 0.0, 0.0, 0.0])
    }

    /// Computes accelerations by surface tension.
    fn apply_tension(&mut self) {
        let method = self.method;
        let Some(setting) = &method.surface else { return };
        let (cloud, team) = (&mut *self.cloud, self.team);
        let (pulls, energy) = self.free_surface.pulls(setting, cloud, team);
        let bounded = Bounded { even: method.even, walled: method.wall.is_some() };
        cloud.tension = balanced(pulls, &cloud.mass, bounded, team);
        team.for_each(&mut cloud.potential, |i, potential| *potential = pulls[i].potential);
        let images = copies(method.mirrors);
        self.ledger.surface_energy = images * method.units.energy() * energy;
    }

    fn over_pairs<P: PairSum<Output: Clone + Default>>(
        &self,
        pass: &P,
        memory: Vec<P::Output>,
    ) -> Vec<P::Output> {
        for_all(pass, &self.neighbours.blocks, self.method.pairs(), self.team, memory)
    }

    fn check(&self) -> Result<(), Failure> {
        let time = self.ledger.time;
        for i in 0..self.cloud.len() {
            let ratio = 1.0 + self.cloud.density[i];
            let at = self.cloud.position[i].map(|x| x * self.method.units.length);
            if !at.iter().chain(&self.cloud.velocity[i]).all(|x| x.is_finite()) {
                return Err(self.not_finite("velocity"));
            }
            if self.cloud.position[i].iter().any(|x| x.abs() >= FARTHEST) {
                return Err(Failure::OutOfRange { time });
            }
            let speed = self.cloud.velocity[i].iter().map(|v| v * v).sum::<f64>().sqrt();
            if speed >= FASTEST {
                return Err(Failure::TooFast { ratio: speed, time });
            }
            if !self.cloud.temperature[i].is_finite() {
                return Err(self.not_finite("temperature"));
            }
            if !(DENSITIES[0]..DENSITIES[1]).contains(&ratio) {
                return Err(Failure::Density { ratio, at, time });
            }
        }
        Ok(())
    }

    fn not_finite(&self, quantity: &'static str) -> Failure {
        Failure::NotFinite { quantity, time: self.ledger.time }
    }
}

/// Fills a list with one value per particle.
fn fill<T: Copy + Default + Send>(
    list: &mut Vec<T>,
    count: usize,
    team: &Team,
    number: impl Fn(usize) -> T + Sync,
) {
    list.resize(count, T::default());
    team.for_each(list, |i, place| *place = number(i));
}

/// Acceleration of a particle by all forces of a kick.
fn acceleration(cloud: &Cloud, i: usize, times: Times, gravity: [f64; 3]) -> [f64; 3] {
    let ([by_fluid, by_wall], [x, y, z, of_wall]) = (cloud.acceleration[i], cloud.tension[i]);
    let pull = if times.tension.is_some() { [x, y, z + of_wall] } else { [0.0; 3] };
    [0, 1, 2].map(|a| by_fluid[a] + by_wall[a] + gravity[a] + pull[a])
}

/// Velocity of a particle extrapolated over some times with the accelerations of the step before.
fn ahead(cloud: &Cloud, i: usize, times: Times, gravity: [f64; 3]) -> [f64; 3] {
    let (v, [a, b]) = (cloud.velocity[i], cloud.acceleration[i]);
    let along = |n: usize| v[n] + times.dt * (a[n] + b[n] + gravity[n]);
    let velocity = [along(0), along(1), along(2)];
    let Some(turn) = times.tension else { return velocity };
    let [x, y, z, by_wall] = cloud.tension[i];
    [velocity[0] + turn * x, velocity[1] + turn * y, velocity[2] + turn * (z + by_wall)]
}

/// Sums of the momentum of particles.
fn momentum<'a, const FROZEN: bool>(
    method: &'a Method,
    cloud: &'a Cloud,
    records: &'a [[f64; 8]],
    annexes: &'a [[f64; 4]],
) -> Momentum<'a, FROZEN> {
    Momentum {
        images: &method.images,
        records,
        densities: &cloud.density,
        normalisation: method.normalisation,
        viscosity: method.pair_viscosity,
        annexes,
    }
}

/// Returns true if some numbers differ.
fn differ(mut numbers: impl Iterator<Item = f64>) -> bool {
    numbers.next().is_some_and(|first| numbers.any(|number| number != first))
}

fn record(cloud: &Cloud, i: usize, velocity: [f64; 3], last: f64) -> [f64; 8] {
    let ([x, y, z], [u, v, w]) = (cloud.position[i], velocity);
    [x, y, z, u, v, w, cloud.volume(i), last]
}

//! Steps in time.
//!
//! Kick, drift, kick with one evaluation of each rate: density and temperature are advanced with
//! rates at the middle of the step, velocities with accelerations at its ends, so the scheme is of
//! second order and its pressure waves are neither damped nor amplified by it (Adami, Hu & Adams
//! 2012, J. Comput. Phys. 231, 7057–7075, doi 10.1016/j.jcp.2012.05.005).

use std::f64::consts::PI;

use super::cloud::{Cloud, Ledger, Part};
use super::continuity::{Continuity, ContinuityRates};
use super::deposit::deposit;
use super::failure::Failure;
use super::images::{Images, copies};
use super::kick::{DENSITIES, Motion, kick};
use super::loops::{PART, PairSum, Precision, for_all, for_parts};
use super::moment::{filled, least_eigenvalue, renormalised};
use super::momentum::{Accelerations, Momentum};
use super::neighbours::Neighbours;
use super::plan::DropletPlan;
use super::shifting::{Crowding, displacement};
use super::tension::{Surface, SurfaceEnergy, SurfaceSums};
use super::thin_layer::ThinLayer;
use super::units::{Units, pressure};
use super::wall::WallCells;
use super::wetting;
use crate::kernel::Kernel;
use crate::math::parallel;

/// Numbers of the method that a plan fixes, without dimension.
pub struct Method {
    pub units: Units,
    dimension: usize,
    kernel: Kernel,
    precision: Precision,
    normalisation: f64,
    mirrors: [bool; 2],
    pub images: Images,
    viscosity: f64,
    conduction: f64,
    diffusion: f64,
    /// Whether density diffusion is corrected by renormalised gradients.
    corrects: bool,
    /// Surface tension over ρ₀c₀²H, and the energy that makes it.
    tension: f64,
    surface: SurfaceEnergy,
    /// Cosine of the contact angle.
    wetting: f64,
    gravity: [f64; 3],
    /// c₀²/c of the fluid [K], to turn energy of a unit of mass into temperature.
    pub heat_unit: f64,
    spacing: f64,
    shifts: bool,
    wall: Option<WallCells>,
    thin_layer: Option<ThinLayer>,
    threads: usize,
}

/// Everything of a run between two communication points.
pub struct Stepper<'a> {
    method: &'a Method,
    cloud: &'a mut Cloud,
    ledger: &'a mut Ledger,
    neighbours: Neighbours,
    /// Temperature of each wall cell above the reference.
    wall_temperature: &'a [f64],
    /// Whether heat is conducted: not where all temperatures are the same.
    heats: bool,
    /// What the loops over pairs read and give, in memory that is kept for the next ones.
    records: Vec<[f64; 8]>,
    annexes: Vec<[f64; 4]>,
    accelerations: Vec<[[f64; 3]; 2]>,
    /// What the surface's energy was last made of.
    surface: Vec<SurfaceSums>,
}

/// Share of H/c₀ that a step may take.
const COURANT: f64 = 0.2;
/// Shares of H²/ν, √(H/a) and of the shortest capillary wave's period.
const DIFFUSIVE: f64 = 0.02;
const FORCED: f64 = 0.18;
const CAPILLARY: f64 = 0.25;
/// Way at the mean speed over H after which particles are moved from crowded places.
const SHIFT_WAY: f64 = 0.05;

impl Method {
    pub fn of(plan: &DropletPlan, threads: usize) -> Self {
        let units = Units::of(plan);
        let fluid = &plan.fluid;
        let (h, c) = (units.length, units.speed);
        let normalisation = plan.kernel.scale(1.0, plan.dimension);
        let tension = fluid.surface_tension / (units.density * c * c * h);
        let gravity = plan.gravity.map(|g| g * h / (c * c));
        Self {
            units,
            dimension: plan.dimension,
            kernel: plan.kernel,
            precision: plan.precision,
            normalisation,
            mirrors: plan.mirrors,
            images: Images::of(plan, h, gravity),
            viscosity: fluid.viscosity / (units.density * c * h),
            conduction: fluid.conductivity / (units.density * fluid.specific_heat * c * h),
            diffusion: plan.density_diffusion,
            corrects: plan.corrected_diffusion && plan.density_diffusion > 0.0,
            tension,
            surface: SurfaceEnergy::of(tension, plan.kernel, 1.0 / plan.support, plan.dimension),
            wetting: plan.wall.as_ref().map_or(0.0, |wall| wall.contact_angle.cos()),
            gravity,
            heat_unit: c * c / fluid.specific_heat,
            spacing: 1.0 / plan.support,
            shifts: plan.shifting,
            wall: plan.wall.as_ref().map(|wall| wall.cells.clone()),
            thin_layer: ThinLayer::of(plan, &units),
            threads,
        }
    }

    /// Changes density and temperature of the k-th particle of a part at its rates.
    fn change<const MOMENTS: bool>(
        &self,
        part: &mut Part,
        k: usize,
        rate: &ContinuityRates,
        dt: f64,
    ) {
        if MOMENTS {
            let moment = filled(rate.moment, self.dimension);
            part.moment[k] = moment;
            if self.corrects {
                part.gradient[k] = renormalised(&moment, rate.gradient);
            }
        }
        part.density[k] += dt * rate.density;
        part.heating[k] = rate.temperature[0] + rate.temperature[1];
        part.temperature[k] += dt * part.heating[k];
    }

    /// Largest stable step, over H/c₀.
    pub fn stable_step(&self, fastest: f64, most_accelerated: f64) -> f64 {
        [
            COURANT / (1.0 + fastest),
            DIFFUSIVE / self.viscosity.max(self.conduction),
            FORCED / most_accelerated.sqrt(),
            CAPILLARY * (self.spacing.powi(3) / (2.0 * PI * self.tension)).sqrt(),
        ]
        .into_iter()
        .fold(f64::INFINITY, f64::min)
    }
}

impl<'a> Stepper<'a> {
    /// Sorts the particles and lists their neighbours.
    pub fn new(
        method: &'a Method,
        cloud: &'a mut Cloud,
        ledger: &'a mut Ledger,
        wall_temperature: &'a [f64],
    ) -> Self {
        let temperatures = cloud.temperature.iter().chain(wall_temperature);
        let heats = method.conduction > 0.0 && differ(temperatures.copied());
        let mut stepper = Self {
            method,
            cloud,
            ledger,
            neighbours: Neighbours::default(),
            wall_temperature,
            heats,
            records: Vec::new(),
            annexes: Vec::new(),
            accelerations: Vec::new(),
            surface: Vec::new(),
        };
        stepper.sort();
        stepper
    }

    fn sort(&mut self) {
        self.cloud.position.iter_mut().for_each(|x| self.method.images.wrap(x));
        let (order, tree) = Neighbours::order(&self.cloud.position, self.method.threads);
        self.cloud.permute(&order, self.method.threads);
        self.neighbours = Neighbours::of_ordered(tree, self.cloud.len());
    }

    /// Lists neighbours for ways that the particles are about to go: these vectors times `factor`.
    fn list(&mut self, ways: &[[f64; 3]], factor: f64) {
        let Method { images, threads, .. } = self.method;
        self.neighbours.prepare(&self.cloud.position, ways, factor, images, *threads);
    }

    /// Advances by `duration` [s].
    pub fn advance(&mut self, duration: f64) -> Result<(), Failure> {
        let method = self.method;
        let mut rest = duration / method.units.time();
        let mut motion = self.kick(0.0);
        while rest > 0.0 && self.cloud.len() > 0 {
            let stable = method.stable_step(motion.fastest(), motion.most_accelerated());
            if !stable.is_finite() || stable <= 0.0 {
                return Err(self.not_finite("velocity"));
            }
            // Equal steps to the end, so that none is tiny.
            let dt = rest / (rest / stable).ceil();
            motion = self.step(dt)?;
            rest = if dt == rest { 0.0 } else { rest - dt };
            self.ledger.steps += 1.0;
        }
        self.note_surface_energy();
        Ok(())
    }

    /// Accelerations of particles that stand where they are, for a start.
    pub fn prime(&mut self) {
        self.list(&vec![[0.0; 3]; self.cloud.len()], 1.0);
        self.accelerate(0.0);
        self.note_surface_energy();
    }

    fn step(&mut self, dt: f64) -> Result<Motion, Failure> {
        let motion = self.kick(0.5 * dt);
        let speed = motion.root_mean_square_speed(self.cloud.len(), self.method.mirrors);
        self.ledger.way += dt * speed;
        if self.ledger.way > SHIFT_WAY {
            self.shift();
        }
        let astray = self.method.images.are_astray(&self.cloud.position);
        if astray || self.neighbours.are_scattered() {
            self.sort();
        }
        let velocity = std::mem::take(&mut self.cloud.velocity);
        self.list(&velocity, dt);
        self.cloud.velocity = velocity;
        self.drift(0.5 * dt);
        self.change_density_and_heat(dt);
        self.drift(0.5 * dt);
        self.rebound();
        self.accelerate(0.5 * dt);
        let motion = self.kick(0.5 * dt);
        self.ledger.time += dt * self.method.units.time();
        if !motion.sound {
            self.check()?;
        }
        Ok(motion)
    }

    fn drift(&mut self, dt: f64) {
        parallel::for_each(self.method.threads, &mut self.cloud.parts(PART), |_, part| {
            for (x, v) in part.position.iter_mut().zip(&*part.velocity) {
                (0..3).for_each(|a| x[a] += dt * v[a]);
            }
        });
    }

    /// Velocity of a particle after `dt` under the accelerations of the step before.
    fn ahead(&self, i: usize, dt: f64) -> [f64; 3] {
        let (v, [a, b]) = (self.cloud.velocity[i], self.cloud.acceleration[i]);
        [0, 1, 2].map(|n| v[n] + dt * (a[n] + b[n] + self.method.gravity[n]))
    }

    /// Changes velocities by the accelerations, and gives the wall's part to the wall.
    fn kick(&mut self, dt: f64) -> Motion {
        let Method { gravity, threads, .. } = *self.method;
        let kick = |part: &mut Part| kick(part, dt, gravity);
        let mut motion = Motion::of(parallel::map_each(threads, &mut self.cloud.parts(PART), kick));
        if dt == 0.0 {
            return motion;
        }
        let images = copies(self.method.mirrors);
        let momentum = self.method.units.mass() * self.method.units.speed;
        for (impulse, gravity) in self.ledger.impulse_of_gravity.iter_mut().zip(gravity) {
            *impulse += images * momentum * motion.mass * dt * gravity;
        }
        for i in std::mem::take(&mut motion.pushed) {
            let by_wall = self.cloud.acceleration[i][1];
            self.give(i, 0.0, by_wall.map(|a| -momentum * self.cloud.mass[i] * dt * a));
        }
        motion
    }

    /// Gives heat [J] and impulse [N s] of a particle and of its images at mirrors to the wall below.
    fn give(&mut self, i: usize, heat: f64, impulse: [f64; 3]) {
        let Some(cells) = &self.method.wall else { return };
        let [x, y] = self.place(i);
        if cells.are_radial() {
            // All images are equally far out, and push alike along their radius.
            return deposit(cells, self.ledger, [x, y], heat, impulse, self.method.mirrors);
        }
        let sides = |mirrored: bool| if mirrored { &[1.0, -1.0][..] } else { &[1.0][..] };
        for &right in sides(self.method.mirrors[0]) {
            for &back in sides(self.method.mirrors[1]) {
                let impulse = [right * impulse[0], back * impulse[1], impulse[2]];
                deposit(cells, self.ledger, [right * x, back * y], heat, impulse, [false; 2]);
            }
        }
    }

    /// Where the wall is that a particle is above [m].
    fn place(&self, i: usize) -> [f64; 2] {
        let mut at = self.cloud.position[i];
        self.method.images.wrap(&mut at);
        [at[0], at[1]].map(|x| x * self.method.units.length)
    }

    fn change_density_and_heat(&mut self, dt: f64) {
        let moments = self.method.corrects || self.method.shifts;
        match (self.heats, moments) {
            (false, false) => self.change_density::<false, false>(dt),
            (false, true) => self.change_density::<false, true>(dt),
            (true, false) => self.change_density::<true, false>(dt),
            (true, true) => self.change_density::<true, true>(dt),
        }
    }

    fn change_density<const HEAT: bool, const MOMENTS: bool>(&mut self, dt: f64) {
        let method = self.method;
        let cloud = &*self.cloud;
        let mut records = std::mem::take(&mut self.records);
        fill(&mut records, cloud.len(), method.threads, |i| {
            record(cloud, i, cloud.velocity[i], cloud.density[i])
        });
        let annex = |i: usize| {
            let [x, y, z] = cloud.gradient[i];
            [x, y, z, cloud.temperature[i] + 0.5 * dt * cloud.heating[i]]
        };
        let mut annexes = std::mem::take(&mut self.annexes);
        let mut wall_temperature = Vec::new();
        if HEAT || MOMENTS {
            fill(&mut annexes, cloud.len(), method.threads, annex);
        }
        if HEAT {
            fill(&mut wall_temperature, cloud.len(), method.threads, |i| self.wall_below(i));
        }
        let exchange = self.ledger.exchange.duration;
        let thin_layer = method.thin_layer.map(|layer| layer.between_exchanges(exchange));
        let pass = Continuity::<HEAT, MOMENTS> {
            images: &method.images,
            records: &records,
            annexes: &annexes,
            wall_temperature: &wall_temperature,
            normalisation: method.normalisation,
            diffusion: method.diffusion,
            conduction: method.conduction,
        };
        let parts = self.cloud.parts(PART);
        let mut parts: Vec<_> = parts.into_iter().map(|part| (part, Vec::new())).collect();
        for_parts(
            &pass,
            &self.neighbours.blocks,
            (method.kernel, method.precision, method.threads),
            &mut parts,
            |(part, heated), rates| {
                for (k, mut rate) in rates.into_iter().enumerate() {
                    if HEAT && let Some(layer) = &thin_layer {
                        let (height, temperature) = (part.position[k][2], part.temperature[k]);
                        let wall = wall_temperature[part.first + k];
                        rate.temperature[1] += layer.heating(height, temperature, wall, dt);
                    }
                    method.change::<MOMENTS>(part, k, &rate, dt);
                    if HEAT && rate.temperature[1] != 0.0 {
                        heated.push((part.first + k, rate.temperature[1]));
                    }
                }
            },
        );
        let heated: Vec<_> = parts.into_iter().flat_map(|(_, heated)| heated).collect();
        let heat = method.units.energy() / method.heat_unit;
        for (i, by_wall) in heated {
            self.give(i, -heat * self.cloud.mass[i] * dt * by_wall, [0.0; 3]);
        }
        (self.records, self.annexes) = (records, annexes);
    }

    /// Temperature of the wall below a particle; the particle's own where it has no wall near.
    fn wall_below(&self, i: usize) -> f64 {
        match &self.method.wall {
            Some(cells) if self.cloud.position[i][2] < 1.0 => {
                let [x, y] = self.place(i);
                let share = cells.share(x, y);
                share.cells.iter().map(|&(cell, weight)| weight * self.wall_temperature[cell]).sum()
            }
            _ => self.cloud.temperature[i],
        }
    }

    /// Accelerations for the velocities after `dt` under those of the step before.
    fn accelerate(&mut self, dt: f64) {
        let method = self.method;
        let cloud = &*self.cloud;
        let mut records = std::mem::take(&mut self.records);
        fill(&mut records, cloud.len(), method.threads, |i| {
            record(cloud, i, self.ahead(i, dt), pressure(cloud.density[i]))
        });
        let mut acceleration = std::mem::take(&mut self.accelerations);
        if method.tension > 0.0 {
            let memory = std::mem::take(&mut self.surface);
            let surface = self.surface(&records, memory);
            let mut slopes = std::mem::take(&mut self.annexes);
            fill(&mut slopes, surface.len(), method.threads, |i| surface[i].slopes);
            let pass = self.momentum::<true>(&records, &slopes);
            acceleration = self.over_pairs(&pass, acceleration);
            self.wet(&mut acceleration);
            (self.surface, self.annexes) = (surface, slopes);
        } else {
            let pass = self.momentum::<false>(&records, &[]);
            acceleration = self.over_pairs(&pass, acceleration);
        }
        self.accelerations = std::mem::replace(&mut self.cloud.acceleration, acceleration);
        self.records = records;
    }

    fn momentum<'b, const TENSE: bool>(
        &'b self,
        records: &'b [[f64; 8]],
        slopes: &'b [[f64; 4]],
    ) -> Momentum<'b, TENSE> {
        Momentum {
            images: &self.method.images,
            records,
            slopes,
            densities: &self.cloud.density,
            normalisation: self.method.normalisation,
            viscosity: self.method.viscosity,
            surface: self.method.surface,
        }
    }

    fn over_pairs<P: PairSum<Output: Clone + Default>>(
        &self,
        pass: &P,
        memory: Vec<P::Output>,
    ) -> Vec<P::Output> {
        let Method { kernel, precision, threads, .. } = *self.method;
        for_all(pass, &self.neighbours.blocks, kernel, precision, threads, memory)
    }

    fn surface(&self, records: &[[f64; 8]], memory: Vec<SurfaceSums>) -> Vec<SurfaceSums> {
        let pass = Surface {
            images: &self.method.images,
            records,
            normalisation: self.method.normalisation,
            energy: self.method.surface,
        };
        self.over_pairs(&pass, memory)
    }

    /// Notes the energy of all free and wetted surface where particles stand now, images at mirrors
    /// included [J].
    fn note_surface_energy(&mut self) {
        if self.surface.is_empty() {
            return; // There is no tension, or nothing has moved.
        }
        let method = self.method;
        let wets = method.wall.is_some();
        let of_particle = |(i, sums): (usize, &SurfaceSums)| {
            let height = self.cloud.position[i][2];
            let wall =
                if wets { wetting::energy(method.tension, method.wetting, height) } else { 0.0 };
            self.cloud.volume(i) * (sums.energy + wall)
        };
        let sum: f64 = self.surface.iter().enumerate().map(of_particle).sum();
        self.ledger.surface_energy = copies(method.mirrors) * method.units.energy() * sum;
    }

    /// Adds the wall's pull.
    fn wet(&self, acceleration: &mut [Accelerations]) {
        let method = self.method;
        if method.wall.is_none() || method.wetting == 0.0 {
            return;
        }
        for (i, [_, by_wall]) in acceleration.iter_mut().enumerate() {
            let (height, density) = (self.cloud.position[i][2], self.cloud.density[i]);
            if height < 1.0 {
                by_wall[2] += wetting::pull(method.tension, method.wetting, height, density);
            }
        }
    }

    /// A particle that meets its image at a plane exchanges its place with it: exactly what two mirror
    /// images do that pass through each other.
    fn rebound(&mut self) {
        let momentum = self.method.units.mass() * self.method.units.speed;
        for i in 0..self.cloud.len() {
            let below = self.cloud.position[i][2] < 0.0;
            let signs = self.method.images.put_back(&mut self.cloud.position[i]);
            (0..3).for_each(|a| self.cloud.velocity[i][a] *= signs[a]);
            // Without a wall there is nothing that gets it.
            if below && signs[2] < 0.0 {
                let impulse = -2.0 * momentum * self.cloud.mass[i] * self.cloud.velocity[i][2];
                self.give(i, 0.0, [0.0, 0.0, impulse]);
            }
        }
    }

    /// Moves particles from crowded places to empty ones.
    fn shift(&mut self) {
        let way = std::mem::take(&mut self.ledger.way);
        if !self.method.shifts {
            return;
        }
        let fullness: Vec<f64> = self.cloud.moment.iter().map(least_eigenvalue).collect();
        // After sorting there are no lists yet.
        self.list(&vec![[0.0; 3]; self.cloud.len()], 1.0);
        let method = self.method;
        let cloud = &*self.cloud;
        let records: Vec<[f64; 8]> =
            (0..cloud.len()).map(|i| record(cloud, i, [0.0; 3], fullness[i])).collect();
        let value = |q: f64| method.kernel.value(q, 1.0, method.dimension) / method.normalisation;
        let pass = Crowding {
            images: &method.images,
            records: &records,
            normalisation: method.normalisation,
            reference: 1.0 / value(method.spacing),
        };
        let sums = self.over_pairs(&pass, Vec::new());
        let shifts: Vec<[f64; 3]> = sums
            .iter()
            .zip(&fullness)
            .map(|(sums, &fullness)| displacement(sums, fullness, way))
            .collect();
        self.list(&shifts, 1.0);
        for (x, shift) in self.cloud.position.iter_mut().zip(&shifts) {
            (0..3).for_each(|a| x[a] += shift[a]);
            method.images.put_back(x);
        }
    }

    fn check(&self) -> Result<(), Failure> {
        let time = self.ledger.time;
        for i in 0..self.cloud.len() {
            let ratio = 1.0 + self.cloud.density[i];
            let at = self.cloud.position[i].map(|x| x * self.method.units.length);
            if !at.iter().chain(&self.cloud.velocity[i]).all(|x| x.is_finite()) {
                return Err(self.not_finite("velocity"));
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

/// Fills a list with a number for every particle.
fn fill<T: Copy + Default + Send>(
    list: &mut Vec<T>,
    count: usize,
    threads: usize,
    number: impl Fn(usize) -> T + Sync,
) {
    list.resize(count, T::default());
    let mut parts: Vec<&mut [T]> = list.chunks_mut(PART).collect();
    parallel::for_each(threads, &mut parts, |p, part| {
        part.iter_mut().enumerate().for_each(|(k, place)| *place = number(p * PART + k));
    });
}

/// Whether some numbers are not all the same.
fn differ(mut numbers: impl Iterator<Item = f64>) -> bool {
    numbers.next().is_some_and(|first| numbers.any(|number| number != first))
}

fn record(cloud: &Cloud, i: usize, velocity: [f64; 3], last: f64) -> [f64; 8] {
    let ([x, y, z], [u, v, w]) = (cloud.position[i], velocity);
    [x, y, z, u, v, w, cloud.volume(i), last]
}

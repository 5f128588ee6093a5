//! The particles of a model and its ledger: all variables of state, and their layout in a flat
//! vector.

use std::slice::from_mut;

use super::feed::{FREE, Fed};
use super::phases::Phases;
use super::requests::Requests;
use crate::port::SurfaceMemory;
use crate::port::WallExchange;
use crate::runtime::parallel::Team;
use crate::state::{Field, Fields, Layout, Per, load, store};

/// Unknowns of a particle: position, velocity, density and temperature. Everything else follows
/// from them within a step.
pub const UNKNOWNS: usize = 8;

/// Particles: each list has one entry per particle. Lengths over H, velocities over c₀, masses over
/// ρ₀H^d.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    pub position: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub mass: Vec<f64>,
    /// ρ/ρ₀ − 1.
    pub density: Vec<f64>,
    /// Temperature above the model's reference [K].
    pub temperature: Vec<f64>,
    /// Temperature at the release, above the reference [K].
    pub initial: Vec<f64>,
    /// Accelerations by fluid and by the wall, without surface tension.
    pub acceleration: Vec<[[f64; 3]; 2]>,
    /// Accelerations by surface tension: by fluid along x, y, z and by the wall along z.
    pub tension: Vec<[f64; 4]>,
    /// Surface tension's φ over ρ₀c₀², see [`Pull`](super::pulls::Pull).
    pub potential: Vec<f64>,
    /// Renormalised gradient of the density and the potential.
    pub gradient: Vec<[f64; 3]>,
    /// Moment matrices of the last step: xx, yy, zz, xy, yz, xz.
    pub moment: Vec<[f64; 6]>,
    /// Viscous stresses of the last step over ρ₀c₀², see [`viscous`](super::viscous); `None` for Newtonian fluids.
    pub stress: Option<Vec<[f64; 6]>>,
    /// Heat contents, see [`Phases`](super::phases::Phases); `None` for fluids that stay liquid, whose contents are
    /// their temperatures.
    pub content: Option<Vec<f64>>,
    /// Area of free surface of each particle over H², see [`exposure`](super::exposure); `None` where no heat passes to
    /// the air.
    pub exposed: Option<Vec<f64>>,
    /// Origin of each particle of a fluid that comes from a nozzle.
    pub origin: Option<Origin>,
}

/// Origin of the particles that come from a nozzle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Origin {
    /// Number of the layer in the order of their coming.
    pub layer: Vec<f64>,
    /// Number of the hold on the particle, see [`feed`](super::feed).
    pub hold: Vec<f64>,
}

/// Consecutive particles from number `first` on, which one thread may change; the fields are those
/// of [`Cloud`].
pub struct Part<'a> {
    pub first: usize,
    pub position: &'a mut [[f64; 3]],
    pub velocity: &'a mut [[f64; 3]],
    pub mass: &'a [f64],
    pub density: &'a mut [f64],
    pub temperature: &'a mut [f64],
    pub content: Option<&'a mut [f64]>,
    pub initial: &'a [f64],
    pub acceleration: &'a [[[f64; 3]; 2]],
    pub tension: &'a [[f64; 4]],
    pub potential: &'a [f64],
    pub gradient: &'a mut [[f64; 3]],
    pub moment: &'a mut [[f64; 6]],
}

/// Integrals over time and counters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// Time [s].
    pub time: f64,
    /// Number of drops, or of layers in a nozzle, released so far.
    pub released: f64,
    /// Number of time steps.
    pub steps: f64,
    /// Heat released with the droplets, above the reference [J].
    pub heat_released: f64,
    /// Heat [J] and impulse [N s] transferred to the wall since time zero.
    pub heat_to_wall: f64,
    pub impulse_to_wall: [f64; 3],
    /// Impulse of gravity and of mirrors since time zero [N s].
    pub impulse_of_gravity: [f64; 3],
    /// Mean path length of the particles over H since they were last shifted.
    pub way: f64,
    /// Energy of free and wetted surface [J].
    pub surface_energy: f64,
    /// Volume within reach of the blocks of particles, summed over blocks, when the particles were
    /// last sorted, over H^d.
    pub surrounded: f64,
    /// Heat and impulse that the wall received during the last step.
    pub exchange: WallExchange,
    /// Memory of the solid below, see [`SurfaceMemory`]; `None` for a wall of prescribed
    /// temperature.
    pub memory: SurfaceMemory,
    /// State of drops on demand.
    pub requests: Option<Requests>,
    /// Largest shear rate of fluid that does not yield, in the last time step, over c₀/H; `None` for Newtonian fluids.
    pub creep: Option<f64>,
    /// Time since which all fluid on the wall is frozen [s], 0 while some is not; `None` for fluids that stay liquid.
    pub arrest: Option<f64>,
    /// Iterations of pressure and viscosity so far; `None` where pressure is not solved.
    pub iterations: Option<f64>,
    /// Heat given to the air [J]; `None` where none passes.
    pub heat_to_air: Option<f64>,
    /// State of a nozzle.
    pub fed: Option<Fed>,
}

/// Dimensions of the part of a state that precedes its particles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeadNumbers {
    /// Cells of the wall.
    pub cells: usize,
    /// Number of exponentials in each cell's [`SurfaceMemory`].
    pub exponentials: usize,
    /// Largest number of drops that may be requested; `None` without drops on demand.
    pub most: Option<usize>,
    /// True if the particles have viscous stresses.
    pub stressed: bool,
    /// True if the particles have heat contents.
    pub freezes: bool,
    /// True if pressure is solved at the end of each step.
    pub solves_pressure: bool,
    /// True if heat passes to the air.
    pub cools: bool,
    /// True if fluid comes from a nozzle.
    pub fed: bool,
}

/// Numbers that a thread copies as one piece of work.
const COPY: usize = 4096;

impl Fields for Ledger {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let WallExchange { duration, heat, impulse, heat_outside, impulse_outside } =
            &mut self.exchange;
        let count = self.memory.given.len() / heat.len().max(1);
        let body = |name, words, width| Field { name, words, per: Per::Body, width };
        let cell = |name, words, width| Field { name, words, per: Per::Cell, width };
        let mut fields = vec![
            (body("time", "time since the start [s]", 1), from_mut(&mut self.time)),
            (body("released", "drops released so far", 1), from_mut(&mut self.released)),
            (body("steps", "time steps made", 1), from_mut(&mut self.steps)),
            (
                body("heat_released", "heat released with drops, above the reference [J]", 1),
                from_mut(&mut self.heat_released),
            ),
            (
                body("heat_to_wall", "heat given to the wall [J]", 1),
                from_mut(&mut self.heat_to_wall),
            ),
            (
                body("impulse_to_wall", "impulse given to the wall [N s]", 3),
                &mut self.impulse_to_wall,
            ),
            (
                body("impulse_of_gravity", "impulse of gravity and of mirrors [N s]", 3),
                &mut self.impulse_of_gravity,
            ),
            (body("duration", "length of the last step [s]", 1), from_mut(duration)),
            (
                body("heat_outside", "heat transferred beyond the cells in the last step [J]", 1),
                from_mut(heat_outside),
            ),
            (
                body(
                    "impulse_outside",
                    "impulse transferred beyond the cells in the last step [N s]",
                    3,
                ),
                impulse_outside,
            ),
            (
                body("way", "mean path of particles since they were shifted, over H", 1),
                from_mut(&mut self.way),
            ),
            (
                body("surface_energy", "energy of free and wetted surface [J]", 1),
                from_mut(&mut self.surface_energy),
            ),
            (
                body("surrounded", "volume within reach of the blocks of particles, over H^d", 1),
                from_mut(&mut self.surrounded),
            ),
            (cell("heat", "heat given in the last step [J]", 1), heat),
            (
                cell("impulse", "impulse given in the last step [N s]", 3),
                impulse.as_flattened_mut(),
            ),
            (
                cell("given", "rise of the solid below due to the varying flux [K]", count),
                &mut self.memory.given,
            ),
            (
                cell(
                    "reported",
                    "rise of the solid below due to the reported mean flux [K]",
                    count,
                ),
                &mut self.memory.reported,
            ),
        ];
        fields.extend(self.requests.iter_mut().flat_map(Requests::fields));
        let creep = body("creep", "largest shear rate of fluid that does not yield, over c/H", 1);
        fields.extend(self.creep.iter_mut().map(|rate| (creep, from_mut(rate))));
        let arrest = body("arrest", "time since which all fluid on the wall is frozen [s]", 1);
        fields.extend(self.arrest.iter_mut().map(|time| (arrest, from_mut(time))));
        let iterations = body("iterations", "iterations of pressure and viscosity so far", 1);
        fields.extend(self.iterations.iter_mut().map(|count| (iterations, from_mut(count))));
        let to_air = body("heat_to_air", "heat given to the air [J]", 1);
        fields.extend(self.heat_to_air.iter_mut().map(|heat| (to_air, from_mut(heat))));
        fields.extend(self.fed.iter_mut().flat_map(Fed::fields));
        fields
    }
}

impl Fields for Cloud {
    fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        let of = |name, words, width| Field { name, words, per: Per::Particle, width };
        let mut fields = vec![
            (of("position", "place over H", 3), self.position.as_flattened_mut()),
            (of("velocity", "velocity over c", 3), self.velocity.as_flattened_mut()),
            (of("mass", "mass over ρH^d", 1), &mut self.mass),
            (of("density", "density over that at rest, less 1", 1), &mut self.density),
            (of("temperature", "temperature above the reference [K]", 1), &mut self.temperature),
            (
                of("initial", "temperature at the release above the reference [K]", 1),
                &mut self.initial,
            ),
            (
                of("acceleration", "acceleration by fluid and by the wall", 6),
                self.acceleration.as_flattened_mut().as_flattened_mut(),
            ),
            (of("tension", "acceleration by surface tension", 4), self.tension.as_flattened_mut()),
            (of("potential", "potential of surface tension over ρc²", 1), &mut self.potential),
            (of("gradient", "gradient of the density", 3), self.gradient.as_flattened_mut()),
            (of("moment", "moment matrix of the last step", 6), self.moment.as_flattened_mut()),
        ];
        let stress = of("stress", "viscous stress over ρc²", 6);
        fields.extend(self.stress.iter_mut().map(|list| (stress, list.as_flattened_mut())));
        let content =
            of("content", "heat content over the specific heat of the molten fluid [K]", 1);
        fields.extend(self.content.iter_mut().map(|list| (content, &mut list[..])));
        let exposed = of("exposed", "area of free surface over H²", 1);
        fields.extend(self.exposed.iter_mut().map(|list| (exposed, &mut list[..])));
        let layer = of("layer", "number of its layer in the nozzle", 1);
        let hold =
            of("hold", "0 for free particles, 1 for those in the nozzle, 2 for those that rest", 1);
        fields.extend(
            self.origin
                .iter_mut()
                .flat_map(|origin| [(layer, &mut origin.layer[..]), (hold, &mut origin.hold[..])]),
        );
        fields
    }
}

impl Ledger {
    /// Ledger of a droplet at time zero, of these dimensions.
    pub fn none(head: HeadNumbers) -> Self {
        let zeros = vec![0.0; head.cells * head.exponentials];
        Self {
            exchange: WallExchange::none(head.cells),
            memory: SurfaceMemory { given: zeros.clone(), reported: zeros },
            requests: head.most.map(Requests::none),
            creep: head.stressed.then_some(0.0),
            arrest: head.freezes.then_some(0.0),
            iterations: head.solves_pressure.then_some(0.0),
            heat_to_air: head.cools.then_some(0.0),
            fed: head.fed.then(Fed::default),
            ..Self::default()
        }
    }
}

/// Layout of the state of a number of particles.
pub fn layout(head: HeadNumbers, particles: usize) -> Layout {
    Layout::of(&mut Ledger::none(head)).then(Layout::of(&mut Cloud::of(head, particles)))
}

impl Cloud {
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Volume of a particle over H^d.
    #[inline]
    pub fn volume(&self, i: usize) -> f64 {
        self.mass[i] / (1.0 + self.density[i])
    }

    /// Heat contents over the specific heat of the molten fluid, above the reference [K].
    pub fn contents(&self) -> &[f64] {
        self.content.as_ref().unwrap_or(&self.temperature)
    }

    /// Changes the heat content of a particle of a fluid, which has phases if it freezes.
    pub fn heat(&mut self, i: usize, change: f64, phases: Option<&Phases>) {
        match (phases, &mut self.content) {
            (Some(phases), Some(content)) => {
                phases.heat(&mut content[i], &mut self.temperature[i], change);
            }
            _ => self.temperature[i] += change,
        }
    }

    /// Splits the particles into parts of `size`; the last one holds the rest.
    pub fn parts(&mut self, size: usize) -> Vec<Part<'_>> {
        let count = self.len();
        let mut position = self.position.chunks_mut(size);
        let mut velocity = self.velocity.chunks_mut(size);
        let mut mass = self.mass.chunks(size);
        let mut density = self.density.chunks_mut(size);
        let mut temperature = self.temperature.chunks_mut(size);
        let mut initial = self.initial.chunks(size);
        let mut acceleration = self.acceleration.chunks(size);
        let mut tension = self.tension.chunks(size);
        let mut potential = self.potential.chunks(size);
        let mut gradient = self.gradient.chunks_mut(size);
        let mut moment = self.moment.chunks_mut(size);
        let mut content = self.content.as_mut().map(|list| list.chunks_mut(size));
        let part = |first| {
            Some(Part {
                first,
                position: position.next()?,
                velocity: velocity.next()?,
                mass: mass.next()?,
                density: density.next()?,
                temperature: temperature.next()?,
                content: content.as_mut().and_then(|chunks| chunks.next()),
                initial: initial.next()?,
                acceleration: acceleration.next()?,
                tension: tension.next()?,
                potential: potential.next()?,
                gradient: gradient.next()?,
                moment: moment.next()?,
            })
        };
        (0..count).step_by(size).map_while(part).collect()
    }

    /// No particles yet.
    pub fn none(head: HeadNumbers) -> Self {
        Self::of(head, 0)
    }

    /// Appends a particle at rest density.
    pub fn push(&mut self, position: [f64; 3], velocity: [f64; 3], mass: f64, temperature: f64) {
        self.position.push(position);
        self.velocity.push(velocity);
        self.mass.push(mass);
        self.density.push(0.0);
        self.temperature.push(temperature);
        self.initial.push(temperature);
        self.acceleration.push([[0.0; 3]; 2]);
        self.tension.push([0.0; 4]);
        self.potential.push(0.0);
        self.gradient.push([0.0; 3]);
        self.moment.push([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        self.stress.iter_mut().for_each(|list| list.push([0.0; 6]));
        self.content.iter_mut().for_each(|list| list.push(temperature));
        self.exposed.iter_mut().for_each(|list| list.push(0.0));
        self.origin.iter_mut().for_each(|origin| {
            origin.layer.push(0.0);
            origin.hold.push(FREE);
        });
    }

    /// Appends the particles of another cloud.
    pub fn append(&mut self, other: Self) {
        self.position.extend(other.position);
        self.velocity.extend(other.velocity);
        self.mass.extend(other.mass);
        self.density.extend(other.density);
        self.temperature.extend(other.temperature);
        self.initial.extend(other.initial);
        self.acceleration.extend(other.acceleration);
        self.tension.extend(other.tension);
        self.potential.extend(other.potential);
        self.gradient.extend(other.gradient);
        self.moment.extend(other.moment);
        self.stress.iter_mut().for_each(|list| list.extend(other.stress.iter().flatten()));
        self.content.iter_mut().for_each(|list| list.extend(other.content.iter().flatten()));
        self.exposed.iter_mut().for_each(|list| list.extend(other.exposed.iter().flatten()));
        for (own, other) in self.origin.iter_mut().zip(other.origin) {
            own.layer.extend(other.layer);
            own.hold.extend(other.hold);
        }
    }

    /// Takes out all particles but those of some numbers, and returns the others in their order.
    pub fn keep(&mut self, kept: &[u32], others: &[u32], team: &Team) -> Self {
        let mut rest = self.clone();
        rest.permute(others, team);
        self.permute(kept, team);
        rest
    }

    /// Reorders the particles.
    pub fn permute(&mut self, order: &[u32], team: &Team) {
        let permute = Permutation { order, team };
        permute.apply(&mut self.position);
        permute.apply(&mut self.velocity);
        permute.apply(&mut self.mass);
        permute.apply(&mut self.density);
        permute.apply(&mut self.temperature);
        permute.apply(&mut self.initial);
        permute.apply(&mut self.acceleration);
        permute.apply(&mut self.tension);
        permute.apply(&mut self.potential);
        permute.apply(&mut self.gradient);
        permute.apply(&mut self.moment);
        self.stress.iter_mut().for_each(|list| permute.apply(list));
        self.content.iter_mut().for_each(|list| permute.apply(list));
        self.exposed.iter_mut().for_each(|list| permute.apply(list));
        self.origin.iter_mut().for_each(|origin| {
            permute.apply(&mut origin.layer);
            permute.apply(&mut origin.hold);
        });
    }

    /// Allocates particles whose values are not yet set.
    fn of(head: HeadNumbers, count: usize) -> Self {
        Self {
            position: vec![[0.0; 3]; count],
            velocity: vec![[0.0; 3]; count],
            mass: vec![0.0; count],
            density: vec![0.0; count],
            temperature: vec![0.0; count],
            initial: vec![0.0; count],
            acceleration: vec![[[0.0; 3]; 2]; count],
            tension: vec![[0.0; 4]; count],
            potential: vec![0.0; count],
            gradient: vec![[0.0; 3]; count],
            moment: vec![[0.0; 6]; count],
            stress: head.stressed.then(|| vec![[0.0; 6]; count]),
            content: head.freezes.then(|| vec![0.0; count]),
            exposed: head.cools.then(|| vec![0.0; count]),
            origin: head.fed.then(|| Origin { layer: vec![0.0; count], hold: vec![FREE; count] }),
        }
    }
}

/// Permutation of lists.
struct Permutation<'a> {
    order: &'a [u32],
    team: &'a Team,
}

impl Permutation<'_> {
    fn apply<T: Copy + Send + Sync>(&self, list: &mut Vec<T>) {
        let before = &*list;
        let moved = |k: usize| before[self.order[k] as usize];
        *list = self.team.map(self.order.len(), moved);
    }
}

/// Number of state entries before those of the particles.
pub fn head_len(head: HeadNumbers) -> usize {
    Layout::of(&mut Ledger::none(head)).len()
}

/// Number of particles of a state; `None` if its length fits no number.
pub fn particles_in(state: &[f64], head: HeadNumbers) -> Option<usize> {
    let rest = state.len().checked_sub(head_len(head))?;
    let numbers = Layout::of(&mut Cloud::of(head, 1)).len();
    (rest % numbers == 0).then_some(rest / numbers)
}

/// Writes ledger and particles to a flat vector.
pub fn flatten(state: &mut Vec<f64>, ledger: &mut Ledger, cloud: &mut Cloud, team: &Team) {
    state.resize(Layout::of(ledger).len() + Layout::of(cloud).len(), 0.0);
    let head = store(ledger, state);
    let mut copies = Vec::new();
    let mut rest = &mut state[head..];
    for (_, numbers) in cloud.fields() {
        let places = rest.split_off_mut(..numbers.len()).expect("the state has room");
        copies.extend(places.chunks_mut(COPY).zip(numbers.chunks(COPY)));
    }
    team.for_each(&mut copies, |_, (places, numbers)| places.copy_from_slice(numbers));
}

/// Reads the ledger of a state.
pub fn ledger_of(state: &[f64], head: HeadNumbers) -> Ledger {
    let mut ledger = Ledger::none(head);
    load(&mut ledger, state);
    ledger
}

/// Reads the particles of a state.
pub fn cloud_of(state: &[f64], head: HeadNumbers, team: &Team) -> Cloud {
    let mut cloud = Cloud::of(head, particles_in(state, head).unwrap_or(0));
    let mut rest = &state[head_len(head)..];
    let mut copies = Vec::new();
    for (_, numbers) in cloud.fields() {
        let (own, after) = rest.split_at(numbers.len());
        rest = after;
        copies.extend(numbers.chunks_mut(COPY).zip(own.chunks(COPY)));
    }
    team.for_each(&mut copies, |_, (numbers, own)| numbers.copy_from_slice(own));
    cloud
}

#[cfg(test)]
mod tests {
    use super::super::feed::BY_NOZZLE;
    use super::*;

    #[test]
    fn state_round_trip() {
        let head = HeadNumbers {
            cells: 3,
            exponentials: 2,
            most: Some(2),
            stressed: true,
            freezes: true,
            solves_pressure: true,
            cools: true,
            fed: true,
        };
        let mut cloud = Cloud::none(head);
        for i in 0..5 {
            let x = f64::from(i);
            cloud.push([x, 1.0 + x, 2.0], [3.0, 4.0, x], 0.1 * x, 300.0 + x);
            let last = cloud.len() - 1;
            cloud.density[last] = 0.01 * x;
            cloud.acceleration[last] = [[x, 1.0, 2.0], [3.0, x, 4.0]];
            cloud.tension[last] = [7.0, x, 5.0, -x];
            cloud.potential[last] = 0.125 * x;
            cloud.stress.as_mut().unwrap()[last] = [x; 6];
            cloud.content.as_mut().unwrap()[last] = 290.0 + x;
            cloud.exposed.as_mut().unwrap()[last] = 0.75 * x;
            cloud.origin.as_mut().unwrap().layer[last] = x;
            cloud.origin.as_mut().unwrap().hold[last] = BY_NOZZLE;
            cloud.gradient[last] = [0.5, x, 0.25];
            cloud.moment[last] = [x, 1.0, 2.0, 0.1, 0.2, 0.3];
        }
        let mut exchange = WallExchange::none(3);
        exchange.heat[1] = 7.0;
        exchange.impulse[2] = [1.0, 2.0, 3.0];
        exchange.duration = 0.5;
        let mut ledger = Ledger {
            time: 1.5,
            released: 2.0,
            way: 0.25,
            surface_energy: 3.5,
            surrounded: 4.5,
            impulse_to_wall: [1.0, 2.0, 3.0],
            impulse_of_gravity: [4.0, 5.0, 6.0],
            exchange,
            memory: SurfaceMemory {
                given: (0..6).map(f64::from).collect(),
                reported: (0..6).map(|n| 0.5 * f64::from(n)).collect(),
            },
            requests: Some(Requests {
                asked: 3.0,
                waiting: vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0; 6]],
            }),
            creep: Some(0.5),
            arrest: Some(0.25),
            iterations: Some(12.0),
            heat_to_air: Some(2.5),
            fed: Some(Fed { volume: 0.75, nozzle: [1.0, 2.0, 3.0], ..Fed::default() }),
            ..Ledger::default()
        };
        let team = Team::new(2);
        let mut state = vec![7.0; 3];
        flatten(&mut state, &mut ledger, &mut cloud, &team);
        assert_eq!(state.len(), layout(head, 5).len());
        assert_eq!(particles_in(&state, head), Some(5));
        assert_eq!(ledger_of(&state, head), ledger);
        assert_eq!(cloud_of(&state, head, &team), cloud);
        assert_eq!(particles_in(&state[1..], head), None);
    }
}

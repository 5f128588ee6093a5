//! The particles of a model and its ledger: all that changes, and how it lies in a flat vector.

use super::surface::SurfaceMemory;
use super::wall::WallExchange;
use crate::math::parallel::Team;

/// Particles, each list with an entry for each. Lengths over H, velocities over c₀, masses over
/// ρ₀H^d.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    pub position: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub mass: Vec<f64>,
    /// ρ/ρ₀ − 1.
    pub density: Vec<f64>,
    /// Above the model's reference [K].
    pub temperature: Vec<f64>,
    /// By fluid and by the wall, without what follows.
    pub acceleration: Vec<[[f64; 3]; 2]>,
    /// By surface tension: by fluid along x, y, z and by the wall along z.
    pub tension: Vec<[f64; 4]>,
    /// Surface tension's φ over ρ₀c₀², see [`Pull`](super::pulls::Pull).
    pub potential: Vec<f64>,
    /// Renormalised gradient of the density and the potential.
    pub gradient: Vec<[f64; 3]>,
    /// Moment matrices of the last step: xx, yy, zz, xy, yz, xz.
    pub moment: Vec<[f64; 6]>,
}

/// Consecutive particles, for one thread to change: the numbers of [`Cloud`] from `first` on.
pub struct Part<'a> {
    pub first: usize,
    pub position: &'a mut [[f64; 3]],
    pub velocity: &'a mut [[f64; 3]],
    pub mass: &'a [f64],
    pub density: &'a mut [f64],
    pub temperature: &'a mut [f64],
    pub acceleration: &'a [[[f64; 3]; 2]],
    pub tension: &'a [[f64; 4]],
    pub potential: &'a [f64],
    pub gradient: &'a mut [[f64; 3]],
    pub moment: &'a mut [[f64; 6]],
}

/// Sums over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// [s]
    pub time: f64,
    /// Droplets released so far.
    pub released: usize,
    /// Time steps made.
    pub steps: f64,
    /// Heat released with the droplets, above the reference [J].
    pub heat_released: f64,
    /// Given to the wall since time zero [J], [N s].
    pub heat_to_wall: f64,
    pub impulse_to_wall: [f64; 3],
    /// Impulse of gravity and of mirrors since time zero [N s].
    pub impulse_of_gravity: [f64; 3],
    /// Way over H that particles went on average since they were last shifted.
    pub way: f64,
    /// Of free and wetted surface [J].
    pub surface_energy: f64,
    /// Volume that surrounded the blocks of particles, each counted for itself, when the particles
    /// were last sorted, over H^d.
    pub surrounded: f64,
    /// What the wall got during the last step.
    pub exchange: WallExchange,
    /// Of the solid below, see [`SurfaceMemory`]; nothing for a wall whose temperature is held.
    pub memory: SurfaceMemory,
}

/// How many numbers of a state belong to the wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WallNumbers {
    pub cells: usize,
    /// Exponentials of each cell's [`SurfaceMemory`].
    pub exponentials: usize,
}

/// Numbers of a particle in a flat vector.
const NUMBERS: usize = 29;
/// Numbers that a thread copies at once.
const COPY: usize = 4096;
/// Numbers of the ledger before those of its cells.
const HEAD: usize = 19;

impl Cloud {
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Volume of a particle over H^d.
    #[inline]
    pub fn volume(&self, i: usize) -> f64 {
        self.mass[i] / (1.0 + self.density[i])
    }

    /// The particles in parts of `size`, the last one of the rest.
    pub fn parts(&mut self, size: usize) -> Vec<Part<'_>> {
        let count = self.len();
        let mut position = self.position.chunks_mut(size);
        let mut velocity = self.velocity.chunks_mut(size);
        let mut mass = self.mass.chunks(size);
        let mut density = self.density.chunks_mut(size);
        let mut temperature = self.temperature.chunks_mut(size);
        let mut acceleration = self.acceleration.chunks(size);
        let mut tension = self.tension.chunks(size);
        let mut potential = self.potential.chunks(size);
        let mut gradient = self.gradient.chunks_mut(size);
        let mut moment = self.moment.chunks_mut(size);
        let part = |first| {
            Some(Part {
                first,
                position: position.next()?,
                velocity: velocity.next()?,
                mass: mass.next()?,
                density: density.next()?,
                temperature: temperature.next()?,
                acceleration: acceleration.next()?,
                tension: tension.next()?,
                potential: potential.next()?,
                gradient: gradient.next()?,
                moment: moment.next()?,
            })
        };
        (0..count).step_by(size).map_while(part).collect()
    }

    /// Adds a particle at rest density.
    pub fn push(&mut self, position: [f64; 3], velocity: [f64; 3], mass: f64, temperature: f64) {
        self.position.push(position);
        self.velocity.push(velocity);
        self.mass.push(mass);
        self.density.push(0.0);
        self.temperature.push(temperature);
        self.acceleration.push([[0.0; 3]; 2]);
        self.tension.push([0.0; 4]);
        self.potential.push(0.0);
        self.gradient.push([0.0; 3]);
        self.moment.push([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    }

    /// Puts the particles into another order.
    pub fn permute(&mut self, order: &[u32], team: &Team) {
        let permute = Permutation { order, team };
        permute.apply(&mut self.position);
        permute.apply(&mut self.velocity);
        permute.apply(&mut self.mass);
        permute.apply(&mut self.density);
        permute.apply(&mut self.temperature);
        permute.apply(&mut self.acceleration);
        permute.apply(&mut self.tension);
        permute.apply(&mut self.potential);
        permute.apply(&mut self.gradient);
        permute.apply(&mut self.moment);
    }

    /// All numbers, list after list.
    fn numbers(&self) -> [&[f64]; 10] {
        [
            self.position.as_flattened(),
            self.velocity.as_flattened(),
            &self.mass,
            &self.density,
            &self.temperature,
            self.acceleration.as_flattened().as_flattened(),
            self.tension.as_flattened(),
            &self.potential,
            self.gradient.as_flattened(),
            self.moment.as_flattened(),
        ]
    }
}

/// Another order of lists.
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

/// Length of the state of a number of particles above a wall.
pub fn state_len(wall: WallNumbers, particles: usize) -> usize {
    HEAD + (4 + 2 * wall.exponentials) * wall.cells + NUMBERS * particles
}

/// Number of particles of a state; nothing if its length fits none.
pub fn particles_in(state: &[f64], wall: WallNumbers) -> Option<usize> {
    let rest = state.len().checked_sub(state_len(wall, 0))?;
    (rest % NUMBERS == 0).then_some(rest / NUMBERS)
}

/// The numbers of a ledger, with which a flat vector begins.
fn head_of(ledger: &Ledger) -> Vec<f64> {
    let exchange = &ledger.exchange;
    let memory = &ledger.memory;
    let mut head = Vec::new();
    head.extend([ledger.time, ledger.released as f64, ledger.steps]);
    head.extend([ledger.heat_released, ledger.heat_to_wall]);
    head.extend(ledger.impulse_to_wall);
    head.extend(ledger.impulse_of_gravity);
    head.extend([exchange.duration, exchange.heat_outside]);
    head.extend(exchange.impulse_outside);
    head.extend([ledger.way, ledger.surface_energy, ledger.surrounded]);
    head.extend(&exchange.heat);
    head.extend(exchange.impulse.iter().flatten());
    head.extend(&memory.given);
    head.extend(&memory.reported);
    head
}

/// Writes a ledger over that of a flat vector.
pub fn write_ledger(state: &mut [f64], ledger: &Ledger) {
    let head = head_of(ledger);
    state[..head.len()].copy_from_slice(&head);
}

/// Writes ledger and particles over a flat vector.
pub fn flatten(state: &mut Vec<f64>, ledger: &Ledger, cloud: &Cloud, team: &Team) {
    let head = head_of(ledger);
    state.resize(head.len() + NUMBERS * cloud.len(), 0.0);
    let (first, mut rest) = state.split_at_mut(head.len());
    first.copy_from_slice(&head);
    let mut copies = Vec::new();
    for numbers in cloud.numbers() {
        let places = rest.split_off_mut(..numbers.len()).expect("the state has room");
        copies.extend(places.chunks_mut(COPY).zip(numbers.chunks(COPY)));
    }
    team.for_each(&mut copies, |_, (places, numbers)| places.copy_from_slice(numbers));
}

/// Reads the ledger of a state.
pub fn ledger_of(state: &[f64], wall: WallNumbers) -> Ledger {
    let three = |at: usize| [state[at], state[at + 1], state[at + 2]];
    let cells = wall.cells;
    let (heat, impulse, given) = (HEAD, HEAD + cells, HEAD + 4 * cells);
    let reported = given + cells * wall.exponentials;
    Ledger {
        time: state[0],
        released: state[1] as usize,
        steps: state[2],
        heat_released: state[3],
        heat_to_wall: state[4],
        impulse_to_wall: three(5),
        impulse_of_gravity: three(8),
        way: state[16],
        surface_energy: state[17],
        surrounded: state[18],
        exchange: WallExchange {
            duration: state[11],
            heat_outside: state[12],
            impulse_outside: three(13),
            heat: state[heat..impulse].to_vec(),
            impulse: (0..cells).map(|cell| three(impulse + 3 * cell)).collect(),
        },
        memory: SurfaceMemory {
            given: state[given..reported].to_vec(),
            reported: state[reported..state_len(wall, 0)].to_vec(),
        },
    }
}

/// Reads the particles of a state.
pub fn cloud_of(state: &[f64], wall: WallNumbers, team: &Team) -> Cloud {
    let rest = &state[state_len(wall, 0)..];
    let mut lists = Lists { rest, count: rest.len() / NUMBERS, team };
    Cloud {
        position: lists.next(|[numbers]| numbers),
        velocity: lists.next(|[numbers]| numbers),
        mass: lists.next(|[[number]]| number),
        density: lists.next(|[[number]]| number),
        temperature: lists.next(|[[number]]| number),
        acceleration: lists.next(|both| both),
        tension: lists.next(|[numbers]| numbers),
        potential: lists.next(|[[number]]| number),
        gradient: lists.next(|[numbers]| numbers),
        moment: lists.next(|[numbers]| numbers),
    }
}

/// What is left of a state, list after list.
struct Lists<'a> {
    rest: &'a [f64],
    count: usize,
    team: &'a Team,
}

impl Lists<'_> {
    /// The next list, of B times A numbers a particle.
    fn next<const A: usize, const B: usize, T: Send>(
        &mut self,
        entry: impl Fn([[f64; A]; B]) -> T + Sync,
    ) -> Vec<T> {
        let (numbers, rest) = self.rest.split_at(self.count * A * B);
        self.rest = rest;
        let entries: &[[[f64; A]; B]] = numbers.as_chunks().0.as_chunks().0;
        self.team.map(self.count, |i| entry(entries[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_is_read_as_it_was_written() {
        let mut cloud = Cloud::default();
        for i in 0..5 {
            let x = f64::from(i);
            cloud.push([x, 1.0 + x, 2.0], [3.0, 4.0, x], 0.1 * x, 300.0 + x);
            let last = cloud.len() - 1;
            cloud.density[last] = 0.01 * x;
            cloud.acceleration[last] = [[x, 1.0, 2.0], [3.0, x, 4.0]];
            cloud.tension[last] = [7.0, x, 5.0, -x];
            cloud.potential[last] = 0.125 * x;
            cloud.gradient[last] = [0.5, x, 0.25];
            cloud.moment[last] = [x, 1.0, 2.0, 0.1, 0.2, 0.3];
        }
        let mut exchange = WallExchange::none(3);
        exchange.heat[1] = 7.0;
        exchange.impulse[2] = [1.0, 2.0, 3.0];
        exchange.duration = 0.5;
        let ledger = Ledger {
            time: 1.5,
            released: 2,
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
            ..Ledger::default()
        };
        let wall = WallNumbers { cells: 3, exponentials: 2 };
        let team = Team::new(2);
        let mut state = vec![7.0; 3];
        flatten(&mut state, &ledger, &cloud, &team);
        assert_eq!(state.len(), state_len(wall, 5));
        assert_eq!(particles_in(&state, wall), Some(5));
        assert_eq!(ledger_of(&state, wall), ledger);
        assert_eq!(cloud_of(&state, wall, &team), cloud);
        assert_eq!(particles_in(&state[1..], wall), None);
    }
}

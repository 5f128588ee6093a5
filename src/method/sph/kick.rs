//! Changes of velocity, and measures of the motion after them.

use super::cloud::Part;
use super::frozen::Bond;
use super::order::{BLOCK, Bounds};

/// Range of density over that at rest; no weakly compressible flow leaves it.
pub const DENSITIES: [f64; 2] = [0.3, 3.0];

/// Bound on coordinates over H: beyond it rounding exceeds 10⁻⁹ H, and bin numbers of grids
/// overflow.
pub const FARTHEST: f64 = 1e6;
/// Bound on the speed over that of sound: no nearly incompressible flow exceeds it.
pub const FASTEST: f64 = 100.0;

/// Measures of the motion of some particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Σ v and Σ v².
    sums: [f64; 3],
    squares: f64,
    /// Largest v² and a²; no a of rigid particles.
    fastest: f64,
    most_accelerated: f64,
    /// Σ m.
    pub mass: f64,
    /// True if all numbers are finite, no particle is too far away, and speeds and densities are
    /// those of a weakly compressible flow.
    pub sound: bool,
    /// Particles that the wall pushes, in ascending order.
    pub pushed: Vec<usize>,
    /// Particles held by the wall, in ascending order, and the velocities that they lose.
    pub stopped: Vec<(usize, [f64; 3])>,
    /// Σ m v that the nozzle gives to the particles in it.
    pub by_nozzle: [f64; 3],
    /// The box of the velocities of each block.
    pub velocities: Vec<Bounds>,
}

impl Motion {
    fn none() -> Self {
        Self {
            sums: [0.0; 3],
            squares: 0.0,
            fastest: 0.0,
            most_accelerated: 0.0,
            mass: 0.0,
            sound: true,
            pushed: Vec::new(),
            stopped: Vec::new(),
            by_nozzle: [0.0; 3],
            velocities: Vec::new(),
        }
    }

    /// Combines the motions of all parts, in their order.
    pub fn of(parts: Vec<Self>) -> Self {
        let mut all = Self::none();
        for part in parts {
            (0..3).for_each(|a| all.sums[a] += part.sums[a]);
            (0..3).for_each(|a| all.by_nozzle[a] += part.by_nozzle[a]);
            all.squares += part.squares;
            all.fastest = all.fastest.max(part.fastest);
            all.most_accelerated = all.most_accelerated.max(part.most_accelerated);
            all.mass += part.mass;
            all.sound &= part.sound;
            all.pushed.extend(part.pushed);
            all.stopped.extend(part.stopped);
            all.velocities.extend(part.velocities);
        }
        all
    }

    pub fn fastest(&self) -> f64 {
        self.fastest.sqrt()
    }

    /// Takes another acceleration into account.
    pub fn accelerate(&mut self, acceleration: [f64; 3]) {
        let square = acceleration.iter().map(|a| a * a).sum();
        self.most_accelerated = self.most_accelerated.max(square);
    }

    pub fn most_accelerated(&self) -> f64 {
        self.most_accelerated.sqrt()
    }

    /// Root mean square of the speed relative to the mean velocity, which is zero along axes
    /// without motion as a whole.
    pub fn root_mean_square_speed(&self, particles: usize, even: [bool; 2]) -> f64 {
        let count = particles as f64;
        let free = [!even[0], !even[1], true];
        let mean: f64 = (0..3).filter(|&a| free[a]).map(|a| (self.sums[a] / count).powi(2)).sum();
        (self.squares / count - mean).max(0.0).sqrt()
    }
}

/// Durations over which accelerations act, over H/c₀.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    pub dt: f64,
    /// Duration of surface tension; `None` between its impulses.
    pub tension: Option<f64>,
}

impl Times {
    pub const NONE: Self = Self { dt: 0.0, tension: Some(0.0) };
}

/// Changes velocities by the accelerations; gravity is the same for all. Stops held particles; `bonds` are those of all
/// particles, empty where all are fluid.
pub fn kick(part: &mut Part, times: Times, gravity: [f64; 3], bonds: &[Bond]) -> Motion {
    let mut motion = Motion::none();
    for i in 0..part.mass.len() {
        let [by_fluid, by_wall] = part.acceleration[i];
        let mut velocity = part.velocity[i];
        let (mut speed, mut acceleration) = (0.0, 0.0);
        let (pull, turn) = match times.tension {
            Some(turn) => (part.tension[i], turn),
            None => ([0.0; 4], 0.0),
        };
        let pulls = [pull[0], pull[1], pull[2] + pull[3]];
        for a in 0..3 {
            let rate = by_fluid[a] + by_wall[a] + gravity[a];
            velocity[a] += times.dt * rate + turn * pulls[a];
            let rate = rate + pulls[a];
            speed += velocity[a] * velocity[a];
            acceleration += rate * rate;
        }
        let bond = bonds.get(part.first + i).copied().unwrap_or_default();
        if bond == Bond::Nozzle {
            let held = part.velocity[i];
            (0..3).for_each(|a| motion.by_nozzle[a] += part.mass[i] * (held[a] - velocity[a]));
            (velocity, speed) = (held, held.iter().map(|v| v * v).sum());
        } else if bond.is_held() {
            if matches!(bond, Bond::Wall | Bond::Asleep) && velocity != [0.0; 3] {
                motion.stopped.push((part.first + i, velocity));
            }
            (velocity, speed) = ([0.0; 3], if speed.is_finite() { 0.0 } else { speed });
        }
        if bond.is_rigid() {
            acceleration = 0.0;
        }
        part.velocity[i] = velocity;
        (0..3).for_each(|a| motion.sums[a] += velocity[a]);
        motion.squares += speed;
        motion.fastest = motion.fastest.max(speed);
        motion.most_accelerated = motion.most_accelerated.max(acceleration);
        motion.mass += part.mass[i];
        let [x, y, z] = part.position[i];
        let finite = (x + y + z + speed + part.temperature[i]).is_finite()
            && x.abs().max(y.abs()).max(z.abs()) < FARTHEST;
        let density = 1.0 + part.density[i];
        motion.sound &=
            finite && speed < FASTEST * FASTEST && (DENSITIES[0]..DENSITIES[1]).contains(&density);
        if by_wall != [0.0; 3] || pull[3] != 0.0 {
            motion.pushed.push(part.first + i);
        }
    }
    let blocks = part.velocity.chunks(BLOCK);
    motion.velocities.extend(blocks.map(|block| Bounds::of(block.iter().copied())));
    motion
}

//! Accelerations at the end of a step.

use super::images::{Images, Source};
use super::lanes::{Lanes, WIDTH, lanes, scaled};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use super::rings::{Arc, Form, PLACES, flat};
use crate::kernel::Shape;

/// Pressure and viscosity: equal and opposite in every pair, and along the line between both
/// particles.
///
/// With lengths over H, velocities over c₀, pressures over ρ₀c₀², F = w′(q)/q of the kernel and its
/// second moment m = ∫ q² W dV in d dimensions,
///
/// `(1 + r_i) du_i/dt = Σ V_j F x_ij [−(p_i + p_j) + (2d/m) ν u_ij·x_ij]`.
///
/// Inside the fluid the second part is `ν (∇²u + 2 ∇∇·u)`. Its dissipation depends on the rate of
/// strain e alone, `∫ 2µ e:e dV` of an incompressible flow. So free surfaces bear no viscous stress
/// and need no condition.
///
/// Images across z move against their originals, so that the fluid sticks.
///
/// Sources: Monaghan & Gingold (1983), J. Comput. Phys. 52, 374–389, doi
/// 10.1016/0021-9991(83)90036-0. Their weight F/q² is here F, which needs no division and varies
/// less between the directions of a lattice; any weight is valid with its moment (Español & Revenga
/// 2003, Phys. Rev. E 67, 026705, doi 10.1103/PhysRevE.67.026705). Free surfaces: Colagrossi,
/// Antuono, Souto-Iglesias & Le Touzé (2011), Phys. Rev. E 84, 026705, doi
/// 10.1103/PhysRevE.84.026705.
pub struct Momentum<'a, const FROZEN: bool> {
    pub images: &'a Images,
    /// Position, velocity, volume and pressure of each particle.
    pub records: &'a [[f64; 8]],
    /// r of each particle.
    pub densities: &'a [f64],
    /// σ of the kernel.
    pub normalisation: f64,
    /// (2d/m) ν, with ν = µ/(ρ₀ c₀ H).
    pub viscosity: f64,
    /// Factor of viscosity of each particle, and zeros, where `FROZEN`.
    pub annexes: &'a [[f64; 4]],
}

/// Accelerations of one particle by fluid and by the wall.
pub type Accelerations = [[f64; 3]; 2];

impl<const FROZEN: bool> PairSum for Momentum<'_, FROZEN> {
    type Output = Accelerations;
    const ANNEX: bool = FROZEN;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn annexes(&self) -> &[[f64; 4]] {
        self.annexes
    }

    #[inline(always)]
    fn annex(&self, source: Source) -> [f64; 4] {
        self.annexes[source.particle()]
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, u, v, w, volume, pressure] = self.records[source.particle()];
        let pressure = pressure + image.overpressure([x, y, z]);
        let ([x, y, z], [u, v, w]) = (image.place([x, y, z]), image.no_slip([u, v, w]));
        [x, y, z, u, v, w, volume, pressure]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> Accelerations {
        let own = &self.records[block.first + k];
        let here = Here::<L> {
            position: lanes(block.about(own)),
            velocity: lanes([own[3], own[4], own[5]]),
            pressure: L::constant(own[7]),
            viscosity: L::constant(self.viscosity),
            factor: L::constant(if FROZEN { self.annexes[block.first + k][0] } else { 1.0 }),
            centre: L::constant(block.centre[0]),
        };
        let [fluid, wall] = block.neighbours(k);
        let scale = self.normalisation / (1.0 + self.densities[block.first + k]);
        [
            flat::<F>(scaled(total::<L, S, F, FROZEN>(shape, fluid, &here, local), scale)),
            flat::<F>(scaled(total::<L, S, F, FROZEN>(shape, wall, &here, local), scale)),
        ]
    }
}

/// Sum of the forces of a list of neighbours.
#[inline(always)]
fn total<L: Lanes, S: Shape, F: Form, const FROZEN: bool>(
    shape: S,
    neighbours: &[[u16; WIDTH]],
    here: &Here<L>,
    local: &Local<L::Real>,
) -> [L; 3] {
    let mut force = [L::constant(0.0); 3];
    for places in neighbours {
        let neighbour = local.gather(places);
        let mut viscosity = here.viscosity;
        if FROZEN {
            let [theirs, ..] = local.gather_annex::<L>(places);
            viscosity = L::constant(0.5) * viscosity * (here.factor + theirs);
        }
        if !F::ROUND {
            add::<L, S>(shape, &mut force, here, neighbour, viscosity);
            continue;
        }
        let [x, _, z, ..] = neighbour;
        let d = [here.position[0] - x, here.position[2] - z];
        let radii = [here.position[0] + here.centre, x + here.centre];
        let arc = Arc::about(radii[0], radii[1], d[0] * d[0] + d[1] * d[1]);
        for place in 0..PLACES {
            add::<L, S>(shape, &mut force, here, arc.turn(place).record(neighbour), viscosity);
        }
    }
    force
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    velocity: [L; 3],
    pressure: L,
    viscosity: L,
    /// Factor of its viscosity.
    factor: L,
    /// x of the origin of the positions.
    centre: L,
}

/// Adds the forces of sixteen neighbours.
#[inline(always)]
fn add<L: Lanes, S: Shape>(
    shape: S,
    force: &mut [L; 3],
    here: &Here<L>,
    neighbour: [L; 8],
    viscosity: L,
) {
    let [x, y, z, vx, vy, vz, volume, pressure] = neighbour;
    let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
    let u = [here.velocity[0] - vx, here.velocity[1] - vy, here.velocity[2] - vz];
    let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let slope = volume * shape.slope_over_q(q);
    let closing = u[0] * d[0] + u[1] * d[1] + u[2] * d[2];
    let along = slope * (viscosity * closing - (here.pressure + pressure));
    for n in 0..3 {
        force[n] = force[n] + along * d[n];
    }
}

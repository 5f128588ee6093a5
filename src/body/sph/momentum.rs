//! Accelerations at the end of a step.

use super::images::{Images, Source};
use super::lanes::{Lanes, WIDTH, lanes};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use super::tension::PairForce;
use crate::kernel::Shape;

/// Pressure, viscosity and surface tension, equal and opposite in every pair.
///
/// With lengths over H, velocities over c₀, pressures over ρ₀c₀² and F = w′(q)/q of the kernel,
///
/// `(1 + r_i) du_i/dt = Σ V_j F [−(p_i + p_j) x_ij + 2 ν u_ij] + Σ V_j g(q) x_ij/q`
///
/// with the pair force g of surface tension. Images across z move against their originals, so that
/// the fluid sticks; the pair force of those at the wall is a share of the fluid's, the wetting.
///
/// Sources: Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214–226, doi 10.1006/jcph.1997.5776;
/// Tartakovsky & Meakin (2005), Phys. Rev. E 72, 026301, doi 10.1103/PhysRevE.72.026301.
pub struct Momentum<'a> {
    pub images: &'a Images,
    /// Position, velocity, volume and pressure of every particle.
    pub records: &'a [[f64; 8]],
    /// r of every particle.
    pub densities: &'a [f64],
    /// σ of the kernel.
    pub normalisation: f64,
    /// ν = µ/(ρ₀ c₀ H).
    pub viscosity: f64,
    pub cohesion: PairForce,
    /// Share of the pair force that the wall has: (1 + cos θ)/2 for a contact angle θ.
    pub wetting: f64,
}

/// Accelerations of one particle by fluid and by the wall.
pub type Accelerations = [[f64; 3]; 2];

impl PairSum for Momentum<'_> {
    type Output = Accelerations;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, u, v, w, volume, pressure] = self.records[source.particle()];
        let pressure = pressure + image.overpressure([x, y, z]);
        let ([x, y, z], [u, v, w]) = (image.place([x, y, z]), image.stuck([u, v, w]));
        [x, y, z, u, v, w, volume, pressure]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape>(
        &self,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> Accelerations {
        let own = &self.records[block.first + k];
        let here = |share: f64| Here::<L> {
            position: lanes([
                own[0] - block.centre[0],
                own[1] - block.centre[1],
                own[2] - block.centre[2],
            ]),
            velocity: lanes([own[3], own[4], own[5]]),
            pressure: L::constant(own[7] + 2.0 * share * self.cohesion.background),
            viscosity: L::constant(2.0 * self.viscosity),
            amplitude: L::constant(share * self.cohesion.amplitude / self.normalisation),
        };
        let [fluid, wall] = block.neighbours(k);
        let scale = self.normalisation / (1.0 + self.densities[block.first + k]);
        let cohesive = self.cohesion.amplitude != 0.0;
        [
            scaled(total::<L, S>(fluid, &here(1.0), cohesive, local), scale),
            scaled(total::<L, S>(wall, &here(self.wetting), cohesive, local), scale),
        ]
    }
}

/// Sum of the forces of a list of neighbours.
#[inline(always)]
fn total<L: Lanes, S: Shape>(
    neighbours: &[[u16; WIDTH]],
    here: &Here<L>,
    cohesive: bool,
    local: &Local<L::Real>,
) -> [L; 3] {
    let mut force = [L::constant(0.0); 3];
    if cohesive {
        for places in neighbours {
            add::<L, S, true>(&mut force, here, local.gather(places));
        }
    } else {
        for places in neighbours {
            add::<L, S, false>(&mut force, here, local.gather(places));
        }
    }
    force
}

#[inline(always)]
fn scaled<L: Lanes>([x, y, z]: [L; 3], factor: f64) -> [f64; 3] {
    [factor * x.sum().into(), factor * y.sum().into(), factor * z.sum().into()]
}

/// The particle whose neighbours are summed, in all lanes.
struct Here<L> {
    position: [L; 3],
    velocity: [L; 3],
    pressure: L,
    viscosity: L,
    amplitude: L,
}

/// Adds the forces of sixteen neighbours.
#[inline(always)]
fn add<L: Lanes, S: Shape, const COHESIVE: bool>(
    force: &mut [L; 3],
    here: &Here<L>,
    neighbour: [L; 8],
) {
    let [x, y, z, vx, vy, vz, volume, pressure] = neighbour;
    let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
    let u = [here.velocity[0] - vx, here.velocity[1] - vy, here.velocity[2] - vz];
    let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    let q = square.sqrt();
    let slope = volume * S::slope_over_q(q);
    let mut along = L::constant(0.0) - slope * (here.pressure + pressure);
    if COHESIVE {
        along = along + here.amplitude * volume * cohesion(q, square);
    }
    let viscous = here.viscosity * slope;
    for a in 0..3 {
        force[a] = force[a] + (along * d[a] + viscous * u[a]);
    }
}

/// cos(3πq/2)/q for q < 1, else 0; a particle does not act on itself.
#[inline(always)]
fn cohesion<L: Lanes>(q: L, square: L) -> L {
    let rest = (L::constant(1.0) - square).max(L::constant(0.0));
    let mut series = L::constant(COHESION[6]);
    for n in (0..6).rev() {
        series = series * square + L::constant(COHESION[n]);
    }
    rest * series / q.max(L::constant(1e-3))
}

/// cos(3πq/2)/(1 − q²) in powers of q², fitted by least squares at Chebyshev points: the cosine's
/// error is below 7e-8.
const COHESION: [f64; 7] = [
    0.9999999327210471,
    -10.103296430819482,
    10.443753618337372,
    -4.7642820551346805,
    1.2612965156808067,
    -0.2145987332003284,
    0.020938144298660033,
];

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::body::sph::lanes::Array;
    use crate::kernel::Number;

    #[test]
    fn cohesion_is_the_cosine_over_the_distance() {
        for i in 1..120 {
            let q = 0.01 * f64::from(i);
            let exact = if q < 1.0 { (1.5 * PI * q).cos() / q } else { 0.0 };
            let [value, ..] =
                cohesion::<Array<f64>>(Array::<f64>::constant(q), Array::<f64>::constant(q * q))
                    .to_array();
            assert!((value - exact).abs() < 1e-7 / q, "{q}: {value} {exact}");
        }
    }
}

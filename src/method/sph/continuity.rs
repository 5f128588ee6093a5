//! Rates of density and temperature, and gradients of density, at the middle of a step.

use super::images::{Images, Source};
use super::lanes::{Lanes, WIDTH, lanes};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use super::rings::{Arc, Form, PLACES, flat};
use crate::kernel::Shape;

/// Continuity with density diffusion (δ-SPH), and conduction.
///
/// With lengths over H, velocities over c₀, r = ρ/ρ₀ − 1 and F = w′(q)/q of the kernel,
///
/// `dr_i/dt = (1 + r_i) Σ V_j F u_ij·x_ij + δ/2 · Σ 2 V_j (−F) [r_j − r_i + ½ (g_i + g_j)·x_ij]`,
/// `(1 + r_i) dT_i/dt = 2 κ Σ V_j F (T_i − T_j)`,
///
/// with δ for a smoothing length H/2 and `g_i = B_i Σ V_j F (r_j − r_i) x_ij`,
/// `B_i = [−Σ V_j F x_ij ⊗ x_ij]⁻¹`, of the step before. In the first equation images at planes
/// slip. Under a body force the density continues in them as at rest, so that a fluid at rest is
/// not diffused. A fluid at rest under surface tension is not diffused either, because the
/// diffusion acts on r + φ with the tension's potential φ (0 without). At a surface with tension
/// the diffusion fades with the mean eigenvalue of `−Σ V_j F x_ij ⊗ x_ij` (½ on a flat surface, 1
/// inside). Among the outermost particles r + φ is uneven, and a diffusion that evens it would
/// drive them out of the fluid one by one. In the second equation images have the temperature of
/// their originals; [`WallHeat`](super::wall_heat::WallHeat) supplies the heat of the wall.
///
/// Heat is conducted only with `HEAT`; without `MOMENTS` all g are 0, and neither g nor the sums
/// for B are computed.
///
/// Sources: Antuono, Colagrossi & Marrone (2012), Comput. Phys. Commun. 183, 2570–2580, doi
/// 10.1016/j.cpc.2012.07.006; with g = 0 Molteni & Colagrossi (2009), Comput. Phys. Commun. 180,
/// 861–872, doi 10.1016/j.cpc.2008.12.004; Cleary & Monaghan (1999), J. Comput. Phys. 148, 227–264,
/// doi 10.1006/jcph.1998.6118.
pub struct Continuity<'a, const HEAT: bool, const MOMENTS: bool> {
    pub images: &'a Images,
    /// Position, velocity, volume and r + φ of each particle.
    pub records: &'a [[f64; 8]],
    /// r of each particle.
    pub densities: &'a [f64],
    /// g and temperature of each particle; empty where neither is needed.
    pub annexes: &'a [[f64; 4]],
    /// σ of the kernel.
    pub normalisation: f64,
    /// δ.
    pub diffusion: f64,
    /// Number of dimensions where free surfaces have tension.
    pub tension_dimension: Option<usize>,
    /// κ = k/(ρ₀ c c₀ H).
    pub conduction: f64,
}

/// Mean eigenvalues of a particle's moment matrix between which its density diffusion rises from
/// zero to its full value.
const FADE: [f64; 2] = [0.4, 0.6];

/// Sums for one particle, their factors included; 0 where they are not computed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContinuityRates {
    /// dr/dt.
    pub density: f64,
    /// dT/dt.
    pub temperature: f64,
    /// −Σ V F x ⊗ x: xx, yy, zz, xy, yz, xz.
    pub moment: [f64; 6],
    /// Σ V_j F (r_j − r_i) x_ij.
    pub gradient: [f64; 3],
}

impl<const HEAT: bool, const MOMENTS: bool> PairSum for Continuity<'_, HEAT, MOMENTS> {
    type Output = ContinuityRates;
    const ANNEX: bool = HEAT || MOMENTS;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn annexes(&self) -> &[[f64; 4]] {
        self.annexes
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, u, v, w, volume, density] = self.records[source.particle()];
        // Where the density differs little from that at rest, r is the pressure.
        let density = density + image.overpressure([x, y, z]);
        let ([x, y, z], [u, v, w]) = (image.place([x, y, z]), image.turn([u, v, w]));
        [x, y, z, u, v, w, volume, density]
    }

    #[inline(always)]
    fn annex(&self, source: Source) -> [f64; 4] {
        let [x, y, z, temperature] = self.annexes[source.particle()];
        let [x, y, z] = self.images.get(source.code()).gradient([x, y, z]);
        [x, y, z, temperature]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> ContinuityRates {
        let i = block.first + k;
        let own = &self.records[i];
        let annex = if HEAT || MOMENTS { self.annexes[i] } else { [0.0; 4] };
        let here = Here {
            position: lanes(block.about(own)),
            velocity: lanes([own[3], own[4], own[5]]),
            density: L::constant(own[7]),
            gradient: lanes([annex[0], annex[1], annex[2]]),
            temperature: L::constant(annex[3]),
            centre: L::constant(block.centre[0]),
        };
        let [fluid, wall] = block.neighbours(k);
        let mut sums = Sums::<L, HEAT, MOMENTS>::zero();
        sums.add_all::<S, F>(shape, &here, fluid, local);
        sums.add_all::<S, F>(shape, &here, wall, local);
        let scale = self.normalisation;
        let dense = 1.0 + self.densities[i];
        let heating = 2.0 * self.conduction * scale / dense;
        let mut rates = ContinuityRates {
            density: 0.0,
            temperature: 0.0,
            moment: [0.0; 6],
            gradient: [0.0; 3],
        };
        if HEAT {
            rates.temperature = heating * sums.temperature.sum().into();
        }
        if MOMENTS {
            for (total, sum) in rates.moment.iter_mut().zip(sums.moment) {
                *total = -scale * sum.sum().into();
            }
            for (total, sum) in rates.gradient.iter_mut().zip(sums.gradient) {
                *total = scale * sum.sum().into();
            }
            rates.gradient = flat::<F>(rates.gradient);
            if F::ROUND {
                (rates.moment[3], rates.moment[4]) = (0.0, 0.0);
            }
        }
        let part = self
            .tension_dimension
            .map_or(1.0, |dimension| part_of_diffusion(&rates.moment, dimension));
        rates.density = scale * dense * sums.divergence.sum().into()
            - part * scale * self.diffusion * sums.diffusion.sum().into();
        rates
    }
}

/// Fraction of its density diffusion that a particle retains, from its moment.
#[inline(always)]
fn part_of_diffusion(moment: &[f64; 6], dimension: usize) -> f64 {
    let mean = moment[..3].iter().sum::<f64>() / dimension as f64;
    let way = ((mean - FADE[0]) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
    way * way * (3.0 - 2.0 * way)
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    velocity: [L; 3],
    density: L,
    gradient: [L; 3],
    temperature: L,
    /// x of the origin of the positions.
    centre: L,
}

impl<L: Lanes> Here<L> {
    #[inline(always)]
    fn arc(&self, &[x, _, z, ..]: &[L; 8]) -> Arc<L> {
        let d = [self.position[0] - x, self.position[2] - z];
        Arc::about(self.position[0] + self.centre, x + self.centre, d[0] * d[0] + d[1] * d[1])
    }
}

struct Sums<L, const HEAT: bool, const MOMENTS: bool> {
    divergence: L,
    diffusion: L,
    temperature: L,
    moment: [L; 6],
    gradient: [L; 3],
}

impl<L: Lanes, const HEAT: bool, const MOMENTS: bool> Sums<L, HEAT, MOMENTS> {
    #[inline(always)]
    fn zero() -> Self {
        let zero = L::constant(0.0);
        Self {
            divergence: zero,
            diffusion: zero,
            temperature: zero,
            moment: [zero; 6],
            gradient: [zero; 3],
        }
    }

    /// Adds neighbours.
    #[inline(always)]
    fn add_all<S: Shape, F: Form>(
        &mut self,
        shape: S,
        here: &Here<L>,
        neighbours: &[[u16; WIDTH]],
        local: &Local<L::Real>,
    ) {
        for places in neighbours {
            let annex =
                if HEAT || MOMENTS { local.gather_annex(places) } else { [L::constant(0.0); 4] };
            let neighbour = local.gather(places);
            if !F::ROUND {
                self.add(shape, here, neighbour, annex);
                continue;
            }
            let arc = here.arc(&neighbour);
            for place in 0..PLACES {
                let turn = arc.turn(place);
                self.add(shape, here, turn.record(neighbour), turn.annex(annex));
            }
        }
    }

    #[inline(always)]
    fn add<S: Shape>(&mut self, shape: S, here: &Here<L>, neighbour: [L; 8], annex: [L; 4]) {
        let [x, y, z, vx, vy, vz, volume, density] = neighbour;
        let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
        let u = [here.velocity[0] - vx, here.velocity[1] - vy, here.velocity[2] - vz];
        let slope = volume * shape.slope_over_q((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt());
        let jump = density - here.density;
        if HEAT {
            self.temperature = self.temperature + slope * (here.temperature - annex[3]);
        }
        if !MOMENTS {
            let along = u[0] * d[0] + u[1] * d[1] + u[2] * d[2];
            self.divergence = self.divergence + slope * along;
            self.diffusion = self.diffusion + jump * slope;
            return;
        }
        let e = [slope * d[0], slope * d[1], slope * d[2]];
        self.divergence = self.divergence + (u[0] * e[0] + u[1] * e[1] + u[2] * e[2]);
        let along = (here.gradient[0] + annex[0]) * e[0]
            + (here.gradient[1] + annex[1]) * e[1]
            + (here.gradient[2] + annex[2]) * e[2];
        self.diffusion = self.diffusion + (jump * slope + L::constant(0.5) * along);
        for n in 0..6 {
            let (a, b) = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)][n];
            self.moment[n] = self.moment[n] + e[a] * d[b];
        }
        for (sum, e) in self.gradient.iter_mut().zip(e) {
            *sum = *sum + jump * e;
        }
    }
}

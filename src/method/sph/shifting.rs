//! Shifts particles slightly from crowded to sparse regions.

use super::images::Images;
use super::lanes::{Lanes, lanes};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use super::rings::{Arc, Form, PLACES, flat};
use crate::kernel::Shape;

/// Weight of the term against pairing (Monaghan 2000), and its power.
const PAIRING: f64 = 0.2;
/// Squared distance over H² at which two places coincide.
const SAME: f64 = 1e-12;
/// Fullness above which particles lie inside the fluid.
pub const INSIDE: f64 = 0.75;

/// Gradient of the concentration of particles, and location of the free surface.
///
/// `∇C_i = Σ V_j [1 + 0.2 (w(q)/w(q₀))⁴] F x_ij`, with q₀ the distance of particles over H; the
/// normal follows the gradient of the smallest eigenvalue λ of the moment matrix.
///
/// Sources: Sun, Colagrossi, Marrone & Zhang (2017), Comput. Methods Appl. Mech. Eng. 315, 25–49,
/// doi 10.1016/j.cma.2016.10.028; Marrone, Colagrossi, Le Touzé & Graziani (2010), J. Comput. Phys.
/// 229, 3652–3663, doi 10.1016/j.jcp.2010.01.019.
pub struct Crowding<'a> {
    pub images: &'a Images,
    /// Position, 0, 0, 0, volume and λ of each particle.
    pub records: &'a [[f64; 8]],
    /// σ of the kernel.
    pub normalisation: f64,
    /// 1/w(q₀).
    pub reference: f64,
}

/// Sums that determine the displacement of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrowdingSums {
    pub gradient: [f64; 3],
    /// Σ V_j (λ_j − λ_i) F x_ij.
    pub normal: [f64; 3],
    /// Concentration of neighbours that lie at a free surface.
    pub surface: f64,
}

impl PairSum for Crowding<'_> {
    type Output = CrowdingSums;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> CrowdingSums {
        let own = &self.records[block.first + k];
        let at: [L; 3] = lanes(block.about(own));
        let here = Here { position: at, fullness: L::constant(own[7]) };
        let centre = L::constant(block.centre[0]);
        let mut lanes = Sums::none();
        for places in block.neighbours(k).into_iter().flatten() {
            let neighbour = local.gather(places);
            let square = here.square_to(&neighbour);
            let closeness = shape.value(square.sqrt()) * L::constant(self.reference);
            if !F::ROUND {
                lanes.add(shape, &here, neighbour, closeness);
                continue;
            }
            // Two rings are as close as their closest places. No ring is close to itself: places
            // along it would push it outward.
            let closeness = square.choose_below(SAME, L::constant(0.0), closeness);
            let arc = Arc::about(at[0] + centre, neighbour[0] + centre, square);
            for place in 0..PLACES {
                lanes.add(shape, &here, arc.turn(place).record(neighbour), closeness);
            }
        }
        let Sums { gradient, normal, surface } = lanes;
        let scale = self.normalisation;
        let mut sums = CrowdingSums {
            gradient: [0.0; 3],
            normal: [0.0; 3],
            surface: scale * surface.sum().into(),
        };
        for a in 0..3 {
            sums.gradient[a] = scale * gradient[a].sum().into();
            sums.normal[a] = scale * normal[a].sum().into();
        }
        (sums.gradient, sums.normal) = (flat::<F>(sums.gradient), flat::<F>(sums.normal));
        sums
    }
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    fullness: L,
}

impl<L: Lanes> Here<L> {
    #[inline(always)]
    fn square_to(&self, &[x, y, z, ..]: &[L; 8]) -> L {
        let d = [self.position[0] - x, self.position[1] - y, self.position[2] - z];
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }
}

/// Sums over neighbours in lanes.
struct Sums<L> {
    gradient: [L; 3],
    normal: [L; 3],
    surface: L,
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn none() -> Self {
        let zero = L::constant(0.0);
        Self { gradient: [zero; 3], normal: [zero; 3], surface: zero }
    }

    /// Adds sixteen neighbours with closeness w(q)/w(q₀).
    #[inline(always)]
    fn add<S: Shape>(&mut self, shape: S, here: &Here<L>, neighbour: [L; 8], closeness: L) {
        let [x, y, z, _, _, _, volume, theirs] = neighbour;
        let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
        let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let value = volume * shape.value(q);
        let slope = volume * shape.slope_over_q(q);
        let square = closeness * closeness;
        let pull = slope * (L::constant(1.0) + L::constant(PAIRING) * square * square);
        let rise = slope * (theirs - here.fullness);
        for ((gradient, normal), d) in self.gradient.iter_mut().zip(&mut self.normal).zip(d) {
            *gradient = *gradient + pull * d;
            *normal = *normal + rise * d;
        }
        let none = L::constant(0.0);
        self.surface = self.surface + theirs.choose_below(INSIDE, value, none);
    }
}

/// Displacement for a gradient of 1 and a mean path of 1, both in units of H. Sun et al. (2017) use
/// 2 and the path at the highest speed, which is about twice the mean one.
const STRENGTH: f64 = 2.0;
/// Largest single displacement over H.
const MOST: f64 = 0.02;

/// Displacement of a particle over H, for the mean path of particles since the last one. Near a
/// free surface it is tangential; at its edge it vanishes.
pub fn displacement(sums: &CrowdingSums, fullness: f64, way: f64) -> [f64; 3] {
    let mut shift = sums.gradient.map(|g| -STRENGTH * way * g);
    if fullness < INSIDE {
        return [0.0; 3];
    }
    if sums.surface > 0.0 {
        let length = sums.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if length > 0.0 {
            let along: f64 = (0..3).map(|a| shift[a] * sums.normal[a] / length).sum();
            for (shift, normal) in shift.iter_mut().zip(sums.normal) {
                *shift -= along * normal / length;
            }
        }
    }
    let length = shift.iter().map(|s| s * s).sum::<f64>().sqrt();
    let limit = if length > MOST { MOST / length } else { 1.0 };
    shift.map(|s| limit * s)
}

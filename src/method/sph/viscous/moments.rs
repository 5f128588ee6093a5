//! Fourth moments of the particles' neighbours.

use super::super::images::Images;
use super::super::lanes::{Lanes, lanes};
use super::super::loops::{Local, PairSum};
use super::super::neighbours::Block;
use super::super::rings::{Arc, Form, PLACES};
use super::tensor::POWERS;
use super::weights::Weights;
use crate::kernel::Shape;

/// `Σ V_j (−F) x_a x_b x_c x_d` over the neighbours of each particle, images included.
pub struct Moments<'a> {
    pub images: &'a Images,
    /// Position and volume of each particle; the numbers between them are not used.
    pub records: &'a [[f64; 8]],
    pub weights: Weights,
}

impl PairSum for Moments<'_> {
    type Output = [f64; 15];

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
    ) -> [f64; 15] {
        let own = &self.records[block.first + k];
        let here = Here::<L> {
            position: lanes(block.about(own)),
            narrowing: L::constant(self.weights.narrowing),
            centre: L::constant(block.centre[0]),
        };
        let mut sums = [L::constant(0.0); 15];
        for list in block.near_neighbours(k) {
            for places in list {
                add_all::<L, S, F>(shape, &mut sums, &here, local.gather(places));
            }
        }
        let mut moments = [0.0; 15];
        for (n, sum) in sums.into_iter().enumerate() {
            // Odd powers across a ring's plane cancel with the other half of the arc.
            let cancels = F::ROUND && POWERS[n][1] % 2 == 1;
            moments[n] = if cancels { 0.0 } else { -self.weights.normalisation * sum.sum().into() };
        }
        moments
    }
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    narrowing: L,
    /// x of the origin of the positions.
    centre: L,
}

/// Adds sixteen neighbours, or all places of sixteen rings.
#[inline(always)]
fn add_all<L: Lanes, S: Shape, F: Form>(
    shape: S,
    sums: &mut [L; 15],
    here: &Here<L>,
    neighbour: [L; 8],
) {
    if !F::ROUND {
        return add::<L, S>(shape, sums, here, neighbour);
    }
    let [x, _, z] = here.position;
    let d = [x - neighbour[0], z - neighbour[2]];
    let radii = [x + here.centre, neighbour[0] + here.centre];
    let arc = Arc::about(radii[0], radii[1], d[0] * d[0] + d[1] * d[1]);
    for place in 0..PLACES {
        add::<L, S>(shape, sums, here, arc.turn(place).record(neighbour));
    }
}

#[inline(always)]
fn add<L: Lanes, S: Shape>(
    shape: S,
    sums: &mut [L; 15],
    here: &Here<L>,
    [x, y, z, _, _, _, volume, _]: [L; 8],
) {
    let [x, y, z] = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
    let [xx, yy, zz] = [x * x, y * y, z * z];
    let weight = volume * shape.slope_over_q((xx + yy + zz).sqrt() * here.narrowing);
    let [wx, wy, wz] = [weight * xx, weight * yy, weight * zz];
    let [xy, yz, xz] = [x * y, y * z, x * z];
    let terms = [
        wx * xx,
        wy * yy,
        wz * zz,
        wx * yy,
        wy * zz,
        wx * zz,
        wx * xy,
        wy * xy,
        wy * yz,
        wz * yz,
        wx * xz,
        wz * xz,
        wx * yz,
        wy * xz,
        wz * xy,
    ];
    for n in 0..15 {
        sums[n] = sums[n] + terms[n];
    }
}

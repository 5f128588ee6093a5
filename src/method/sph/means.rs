//! Weighted sums of a quantity over the neighbours of particles.

use super::images::{Images, Source};
use super::lanes::{Lanes, lanes};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use super::rings::{Arc, Form, PLACES};
use crate::kernel::Shape;

/// `Σ V_j W_ij n_j q_j` of a quantity q with weights n of the particles.
///
/// Beyond planes q continues like the pressure of a fluid at rest.
pub struct Means<'a> {
    pub images: &'a Images,
    /// Position, q, n, 0 and volume of each particle.
    pub records: &'a [[f64; 8]],
    /// σ of the kernel.
    pub normalisation: f64,
}

impl PairSum for Means<'_> {
    type Output = f64;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, q, n, _, volume, _] = self.records[source.particle()];
        let q = q + image.overpressure([x, y, z]);
        let [x, y, z] = image.place([x, y, z]);
        [x, y, z, q, n, 0.0, volume, 0.0]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> f64 {
        let own = &self.records[block.first + k];
        let here: [L; 3] = lanes(block.about(own));
        let centre = L::constant(block.centre[0]);
        let mut sum = L::constant(0.0);
        for list in block.neighbours(k) {
            for places in list {
                let [x, y, z, q, n, _, volume, _] = local.gather::<L>(places);
                let weighted = volume * n * q;
                if !F::ROUND {
                    sum = sum + weighted * value(shape, here, [x, y, z]);
                    continue;
                }
                let d = [here[0] - x, here[2] - z];
                let arc = Arc::about(here[0] + centre, x + centre, d[0] * d[0] + d[1] * d[1]);
                for place in 0..PLACES {
                    let turn = arc.turn(place);
                    let weight = value(shape, here, turn.place([x, y, z]));
                    sum = sum + weighted * turn.weight * weight;
                }
            }
        }
        self.normalisation * sum.sum().into()
    }
}

#[inline(always)]
fn value<L: Lanes, S: Shape>(shape: S, here: [L; 3], [x, y, z]: [L; 3]) -> L {
    let d = [here[0] - x, here[1] - y, here[2] - z];
    shape.value((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt())
}

//! Conduction in fluid at rest.

use super::images::Images;
use super::lanes::{Lanes, lanes};
use super::loops::{Local, PairKind, PairSum, for_all_of};
use super::neighbours::Block;
use super::rings::Form;
use crate::kernel::{Shape, WendlandC2};
use crate::runtime::parallel::Team;
use crate::scene::Precision;

/// Conduction by pairs of which at least one particle has left the cloud of a step.
///
/// With V, F and κ of [`Continuity`](super::continuity::Continuity), the heat potential φ and s = 1 for particles that
/// have left and 0 for those that the flow holds beside them,
///
/// `(1 + r_i) dC_i/dt = 2 κ Σ V_j F (s_i + s_j − s_i s_j) (φ_i − φ_j)`.
///
/// The sums are those of the flow's steps, which conduct within the cloud, so each pair counts once. They are taken in
/// double precision, in which both sides of a pair gain and lose the same over long times at rest, and with the kernel
/// of all strands, Wendland's of degree 2.
pub struct RestingHeat<'a> {
    pub images: &'a Images,
    /// Position, s, 0, 0, volume and φ of each particle.
    pub records: &'a [[f64; 8]],
    /// 2 κ σ with σ of the kernel.
    pub scale: f64,
}

impl RestingHeat<'_> {
    /// `(1 + r) dC/dt` of all particles.
    pub fn rates(&self, blocks: &[Block], kind: PairKind, team: &Team) -> Vec<f64> {
        let kind = PairKind { precision: Precision::Double, ..kind };
        for_all_of(WendlandC2, self, blocks, kind, team, Vec::new())
    }
}

impl PairSum for RestingHeat<'_> {
    /// `(1 + r) dC/dt` of a particle.
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
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> f64 {
        let own = &self.records[block.first + k];
        let at: [L; 3] = lanes(block.about(own));
        let [left, potential] = [own[3], own[7]].map(L::constant);
        let mut sum = L::constant(0.0);
        for places in block.neighbours(k).into_iter().flatten() {
            let [x, y, z, theirs, _, _, volume, other] = local.gather(places);
            let d = [at[0] - x, at[1] - y, at[2] - z];
            let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let counts = left + theirs - left * theirs;
            sum = sum + counts * volume * shape.slope_over_q(q) * (potential - other);
        }
        self.scale * sum.sum().into()
    }
}

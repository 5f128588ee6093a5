//! Free surface of particles, through which fluid gives heat to the air.

use super::images::Images;
use super::lanes::{Lanes, lanes};
use super::loops::{Local, PairKind, PairSum, for_all_of};
use super::neighbours::Block;
use super::rings::Form;
use crate::kernel::{Kernel, Shape, WendlandC2};
use crate::runtime::parallel::Team;

/// Area of free surface of each particle.
///
/// `|∇c|` of the part c of space that fluid fills integrates to 1 across a free surface, about half of it on the side of
/// the fluid. With `n_i = Σ V_j F x_ij` a particle of the volume V_i has the area `a s_i |n_i| V_i`. The part s_i is that
/// of its [`outside`], so that uneven fluid inside counts for nothing, and the factor a makes the area of a flat lattice
/// exact. Images beyond the wall fill space, too, so wetted wall is no free surface. The kernel is Wendland's of degree 2,
/// whatever that of the model.
pub struct Exposure<'a> {
    pub images: &'a Images,
    /// Position, 0, 0, 0, volume and 0 of each particle.
    pub records: &'a [[f64; 8]],
    /// a σ with σ of the kernel.
    pub scale: f64,
}

impl Exposure<'_> {
    /// `a |n_i| V_i` over H² of all particles.
    pub fn areas(&self, blocks: &[Block], kind: PairKind, team: &Team) -> Vec<f64> {
        for_all_of(WendlandC2, self, blocks, kind, team, Vec::new())
    }
}

impl PairSum for Exposure<'_> {
    /// `a |n_i| V_i` over H².
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
        let mut sums = [L::constant(0.0); 3];
        for places in block.neighbours(k).into_iter().flatten() {
            let [x, y, z, _, _, _, volume, _] = local.gather(places);
            let d = [at[0] - x, at[1] - y, at[2] - z];
            let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let slope = volume * shape.slope_over_q(q);
            for (sum, d) in sums.iter_mut().zip(d) {
                *sum = *sum + slope * d;
            }
        }
        let square: f64 = sums.map(|sum| sum.sum().into()).iter().map(|n: &f64| n * n).sum();
        self.scale * own[6] * square.sqrt()
    }
}

/// Least eigenvalue of a particle's moment matrix below which it lies at a free surface, and above which it lies inside.
const OUTSIDE: [f64; 2] = [0.75, 0.85];

/// Part of a particle that counts as at a free surface, from the least eigenvalue of its moment matrix: ½ in the first
/// layer of a lattice, 0.86 in the second.
pub fn outside(least: f64) -> f64 {
    let way = ((OUTSIDE[1] - least) / (OUTSIDE[1] - OUTSIDE[0])).clamp(0.0, 1.0);
    way * way * (3.0 - 2.0 * way)
}

/// Factor a for a support radius over the distance of particles, in space.
pub fn factor(support: f64) -> f64 {
    let layers = support.ceil() as i32;
    let spacing = 1.0 / support;
    // −Σ V F and its moments across, of the layer of a lattice at a height above a particle.
    let of_layer = |above: i32| -> [f64; 2] {
        let along = (-layers..=layers).flat_map(|i| (-layers..=layers).map(move |j| [i, j]));
        let slopes = along.map(|[i, j]| {
            let r = spacing * f64::from(i * i + j * j + above * above).sqrt();
            -Kernel::WendlandC2.gradient_factor(r, 1.0, 3)
        });
        let (slope, height) = (slopes.sum::<f64>(), spacing * f64::from(above));
        [1, 2].map(|power| spacing.powi(3) * slope * height.powi(power))
    };
    let sum = |from: i32, to: i32, power: usize| -> f64 {
        (from..=to).map(|above| of_layer(above)[power]).sum()
    };
    // At a surface the sum over the layers below a particle stands alone: those above are missing.
    let of_depth = |depth: i32| outside(sum(-layers, depth, 1)) * sum(depth + 1, layers, 0);
    1.0 / (spacing * (0..layers).map(of_depth).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Those of an independent sum over the layers of a lattice: with a support of two and three distances the first
    /// layer alone counts, with four the second, too.
    #[test]
    fn factors_are_those_of_a_lattice() {
        for (support, wanted) in [(2.0, 2.03603), (3.0, 2.32782), (4.0, 2.06453)] {
            let factor = factor(support);
            assert!((factor / wanted - 1.0).abs() < 1e-4, "{support}: {factor}");
        }
    }
}

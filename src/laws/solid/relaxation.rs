//! Relaxation of stress by the generalised Maxwell model, exact for strain that is linear in time over a step.
//!
//! With the change e of shape and the elastic change θ of volume, both without thermal strain, instantaneous moduli G
//! and K and the reduced time ξ (see `shift`):
//!
//! `s = 2G (g_∞ e + Σ g_i d_i)`, `ḋ_i = ė − d_i ξ̇/τ_i`, and `p = K (k_∞ θ + Σ k_j b_j)`, `ḃ_j = θ̇ − b_j ξ̇/τ_j`
//!
//! (E. Wiechert 1893, doi 10.1002/andp.18932861103). The elastic strain `d` of a branch is stored, not its viscous
//! strain, so that small stresses keep their digits. Over a step with `x = Δξ/τ` the solution is
//! `d ← φ₀(x) d + φ₁(x) Δe` (R. L. Taylor, K. S. Pister and G. L. Goudreau 1970, doi 10.1002/nme.1620020106), and the
//! energy that a branch dissipates is a quadratic form of d and Δe, integrated exactly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{PlasticHistory, PointConstants, PointTangent, Shift};
use crate::limits::{plausible, positive, within};
use crate::math::exponential::weights;

/// A branch of the generalised Maxwell model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ fraction = g, time = τ }`")]
pub struct Branch {
    /// Part g of the instantaneous modulus that relaxes with this time [1].
    #[schemars(transform = within(0.0, 1.0, "1", "the fraction of a modulus").low_open()
        .condition("all of a list at most 1"))]
    pub fraction: f64,
    /// Relaxation time τ at the reference temperature of the shift [s].
    #[schemars(transform = positive("s", "the relaxation time").plausible(&plausible::RELAXATION_TIME))]
    pub time: f64,
}

/// Branches of a modulus.
#[derive(Debug, Clone, PartialEq)]
struct Spectrum {
    /// Fraction of the modulus that remains.
    lasting: f64,
    branches: Vec<Branch>,
}

/// Relaxation of the shear and bulk moduli.
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxation {
    shear: Spectrum,
    bulk: Spectrum,
    shift: Option<Shift>,
}

/// Response of a point that relaxes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxed {
    /// Stress of the change of shape [Pa].
    pub stress: [f64; 6],
    /// Stress of the change of volume, tension positive [Pa].
    pub pressure: f64,
    pub tangent: PointTangent,
}

/// Stress of a point that relaxes, at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Present {
    pub stress: [f64; 6],
    pub pressure: f64,
    /// Elastic energy per volume of all branches [J/m³].
    pub stored: f64,
}

/// Number of components of a change of shape.
const SIX: usize = 6;

/// `a:b` of two changes of shape with engineering shears, or the product of two numbers.
fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).enumerate().map(|(i, (a, b))| if i < 3 { a * b } else { 0.5 * a * b }).sum()
}

/// `∫ d:d dt/τ` over a step from the weights, the strain before and its change.
fn lost(x: f64, [before, change]: [&[f64]; 2]) -> f64 {
    let [decay, first, _, third, _] = weights(x);
    let [_, first_of_twice, _, third_of_twice, _] = weights(2.0 * x);
    let square = 0.5 * (1.0 - decay) * (1.0 + decay);
    let square = if x < 1.0 { x * first_of_twice } else { square };
    let cross = first * if x < 1.0 { x * first } else { 1.0 - decay };
    // `(1 − 2 φ₁(x) + φ₁(2x))/x`, for small x without cancellation.
    let of_change = if x < 1.0 {
        2.0 * x * (2.0 * third_of_twice - third)
    } else {
        (1.0 - 2.0 * first + first_of_twice) / x
    };
    square * inner(before, before)
        + cross * inner(before, change)
        + of_change * inner(change, change)
}

impl Spectrum {
    fn new(branches: &[Branch]) -> Self {
        let relaxing: f64 = branches.iter().map(|branch| branch.fraction).sum();
        Self { lasting: (1.0 - relaxing).max(0.0), branches: branches.to_vec() }
    }

    /// Fraction of the modulus that acts on a change of strain.
    fn acting(&self, reduced_time: f64) -> f64 {
        let part = |branch: &Branch| branch.fraction * weights(reduced_time / branch.time)[1];
        self.lasting + self.branches.iter().map(part).sum::<f64>()
    }

    /// Advances the elastic strains of all branches, of `now.len()` components each; returns the dissipated energy over
    /// the modulus.
    fn advance(
        &self,
        reduced_time: f64,
        [before, now]: [&[f64]; 2],
        old: &[f64],
        new: &mut [f64],
    ) -> f64 {
        let size = now.len();
        let mut change = [0.0; SIX];
        change.iter_mut().zip(now.iter().zip(before)).for_each(|(c, (now, old))| *c = now - old);
        let change = &change[..size];
        let mut dissipated = 0.0;
        let pairs = old.chunks_exact(size).zip(new.chunks_exact_mut(size));
        for (Branch { fraction, time }, (old, new)) in self.branches.iter().zip(pairs) {
            let x = reduced_time / time;
            let [decay, first, ..] = weights(x);
            for ((new, old), change) in new.iter_mut().zip(old).zip(change) {
                *new = decay * old + first * change;
            }
            dissipated += fraction * lost(x, [old, change]);
        }
        dissipated
    }

    /// Stress over the modulus of a strain `now`, after a step that ended at the strain `at`.
    fn stress(&self, [at, now]: [&[f64]; 2], history: &[f64], out: &mut [f64]) {
        let size = now.len();
        for (i, out) in out.iter_mut().enumerate() {
            let of_branches = self.branches.iter().zip(history.chunks_exact(size));
            let sum: f64 = of_branches.map(|(own, strain)| own.fraction * strain[i]).sum();
            // What changed since then is elastic.
            *out = self.lasting * at[i] + sum + (now[i] - at[i]);
        }
    }

    /// Elastic energy over half of the modulus.
    fn stored(&self, [at, now]: [&[f64]; 2], history: &[f64]) -> f64 {
        let size = now.len();
        let mut all = self.lasting * inner(now, now);
        for (own, strain) in self.branches.iter().zip(history.chunks_exact(size)) {
            let mut moved = [0.0; SIX];
            for (i, moved) in moved[..size].iter_mut().enumerate() {
                *moved = strain[i] + (now[i] - at[i]);
            }
            all += own.fraction * inner(&moved[..size], &moved[..size]);
        }
        all
    }
}

impl Relaxation {
    /// Creates the model of a shear and a bulk modulus.
    pub fn new(shear: &[Branch], bulk: &[Branch], shift: Option<Shift>) -> Self {
        Self { shear: Spectrum::new(shear), bulk: Spectrum::new(bulk), shift }
    }

    /// Reduced time over a duration [s] in which the temperature changes linearly [K].
    pub fn reduced_time(&self, temperatures: [f64; 2], duration: f64) -> f64 {
        self.shift.map_or(duration, |shift| shift.reduced_time(temperatures, duration))
    }

    /// Returns the effect of a temperature within a duration [s] that differs from an even change [K], relative to the
    /// stress of a change of temperature [K] and to that at its beginning.
    ///
    /// A strain that is off by δ in the middle but not at the ends leaves of it `x/(1 + x²)` in a branch, to first
    /// order for short and for long durations.
    pub fn unevenness(&self, [even, now]: [f64; 2], duration: f64, change: f64) -> f64 {
        let time = self.reduced_time([even; 2], duration);
        let left = |spectrum: &Spectrum| -> f64 {
            let of_branch = |branch: &Branch| {
                let x = time / branch.time;
                branch.fraction / (x + x.recip())
            };
            spectrum.branches.iter().map(of_branch).sum()
        };
        let slower = |shift: Shift| (shift.logarithm(now) - shift.logarithm(even)).abs();
        let of_time = self.shift.map_or(0.0, slower).min(1.0);
        left(&self.shear).max(left(&self.bulk)) * ((now - even).abs() / change + of_time)
    }

    /// Length of the history beyond [`PlasticHistory`]: the strains θ and e, then those of the branches.
    pub fn history_len(&self) -> usize {
        1 + SIX + self.bulk.branches.len() + SIX * self.shear.branches.len()
    }

    /// Splits a history into θ, e and the strains of the branches in bulk and in shear.
    fn parts<'h>(&self, history: &'h [f64]) -> [&'h [f64]; 4] {
        let own = &history[PlasticHistory::LEN..PlasticHistory::LEN + self.history_len()];
        let (volume, own) = own.split_at(1);
        let (shape, own) = own.split_at(SIX);
        let (in_bulk, in_shear) = own.split_at(self.bulk.branches.len());
        [volume, shape, in_bulk, in_shear]
    }

    /// Computes stress and history after a step to a change of shape and a change of volume, with constants over that
    /// step.
    pub fn respond(
        &self,
        own: &PointConstants,
        (shape, dilatation): (&[f64; SIX], f64),
        old: &[f64],
        new: &mut [f64],
    ) -> Relaxed {
        new.copy_from_slice(old);
        let [volume_before, shape_before, old_bulk, old_shear] = self.parts(old);
        let (_, rest) = new.split_at_mut(PlasticHistory::LEN);
        let (strains, branches) = rest.split_at_mut(1 + SIX);
        strains[0] = dilatation;
        strains[1..].copy_from_slice(shape);
        let (new_bulk, new_shear) = branches.split_at_mut(self.bulk.branches.len());
        let time = own.reduced_time;
        let volumes = [volume_before, &[dilatation]];
        let lost_in_bulk = self.bulk.advance(time, volumes, old_bulk, new_bulk);
        let shapes: [&[f64]; 2] = [shape_before, shape];
        let lost_in_shear = self.shear.advance(time, shapes, old_shear, new_shear);
        let mut history = PlasticHistory::read(new);
        history.dissipated += own.bulk * lost_in_bulk + 2.0 * own.shear * lost_in_shear;
        history.write(&mut new[..PlasticHistory::LEN]);
        let Present { stress, pressure, .. } = self.present(own, (shape, dilatation), new);
        Relaxed { stress, pressure, tangent: self.tangent(own) }
    }

    /// Tangent over a step.
    pub fn tangent(&self, own: &PointConstants) -> PointTangent {
        let [bulk, shear] = [&self.bulk, &self.shear].map(|part| part.acting(own.reduced_time));
        let (bulk, all) = (own.bulk * bulk, 2.0 * own.shear * shear);
        PointTangent { bulk, all, along: 0.0, direction: [0.0; SIX] }
    }

    /// Computes stress and energy of a change of shape and of volume; what differs from those of the history is
    /// elastic.
    pub fn present(
        &self,
        own: &PointConstants,
        (shape, dilatation): (&[f64; SIX], f64),
        history: &[f64],
    ) -> Present {
        let [volume_at, shape_at, in_bulk, in_shear] = self.parts(history);
        let volumes = [volume_at, &[dilatation]];
        let shapes: [&[f64]; 2] = [shape_at, shape];
        let (mut elastic, mut elastic_volume) = ([0.0; SIX], [0.0]);
        self.shear.stress(shapes, in_shear, &mut elastic);
        self.bulk.stress(volumes, in_bulk, &mut elastic_volume);
        let stored = own.shear * self.shear.stored(shapes, in_shear)
            + 0.5 * own.bulk * self.bulk.stored(volumes, in_bulk);
        let stress = own.elastic_tangent().of_shape(&elastic);
        Present { stress, pressure: own.bulk * elastic_volume[0], stored }
    }

    /// Largest difference of elastic strains and changes of shape between two histories, and the largest of the second.
    pub fn difference(&self, one: &[f64], other: &[f64]) -> [f64; 2] {
        let pairs =
            self.parts(one).into_iter().flatten().zip(self.parts(other).into_iter().flatten());
        pairs.fold([0.0_f64; 2], |[off, most], (a, b)| {
            let own = (a - b).abs();
            // A NaN has to remain.
            [if own.is_nan() { own } else { off.max(own) }, most.max(b.abs())]
        })
    }
}

#[cfg(test)]
mod tests;

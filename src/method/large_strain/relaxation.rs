//! Elastic strains of relaxing points over a step.

use super::{Courses, Deformable};
use crate::laws::solid::large_strain::{Deviator, MaxwellBranch, Relaxing};

impl Deformable {
    /// Returns true if stress relaxes in part of the body.
    pub fn relaxes(&self) -> bool {
        self.layers.iter().any(|layer| branches(&layer.law.deviator).is_some())
    }

    /// Largest time of a step over the shortest relaxation time there.
    pub fn relaxation_over(&self, over: &Courses) -> f64 {
        let of_group = |group: usize| {
            let shortest = branches(&self.law_of(group).deviator)?
                .iter()
                .map(|branch| branch.time)
                .fold(f64::INFINITY, f64::min);
            Some(over.at(self, group).time / shortest)
        };
        (0..self.space.groups.len()).filter_map(of_group).fold(0.0, f64::max)
    }

    /// Largest difference of the elastic strains S̃/(2µ) of relaxing points between two histories, and the largest of
    /// these strains.
    pub fn relaxing_strains(&self, one: &[f64], other: &[f64]) -> [f64; 2] {
        let mut found = [0.0_f64; 2];
        for group in 0..self.space.groups.len() {
            let law = self.law_of(group);
            if branches(&law.deviator).is_none() {
                continue;
            }
            let [own, others] = [one, other]
                .map(|history| history[self.history_of(group)].chunks_exact(law.history()));
            for (one, other) in own.zip(others) {
                for (a, b) in one[..6].iter().zip(&other[..6]) {
                    let [off, size] =
                        [(a - b).abs(), a.abs().max(b.abs())].map(|s| 0.5 * s / law.shear);
                    // A NaN has to remain.
                    found[0] = if off.is_nan() { off } else { found[0].max(off) };
                    found[1] = found[1].max(size);
                }
            }
        }
        found
    }
}

/// Branches of a law that relaxes.
fn branches(deviator: &Deviator) -> Option<&[MaxwellBranch]> {
    match deviator {
        Deviator::Relaxing(Relaxing { branches }) if !branches.is_empty() => Some(branches),
        _ => None,
    }
}

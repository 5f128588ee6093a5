//! Weights of pairs in the sums of viscosity.

use crate::kernel::{Kernel, WendlandC2};

/// Kernel of the weights. Any is valid with its moments, so one suffices for all models.
pub const KERNEL: Kernel = Kernel::WendlandC2;
/// Shape of that kernel.
pub const SHAPE: WendlandC2 = WendlandC2;
/// Radius of the weights over the distance of particles. The error of strain rates grows with its square; in disorder,
/// fewer neighbours would leave directions unresolved.
const REACH: f64 = 2.0;

/// Weights `−F(s q)` with F = w′(q)/q of the kernel, zero beyond a radius H/s.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    /// σ of the kernel.
    pub normalisation: f64,
    /// s.
    pub narrowing: f64,
    /// c of the fourth moments `c (δδ + δδ + δδ)` of a full neighbourhood.
    pub moment: f64,
}

impl Weights {
    /// Weights of a model with these dimensions and distance of particles over H.
    pub fn of(dimension: usize, spacing: f64) -> Self {
        let narrowing = (1.0 / (REACH * spacing)).max(1.0);
        let moment = KERNEL.second_moment(dimension) / dimension as f64;
        Self {
            normalisation: KERNEL.scale(1.0, dimension),
            narrowing,
            moment: moment / narrowing.powi(dimension as i32 + 4),
        }
    }

    /// Radius over H from which on weights are zero.
    pub fn reach(&self) -> f64 {
        1.0 / self.narrowing
    }
}

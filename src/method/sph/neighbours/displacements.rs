//! Displacements that lists of neighbours are to outlast.

use crate::method::sph::order::{BLOCK, Bounds};
use crate::runtime::parallel::Team;

/// Predicted displacements of each block's particles: the bounding box of all.
pub struct Displacements {
    pub of_blocks: Vec<Bounds>,
    /// Number of further steps for which new lists are to serve.
    pub steps: f64,
}

impl Displacements {
    /// Boxes of these displacements.
    pub fn along(displacements: &[[f64; 3]], steps: f64, team: &Team) -> Self {
        let of_block = |b: usize| {
            let range = b * BLOCK..((b + 1) * BLOCK).min(displacements.len());
            Bounds::of(displacements[range].iter().copied())
        };
        Self { of_blocks: team.map(displacements.len().div_ceil(BLOCK), of_block), steps }
    }

    /// Displacements over a time, from velocities.
    pub fn times(mut self, dt: f64) -> Self {
        for Bounds { low, high } in &mut self.of_blocks {
            low.iter_mut().chain(high).for_each(|v| *v *= dt);
        }
        self
    }

    /// No displacements.
    pub fn none(particles: usize) -> Self {
        let nowhere = Bounds { low: [0.0; 3], high: [0.0; 3] };
        Self { of_blocks: vec![nowhere; particles.div_ceil(BLOCK)], steps: f64::INFINITY }
    }
}

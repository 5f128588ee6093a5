//! Points sorted for searches near a box.

use super::candidates::{Candidates, Near, Numbers, RelativePoints};
use super::images::Image;
use super::order::{BLOCK, BlockTree, Bounds};
use crate::runtime::parallel::Team;

/// Points sorted into blocks.
pub struct Field {
    tree: BlockTree,
    spots: Vec<RelativePoints>,
}

impl Field {
    pub fn of(points: &[[f64; 3]], team: &Team) -> Self {
        let blocks: Vec<_> = points.chunks(BLOCK).collect();
        let spots = team.map(blocks.len(), |b| RelativePoints::of(blocks[b]));
        Self { tree: BlockTree::over(points, team), spots }
    }

    /// Appends the points whose images come nearer to a box than `reach`.
    pub fn take(&self, (bounds, reach): (&Bounds, f64), image: &Image, nearby: &mut Nearby) {
        let Nearby { candidates, blocks, indices, .. } = nearby;
        blocks.clear();
        self.tree.near(bounds, image, reach, blocks);
        let (centre, near) = (bounds.centre(), Near::to(bounds, reach));
        for &b in &*blocks {
            candidates.take_images(&self.spots[b], image, centre, near);
            let index = |&k: &u32| (b * BLOCK) as u32 + k;
            indices.extend(candidates.last_numbers().iter().map(index));
        }
    }
}

/// Points near a box. Its memory is reused from one box to the next.
#[derive(Default)]
pub struct Nearby {
    pub centre: [f64; 3],
    candidates: Candidates,
    blocks: Vec<usize>,
    indices: Vec<u32>,
}

impl Nearby {
    /// Discards the points near another box.
    pub fn clear(&mut self, bounds: &Bounds) {
        self.centre = bounds.centre();
        self.candidates.clear();
        self.indices.clear();
    }

    /// Indices of all points taken from fields, in their order.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Takes from other points those near a box that lies within their box.
    pub fn narrow(&mut self, others: &mut Nearby, bounds: &Bounds, reach: f64) {
        self.clear(bounds);
        let shift = [0, 1, 2].map(|a| (others.centre[a] - self.centre[a]) as f32);
        let (_, points) = others.candidates.all();
        self.candidates.take(points, [1.0; 3], shift, Near::to(bounds, reach));
    }

    /// Lists the numbers of the points near a box.
    pub fn near(&mut self, bounds: &Bounds, reach: f64, numbers: &mut Numbers) {
        let centre = bounds.centre();
        let shift = [0, 1, 2].map(|a| (self.centre[a] - centre[a]) as f32);
        self.candidates.narrow(shift, Near::to(bounds, reach), numbers);
    }

    /// Numbers, in the other list, of all points taken from it.
    pub fn numbers(&self) -> &[u32] {
        self.candidates.last_numbers()
    }
}

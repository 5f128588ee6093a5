//! Spatial order of particles: blocks of a balanced k-d tree.

use std::ops::Range;

use super::images::Image;
use crate::runtime::parallel::Team;

/// Particles in a block; the last block may have fewer.
pub const BLOCK: usize = 128;
/// Number of particles in a group, within a block.
pub const GROUP: usize = 16;

/// Corners of a box along x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

/// A tree over blocks of particles in its order.
#[derive(Debug, Clone, Default)]
pub struct BlockTree {
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, PartialEq)]
struct Node {
    bounds: Bounds,
    /// Indices of the two parts, or the block of a leaf.
    parts: Parts,
}

#[derive(Debug, Clone, PartialEq)]
enum Parts {
    Two([usize; 2]),
    Block(usize),
}

impl Bounds {
    /// The bounding box of some points; the box of no points contains nothing.
    pub fn of(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let none = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        points.fold(none, |bounds, point| Self {
            low: [0, 1, 2].map(|a| bounds.low[a].min(point[a])),
            high: [0, 1, 2].map(|a| bounds.high[a].max(point[a])),
        })
    }

    pub fn joined(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|a| self.low[a].min(other.low[a])),
            high: [0, 1, 2].map(|a| self.high[a].max(other.high[a])),
        }
    }

    /// The box enlarged on both sides by `by`.
    pub fn widened(&self, by: [f64; 3]) -> Self {
        Self {
            low: [0, 1, 2].map(|a| self.low[a] - by[a]),
            high: [0, 1, 2].map(|a| self.high[a] + by[a]),
        }
    }

    pub fn image(&self, image: &Image) -> Self {
        Self::between(image.place(self.low), image.place(self.high))
    }

    /// The image of a box of vectors.
    pub fn turned(&self, image: &Image) -> Self {
        Self::between(image.turn(self.low), image.turn(self.high))
    }

    fn between(a: [f64; 3], b: [f64; 3]) -> Self {
        Self { low: [0, 1, 2].map(|n| a[n].min(b[n])), high: [0, 1, 2].map(|n| a[n].max(b[n])) }
    }

    pub fn centre(&self) -> [f64; 3] {
        [0, 1, 2].map(|a| 0.5 * (self.low[a] + self.high[a]))
    }

    pub fn diagonal(&self) -> f64 {
        (0..3).map(|a| (self.high[a] - self.low[a]).powi(2)).sum::<f64>().sqrt()
    }

    fn gap_squared(&self, other: &Self) -> f64 {
        let gap = |a: usize| (self.low[a] - other.high[a]).max(other.low[a] - self.high[a]);
        (0..3).map(|a| gap(a).max(0.0).powi(2)).sum()
    }
}

/// The order that sorts `points` into blocks, and those of a block into groups.
pub fn space_order(points: &[[f64; 3]], team: &Team) -> Vec<u32> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    // One thread splits each half, so there must be enough halves first.
    let mut parts = vec![&mut order[..]];
    while team.threads() > 1 && parts.len() < 4 * team.threads() {
        let halves = team.map_each(&mut parts, |part| split(points, std::mem::take(part)));
        let before = halves.len();
        parts = halves.into_iter().flatten().filter(|part| !part.is_empty()).collect();
        if parts.len() == before {
            break;
        }
    }
    team.for_each(&mut parts, |_, part| order_within(points, part));
    order
}

/// Splits an order in two, so that the first part has whole blocks, or within a block whole groups;
/// a group is not split.
fn split<'a>(points: &[[f64; 3]], order: &'a mut [u32]) -> [&'a mut [u32]; 2] {
    let size = if order.len() > BLOCK { BLOCK } else { GROUP };
    if order.len() <= size {
        return [order, &mut []];
    }
    let bounds = Bounds::of(order.iter().map(|&i| points[i as usize]));
    let extent = [0, 1, 2].map(|a| bounds.high[a] - bounds.low[a]);
    let axis = (1..3).fold(0, |best, a| if extent[a] > extent[best] { a } else { best });
    let place = |&i: &u32| points[i as usize][axis];
    let middle = left(order.len().div_ceil(size)) * size;
    // Ties are broken by the index, so that equal points have one order.
    order.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
    order.split_at_mut(middle).into()
}

fn order_within(points: &[[f64; 3]], order: &mut [u32]) {
    if order.len() > GROUP {
        split(points, order).into_iter().for_each(|half| order_within(points, half));
    }
}

/// Number of blocks of the first half.
fn left(blocks: usize) -> usize {
    blocks / 2
}

impl BlockTree {
    /// Tree over points that are, or were, in [`space_order`].
    pub fn over(points: &[[f64; 3]], team: &Team) -> Self {
        let mut tree = Self::default();
        if !points.is_empty() {
            tree.grow(0..points.len().div_ceil(BLOCK));
            tree.refit(points, team);
        }
        tree
    }

    /// Adds the subtree for some blocks, with empty boxes; returns its index.
    fn grow(&mut self, blocks: Range<usize>) -> usize {
        let (index, bounds) = (self.nodes.len(), Bounds::of([].into_iter()));
        self.nodes.push(Node { bounds, parts: Parts::Block(blocks.start) });
        if blocks.len() > 1 {
            let middle = blocks.start + left(blocks.len());
            let parts = [blocks.start..middle, middle..blocks.end].map(|half| self.grow(half));
            self.nodes[index].parts = Parts::Two(parts);
        }
        index
    }

    /// Blocks whose boxes' images come nearer to `bounds` than `reach`, in their order.
    pub fn near(&self, bounds: &Bounds, image: &Image, reach: f64, found: &mut Vec<usize>) {
        if !self.nodes.is_empty() {
            // Images keep distances, so the originals can be searched instead.
            self.search(0, &bounds.image(&image.inverse()), reach * reach, found);
        }
    }

    /// Updates the boxes for points that have moved.
    pub fn refit(&mut self, points: &[[f64; 3]], team: &Team) {
        let boxes = team.map(points.len().div_ceil(BLOCK), |block| {
            let range = block * BLOCK..((block + 1) * BLOCK).min(points.len());
            Bounds::of(points[range].iter().copied())
        });
        // Parts come after the nodes that contain them.
        for node in (0..self.nodes.len()).rev() {
            self.nodes[node].bounds = match self.nodes[node].parts {
                Parts::Block(block) => boxes[block],
                Parts::Two([a, b]) => self.nodes[a].bounds.joined(&self.nodes[b].bounds),
            };
        }
    }

    /// Volume within reach of the boxes, summed over blocks.
    pub fn surrounded(&self, reach: f64) -> f64 {
        let volume = |node: &Node| match node.parts {
            Parts::Block(_) => {
                let extent = |a: usize| node.bounds.high[a] - node.bounds.low[a] + 2.0 * reach;
                (0..3).map(extent).product()
            }
            Parts::Two(_) => 0.0,
        };
        self.nodes.iter().map(volume).sum()
    }

    fn search(&self, node: usize, bounds: &Bounds, reach_squared: f64, found: &mut Vec<usize>) {
        let node = &self.nodes[node];
        if node.bounds.gap_squared(bounds) > reach_squared {
            return;
        }
        match node.parts {
            Parts::Block(block) => found.push(block),
            Parts::Two(parts) => {
                parts.into_iter().for_each(|part| self.search(part, bounds, reach_squared, found));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::sph::images::{Ends, Images};

    fn points(count: usize) -> Vec<[f64; 3]> {
        let number = |i: usize| (i as f64 * 0.754877666).fract();
        (0..count).map(|i| [number(i), 5.0 * number(7 * i + 3), 3.0 * number(13 * i + 5)]).collect()
    }

    #[test]
    fn every_point_is_in_exactly_one_block() {
        for count in [0, 1, BLOCK, BLOCK + 1, 1000] {
            let mut order = space_order(&points(count), &Team::new(1));
            assert_eq!(order, space_order(&points(count), &Team::new(5)));
            order.sort_unstable();
            assert_eq!(order, (0..count as u32).collect::<Vec<_>>());
        }
    }

    #[test]
    fn block_search_matches_brute_force() {
        let points = points(2000);
        let order = space_order(&points, &Team::new(1));
        let points: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let tree = BlockTree::over(&points, &Team::new(2));
        let block = |b: usize| {
            let range = b * BLOCK..((b + 1) * BLOCK).min(points.len());
            Bounds::of(points[range].iter().copied())
        };
        let blocks = points.len().div_ceil(BLOCK);
        let ends = [Ends::Planes { near: true, far: None }, Ends::Period(5.0), Ends::Period(3.0)];
        let images = Images::new(ends, false, [0.0; 3]);
        for image in images.codes().iter().map(|&code| images.get(code)) {
            for b in 0..blocks {
                let mut found = Vec::new();
                tree.near(&block(b), image, 0.5, &mut found);
                let all: Vec<usize> = (0..blocks)
                    .filter(|&c| block(c).image(image).gap_squared(&block(b)) <= 0.5 * 0.5)
                    .collect();
                assert_eq!(found, all);
            }
        }
    }
}

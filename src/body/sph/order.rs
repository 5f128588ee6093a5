//! Particles in an order in which near ones stand together: blocks of a balanced k-d tree.

use super::images::Image;
use crate::math::parallel;

/// Particles in a block; the last block may have fewer.
pub const BLOCK: usize = 128;

/// Corners of a box along x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

/// A tree over blocks of particles that stand in its order.
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
    /// The smallest box round some points; nothing lies in the box of none.
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

/// The order that puts `points` into blocks, and the tree over the blocks.
pub fn space_order(points: &[[f64; 3]], threads: usize) -> (Vec<u32>, BlockTree) {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let mut tree = BlockTree::default();
    if !points.is_empty() {
        tree.nodes = grown(points, &mut order, 0, threads);
    }
    (order, tree)
}

/// The part of the tree for some of the points, its root first; puts them in order.
fn grown(points: &[[f64; 3]], order: &mut [u32], first_block: usize, threads: usize) -> Vec<Node> {
    let bounds = Bounds::of(order.iter().map(|&i| points[i as usize]));
    let mut nodes = vec![Node { bounds, parts: Parts::Block(first_block) }];
    if order.len() > BLOCK {
        let left = order.len().div_ceil(BLOCK) / 2;
        let extent = [0, 1, 2].map(|a| bounds.high[a] - bounds.low[a]);
        let axis = (1..3).fold(0, |best, a| if extent[a] > extent[best] { a } else { best });
        let place = |&i: &u32| points[i as usize][axis];
        // Ties are broken by the index, so that equal points have one order.
        order.select_nth_unstable_by(left * BLOCK, |a, b| {
            place(a).total_cmp(&place(b)).then(a.cmp(b))
        });
        let (low, high) = order.split_at_mut(left * BLOCK);
        let mut halves = [(low, first_block), (high, first_block + left)];
        let [low, high] = match threads {
            0 | 1 => halves.map(|(order, first)| grown(points, order, first, 1)),
            _ => {
                let grow = |(order, first): &mut (&mut [u32], usize)| {
                    grown(points, order, *first, threads / 2)
                };
                let grown = parallel::map_each(2, &mut halves, grow);
                grown.try_into().expect("there are two halves")
            }
        };
        let starts = [1, 1 + low.len()];
        nodes[0].parts = Parts::Two(starts);
        for (part, start) in [low, high].into_iter().zip(starts) {
            nodes.extend(part.into_iter().map(|node| node.moved(start)));
        }
    }
    nodes
}

impl Node {
    /// The node in a list in which its part of the tree begins at `start`.
    fn moved(self, start: usize) -> Self {
        let parts = match self.parts {
            Parts::Two(parts) => Parts::Two(parts.map(|part| part + start)),
            block => block,
        };
        Self { parts, ..self }
    }
}

impl BlockTree {
    /// Blocks of whose boxes the images come nearer to `bounds` than `reach`, in their order.
    pub fn near(&self, bounds: &Bounds, image: &Image, reach: f64, found: &mut Vec<usize>) {
        if !self.nodes.is_empty() {
            // Images keep distances, so the search may be among the originals.
            self.search(0, &bounds.image(&image.inverse()), reach * reach, found);
        }
    }

    /// Fits the boxes to points that have moved.
    pub fn refit(&mut self, points: &[[f64; 3]]) {
        // Parts stand behind what they are parts of.
        for node in (0..self.nodes.len()).rev() {
            self.nodes[node].bounds = match self.nodes[node].parts {
                Parts::Block(block) => {
                    let range = block * BLOCK..((block + 1) * BLOCK).min(points.len());
                    Bounds::of(points[range].iter().copied())
                }
                Parts::Two([a, b]) => self.nodes[a].bounds.joined(&self.nodes[b].bounds),
            };
        }
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
    use crate::body::sph::images::{Ends, Images};

    fn points(count: usize) -> Vec<[f64; 3]> {
        let number = |i: usize| (i as f64 * 0.754877666).fract();
        (0..count).map(|i| [number(i), 5.0 * number(7 * i + 3), 3.0 * number(13 * i + 5)]).collect()
    }

    #[test]
    fn every_point_stands_in_one_block() {
        for count in [0, 1, 64, 65, 1000] {
            let (mut order, tree) = space_order(&points(count), 1);
            let (same, other) = space_order(&points(count), 5);
            assert!(same == order && other.nodes == tree.nodes);
            order.sort_unstable();
            assert_eq!(order, (0..count as u32).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_search_finds_the_blocks_that_a_loop_over_all_finds() {
        let points = points(2000);
        let (order, tree) = space_order(&points, 1);
        let block = |b: usize| {
            let range = b * BLOCK..((b + 1) * BLOCK).min(order.len());
            Bounds::of(order[range].iter().map(|&i| points[i as usize]))
        };
        let blocks = order.len().div_ceil(BLOCK);
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

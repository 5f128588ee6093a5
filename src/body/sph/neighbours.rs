//! Which particles and images lie near which: for every block a list of what surrounds it, and for
//! every particle a list of places in that.
//!
//! Lengths are in units of the support radius. The lists reach farther than the kernel by a skin, so
//! that they serve until neighbours have moved against each other by its width.

use super::lanes::WIDTH;
use super::order::{BLOCK, BlockTree, Bounds, space_order};
use crate::math::parallel;

/// Reach of the lists beyond the kernel.
const SKIN: f64 = 0.1;
/// Share of the skin that rounding in single precision could use.
const MARGIN: f64 = 1e-5;

/// Mirrors of the model as bits of an image: x = 0, y = 0, and the wall z = 0.
pub const WALL: u8 = 4;

/// A particle, or its image at some mirrors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source(u32);

impl Source {
    fn new(particle: usize, image: u8) -> Self {
        Self((particle as u32) << 3 | u32::from(image))
    }

    #[inline(always)]
    pub fn particle(self) -> usize {
        (self.0 >> 3) as usize
    }

    #[inline(always)]
    pub fn image(self) -> u8 {
        (self.0 & 7) as u8
    }
}

/// Particles that stand together and all that surrounds them.
pub struct Block {
    /// Index of the first particle.
    pub first: usize,
    pub count: usize,
    /// Origin of local coordinates.
    pub centre: [f64; 3],
    /// The particles' neighbours, themselves included, first without and then with an image at the
    /// wall. Place 0 of local copies is nowhere, so the k-th source has place k + 1.
    pub sources: Vec<Source>,
    /// Places of neighbours, in runs whose lengths are multiples of [`WIDTH`].
    places: Vec<u16>,
    /// For each particle the ends of its runs: neighbours, and images at the wall.
    ends: Vec<[u32; 2]>,
    /// The blocks that the sources come from.
    surroundings: Vec<(usize, u8)>,
}

/// Neighbours of all particles.
#[derive(Default)]
pub struct Neighbours {
    pub blocks: Vec<Block>,
    /// Places of the particles when the lists were made.
    reference: Vec<[f64; 3]>,
}

impl Block {
    /// Places of the neighbours of the k-th particle of the block: fluid, and images at the wall.
    #[inline(always)]
    pub fn neighbours(&self, k: usize) -> [&[[u16; WIDTH]]; 2] {
        let start = if k == 0 { 0 } else { self.ends[k - 1][1] as usize };
        let [middle, end] = self.ends[k].map(|end| end as usize);
        [start..middle, middle..end].map(|range| self.places[range].as_chunks().0)
    }

    /// Number of neighbours within the reach of the lists, places that fill up runs left out.
    pub fn listed(&self) -> usize {
        self.places.iter().filter(|&&place| place != 0).count()
    }
}

impl Neighbours {
    /// Puts particles into blocks: the order in which all their numbers have to stand for
    /// [`Self::of_ordered`].
    pub fn order(points: &[[f64; 3]]) -> (Vec<u32>, BlockTree) {
        space_order(points)
    }

    /// Lists the neighbours of particles that stand in the order of the tree's blocks. `mirrors`
    /// holds the bits of the mirrors of the model.
    pub fn of_ordered(
        points: Vec<[f64; 3]>,
        tree: &BlockTree,
        mirrors: u8,
        threads: usize,
    ) -> Self {
        let blocks = points.len().div_ceil(BLOCK);
        let block = |b: usize| list(b * BLOCK, &points, tree, mirrors);
        let blocks = parallel::map(threads, blocks, block);
        Self { blocks, reference: points }
    }

    /// Whether the lists still hold all neighbours when the particles are at `points`.
    pub fn serve(&self, points: impl Fn(usize) -> [f64; 3]) -> bool {
        let moved = |block: &Block| {
            let range = block.first..block.first + block.count;
            Bounds::of(range.map(|i| {
                let (now, then) = (points(i), self.reference[i]);
                [0, 1, 2].map(|a| now[a] - then[a])
            }))
        };
        let moved: Vec<Bounds> = self.blocks.iter().map(moved).collect();
        self.blocks.iter().all(|block| {
            let around = block.surroundings.iter().fold(moved[block.first / BLOCK], |sum, part| {
                sum.joined(&moved[part.0].mirrored(part.1))
            });
            let span = (0..3).map(|a| (around.high[a] - around.low[a]).powi(2)).sum::<f64>();
            span < (SKIN - MARGIN).powi(2)
        })
    }
}

/// Lists what surrounds the block of particles from `first` on.
fn list(first: usize, points: &[[f64; 3]], tree: &BlockTree, mirrors: u8) -> Block {
    let count = BLOCK.min(points.len() - first);
    let own = &points[first..first + count];
    let bounds = Bounds::of(own.iter().copied());
    let reach = 1.0 + SKIN;
    let mut surroundings = Vec::new();
    let mut found = Vec::new();
    // The wall is the highest bit, so its images come last.
    for image in (0..8).filter(|image| image & !mirrors == 0) {
        found.clear();
        tree.near(&bounds, image, reach, &mut found);
        surroundings.extend(found.iter().map(|&block| (block, image)));
    }
    let mut sources = Vec::new();
    let mut wall = 0;
    for &(block, image) in &surroundings {
        let near = bounds.mirrored(image);
        for j in block * BLOCK..((block + 1) * BLOCK).min(points.len()) {
            if near.distance_squared(points[j]) <= reach * reach {
                sources.push(Source::new(j, image));
            }
        }
        if image & WALL == 0 {
            wall = sources.len();
        }
    }
    let centre = bounds.centre();
    let local = Places::of(&sources, points, centre);
    let mut block = Block {
        first,
        count,
        centre,
        places: Vec::with_capacity(count * 160),
        ends: Vec::with_capacity(count),
        sources,
        surroundings,
    };
    for point in own {
        let at = [0, 1, 2].map(|a| (point[a] - centre[a]) as f32);
        let ends = [0..wall, wall..block.sources.len()].map(|part| {
            local.near(at, part, (reach * reach) as f32, &mut block.places);
            let full = block.places.len().next_multiple_of(WIDTH);
            block.places.resize(full, 0);
            full as u32
        });
        block.ends.push(ends);
    }
    block
}

/// Places of the sources of a block about its centre, in single precision.
struct Places {
    along: [Vec<f32>; 3],
}

impl Places {
    fn of(sources: &[Source], points: &[[f64; 3]], centre: [f64; 3]) -> Self {
        let along = |a: usize| {
            let place = |source: &Source| {
                let at = points[source.particle()][a];
                let at = if source.image() >> a & 1 == 1 { -at } else { at };
                (at - centre[a]) as f32
            };
            sources.iter().map(place).collect()
        };
        Self { along: [along(0), along(1), along(2)] }
    }

    /// Appends the places within reach of a point.
    fn near(
        &self,
        at: [f32; 3],
        part: std::ops::Range<usize>,
        reach_squared: f32,
        places: &mut Vec<u16>,
    ) {
        let [x, y, z] = self.along.each_ref().map(|along| &along[part.clone()]);
        let start = places.len();
        places.resize(start + part.len() + WIDTH, 0);
        let mut end = start;
        for k in 0..x.len() {
            let d = [x[k] - at[0], y[k] - at[1], z[k] - at[2]];
            let near = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_squared;
            // Without a branch: written always, kept only if near.
            places[end] = (part.start + k + 1) as u16;
            end += usize::from(near);
        }
        places.truncate(end);
    }
}

//! Which particles and images lie near which: for every block a list of what surrounds it, and for
//! every particle a list of places in that.
//!
//! Lengths are in units of the support radius. The lists reach farther than the kernel by a skin, so
//! that they serve until neighbours have moved against each other by its width.

use super::candidates::{Candidates, Near, Spots};
use super::images::{Images, Source};
use super::lanes::WIDTH;
use super::order::{BLOCK, BlockTree, Bounds, space_order};
use crate::math::parallel;

/// Reach of the lists beyond the kernel, in steps of the motion against neighbours; its bounds.
const SKIN_STEPS: f64 = 8.0;
const SKINS: [f64; 2] = [0.05, 0.3];
/// Share of the skin that rounding in single precision could use.
const MARGIN: f64 = 1e-5;
/// Growth of the surroundings at which the particles are sorted anew.
const GROWTH: f64 = 1.2;

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
    /// Blocks that hold all sources, with the codes of their images.
    surroundings: Vec<(usize, u8)>,
    /// How far neighbours may still move against each other.
    slack: f64,
}

/// Neighbours of all particles.
#[derive(Default)]
pub struct Neighbours {
    pub blocks: Vec<Block>,
    tree: BlockTree,
    /// Sources of all blocks when the particles were sorted.
    sorted_sources: usize,
}

impl Block {
    fn empty(first: usize, count: usize) -> Self {
        Self {
            first,
            count,
            centre: [0.0; 3],
            sources: Vec::new(),
            places: Vec::new(),
            ends: Vec::with_capacity(count),
            surroundings: Vec::new(),
            slack: f64::NAN,
        }
    }

    /// Places of the neighbours of the k-th particle of the block: fluid, and images at the wall.
    #[inline(always)]
    pub fn neighbours(&self, k: usize) -> [&[[u16; WIDTH]]; 2] {
        let start = if k == 0 { 0 } else { self.ends[k - 1][1] as usize };
        let [middle, end] = self.ends[k].map(|end| end as usize);
        [start..middle, middle..end].map(|range| self.places[range].as_chunks().0)
    }
}

impl Neighbours {
    /// Puts particles into blocks: the order in which all their numbers have to stand for
    /// [`Self::of_ordered`].
    pub fn order(points: &[[f64; 3]], threads: usize) -> (Vec<u32>, BlockTree) {
        space_order(points, threads)
    }

    /// Neighbours of particles that stand in the order of the tree's blocks; the lists are made when
    /// they are first needed.
    ///
    /// # Panics
    /// If there are more particles than [`Source::MOST`].
    pub fn of_ordered(tree: BlockTree, particles: usize) -> Self {
        assert!(particles <= Source::MOST, "{particles} particles, at most {}", Source::MOST);
        let block = |b: usize| Block::empty(b * BLOCK, BLOCK.min(particles - b * BLOCK));
        let blocks = (0..particles.div_ceil(BLOCK)).map(block).collect();
        Self { blocks, tree, sorted_sources: 0 }
    }

    /// Whether the particles have mixed so much that they should be sorted anew.
    pub fn are_scattered(&self) -> bool {
        self.sorted_sources > 0 && self.sources() as f64 > GROWTH * self.sorted_sources as f64
    }

    fn sources(&self) -> usize {
        self.blocks.iter().map(|block| block.sources.len()).sum()
    }

    /// Makes the lists hold all neighbours of particles at `points` and on their way along `ways`
    /// times `factor`.
    pub fn prepare(
        &mut self,
        points: &[[f64; 3]],
        ways: &[[f64; 3]],
        factor: f64,
        images: &Images,
        threads: usize,
    ) {
        let drifts = parallel::map(threads, self.blocks.len(), |b| {
            let range = b * BLOCK..((b + 1) * BLOCK).min(points.len());
            Bounds::of(ways[range].iter().map(|way| way.map(|w| factor * w)))
        });
        parallel::for_each(threads, &mut self.blocks, |_, block| {
            block.slack -= span(&drifts, &block.surroundings, images);
        });
        let is_worn = |block: &&mut Block| block.slack.is_nan() || block.slack < MARGIN;
        let mut worn: Vec<&mut Block> = self.blocks.iter_mut().filter(is_worn).collect();
        if worn.is_empty() {
            return;
        }
        self.tree.refit(points);
        let tree = &self.tree;
        let blocks: Vec<&[[f64; 3]]> = points.chunks(BLOCK).collect();
        let spots = parallel::map(threads, blocks.len(), |b| Spots::of(blocks[b]));
        parallel::for_each(threads, &mut worn, |_, block| {
            **block = list(block.first, points, &spots, &drifts, tree, images);
        });
        if self.sorted_sources == 0 {
            self.sorted_sources = self.sources();
        }
    }
}

/// How far particles of some blocks move against each other at most; infinite for no block.
fn span(drifts: &[Bounds], surroundings: &[(usize, u8)], images: &Images) -> f64 {
    let drift = |&(block, code): &(usize, u8)| drifts[block].turned(images.get(code));
    let Some(first) = surroundings.first() else { return f64::INFINITY };
    let all = surroundings.iter().fold(drift(first), |all, part| all.joined(&drift(part)));
    (0..3).map(|a| (all.high[a] - all.low[a]).powi(2)).sum::<f64>().sqrt()
}

/// Lists what surrounds the block of particles from `first` on.
fn list(
    first: usize,
    points: &[[f64; 3]],
    spots: &[Spots],
    drifts: &[Bounds],
    tree: &BlockTree,
    images: &Images,
) -> Block {
    let mut block = Block::empty(first, BLOCK.min(points.len() - first));
    let own = &points[first..first + block.count];
    let bounds = Bounds::of(own.iter().copied());
    block.centre = bounds.centre();
    block.surroundings = surroundings(&bounds, tree, images, 1.0 + SKINS[1]);
    let motion = span(drifts, &block.surroundings, images);
    let skin = (SKIN_STEPS * motion).clamp(SKINS[0], SKINS[1]).max(1.5 * motion);
    let reach = 1.0 + skin;
    if skin > SKINS[1] {
        block.surroundings = surroundings(&bounds, tree, images, reach);
    }
    block.slack = skin - motion;
    let near = Near::to(&bounds, reach);
    let mut candidates = Candidates::default();
    let mut wall = 0;
    for &(b, code) in &block.surroundings {
        let image = images.get(code);
        let origin = image.place(spots[b].origin);
        let away = |a: usize| (origin[a] - block.centre[a]) as f32;
        let shift = [away(0), away(1), away(2)];
        candidates.take(&spots[b], image.signs.map(|sign| sign as f32), shift, near);
        let source = |&k: &u32| Source::new(b * BLOCK + k as usize, code);
        block.sources.extend(candidates.numbers.iter().map(source));
        if !images.is_at_wall(code) {
            wall = block.sources.len();
        }
    }
    assert!(block.sources.len() < usize::from(u16::MAX), "too many particles in one place");
    block.places.reserve(block.count * 160);
    let mut places = vec![0; block.sources.len() + WIDTH];
    for point in own {
        let at = [0, 1, 2].map(|a| (point[a] - block.centre[a]) as f32);
        let ends = [0..wall, wall..block.sources.len()].map(|part| {
            let along = candidates.along.each_ref().map(|along| &along[part.clone()]);
            let first = (part.start + 1) as u16;
            let found = select(along, at, (reach * reach) as f32, first, &mut places);
            block.places.extend_from_slice(&places[..found]);
            let full = block.places.len().next_multiple_of(WIDTH);
            block.places.resize(full, 0);
            full as u32
        });
        block.ends.push(ends);
    }
    block
}

/// Blocks whose images come near to `bounds`, those at the wall last.
fn surroundings(
    bounds: &Bounds,
    tree: &BlockTree,
    images: &Images,
    reach: f64,
) -> Vec<(usize, u8)> {
    let mut all = Vec::new();
    let mut found = Vec::new();
    for &code in images.codes() {
        found.clear();
        tree.near(bounds, images.get(code), reach, &mut found);
        all.extend(found.iter().map(|&b| (b, code)));
    }
    all
}

/// Writes `first + k` for every k-th point within reach, in order; their number. There is room for
/// all of them, and for the last vector to be written whole.
fn select(
    along: [&[f32]; 3],
    at: [f32; 3],
    reach_squared: f32,
    first: u16,
    places: &mut [u16],
) -> usize {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has what the function asks for.
        return unsafe { select_avx512(along, at, reach_squared, first, places) };
    }
    select_each(along, 0, at, reach_squared, first, places, 0)
}

/// One point after the other from the `k`-th on, without a branch: written always, kept if near.
fn select_each(
    [x, y, z]: [&[f32]; 3],
    from: usize,
    at: [f32; 3],
    reach_squared: f32,
    first: u16,
    places: &mut [u16],
    mut found: usize,
) -> usize {
    for k in from..x.len() {
        let d = [x[k] - at[0], y[k] - at[1], z[k] - at[2]];
        let near = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach_squared;
        places[found] = first + k as u16;
        found += usize::from(near);
    }
    found
}

/// Sixteen points at once.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn select_avx512(
    along: [&[f32]; 3],
    at: [f32; 3],
    reach_squared: f32,
    first: u16,
    places: &mut [u16],
) -> usize {
    use std::arch::x86_64::*;
    let [x, y, z] = along;
    let whole = x.len() / WIDTH * WIDTH;
    let [ax, ay, az] = [_mm512_set1_ps(at[0]), _mm512_set1_ps(at[1]), _mm512_set1_ps(at[2])];
    let reach = _mm512_set1_ps(reach_squared);
    let ahead = _mm512_set1_epi32(WIDTH as i32);
    let count = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut numbers = _mm512_add_epi32(count, _mm512_set1_epi32(i32::from(first)));
    let mut found = 0;
    for k in (0..whole).step_by(WIDTH) {
        assert!(found + WIDTH <= places.len());
        // SAFETY: k + 16 is within the three slices, and found + 16 within the places.
        unsafe {
            let dx = _mm512_sub_ps(_mm512_loadu_ps(x[k..].as_ptr()), ax);
            let dy = _mm512_sub_ps(_mm512_loadu_ps(y[k..].as_ptr()), ay);
            let dz = _mm512_sub_ps(_mm512_loadu_ps(z[k..].as_ptr()), az);
            let xy = _mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy));
            let square = _mm512_add_ps(xy, _mm512_mul_ps(dz, dz));
            let near = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(square, reach);
            let kept = _mm512_cvtepi32_epi16(_mm512_maskz_compress_epi32(near, numbers));
            _mm256_storeu_si256(places[found..].as_mut_ptr().cast(), kept);
            found += near.count_ones() as usize;
        }
        numbers = _mm512_add_epi32(numbers, ahead);
    }
    select_each(along, whole, at, reach_squared, first, places, found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::sph::images::Ends;

    /// Two mirrors of which one is a wall; a wall, a lid and a period.
    fn models() -> [Images; 2] {
        let open = Ends::Planes { near: false, far: None };
        let mirror = Ends::Planes { near: true, far: None };
        let walls = Ends::Planes { near: true, far: Some(3.0) };
        [[mirror, open, mirror], [Ends::Period(3.0), open, walls]]
            .map(|ends| Images::new(ends, true, [0.0; 3]))
    }

    fn number(i: usize) -> f64 {
        (i as f64 * 0.754877666).fract()
    }

    fn ordered(count: usize) -> (Vec<[f64; 3]>, Neighbours) {
        let point = |i: usize| [3.0 * number(i), 3.0 * number(7 * i + 3), 3.0 * number(13 * i + 5)];
        let points: Vec<_> = (0..count).map(point).collect();
        let (order, tree) = Neighbours::order(&points, 1);
        let points = order.iter().map(|&i| points[i as usize]).collect();
        (points, Neighbours::of_ordered(tree, count))
    }

    /// Asserts that the lists hold all pairs within the support, and tells how many pairs they hold.
    fn assert_complete(points: &[[f64; 3]], neighbours: &Neighbours, images: &Images) -> usize {
        let mut listed_pairs = 0;
        for block in &neighbours.blocks {
            for k in 0..block.count {
                let at = points[block.first + k];
                for (part, wall) in block.neighbours(k).into_iter().zip([false, true]) {
                    let listed = part.iter().flatten().filter(|&&place| place > 0);
                    let listed: std::collections::HashSet<(usize, u8)> = listed
                        .map(|&place| block.sources[place as usize - 1])
                        .map(|source| (source.particle(), source.code()))
                        .collect();
                    listed_pairs += listed.len();
                    let codes = images.codes().iter();
                    for &code in codes.filter(|&&code| images.is_at_wall(code) == wall) {
                        for (j, point) in points.iter().enumerate() {
                            let other = images.get(code).place(*point);
                            let square: f64 = (0..3).map(|a| (at[a] - other[a]).powi(2)).sum();
                            assert!(
                                square >= 1.0 || listed.contains(&(j, code)),
                                "{at:?} {other:?}"
                            );
                        }
                    }
                }
            }
        }
        listed_pairs
    }

    #[test]
    fn the_lists_hold_what_a_loop_over_all_pairs_finds() {
        for (images, threads) in models().into_iter().zip([1, 3]) {
            let (points, mut neighbours) = ordered(700);
            neighbours.prepare(&points, &vec![[0.0; 3]; 700], 1.0, &images, threads);
            let listed = assert_complete(&points, &neighbours, &images);
            let near = |i: usize, code: u8| {
                let reach = (1.0 + SKINS[0]).powi(2);
                let square = |p: &[f64; 3]| {
                    let other = images.get(code).place(*p);
                    (0..3).map(|a| (points[i][a] - other[a]).powi(2)).sum::<f64>()
                };
                points.iter().filter(|p| square(p) < reach).count()
            };
            let of_particle = |i| images.codes().iter().map(|&code| near(i, code)).sum::<usize>();
            let all: usize = (0..700).map(of_particle).sum();
            assert_eq!(listed, all);
        }
    }

    #[test]
    fn the_lists_stay_complete_while_particles_move() {
        let drift =
            |i: usize, step: usize| [0, 1, 2].map(|a| 0.03 * (number(i + 11 * a + step / 9) - 0.5));
        for images in models() {
            let (mut points, mut neighbours) = ordered(700);
            for step in 0..40 {
                let drifts: Vec<_> = (0..700).map(|i| drift(i, step)).collect();
                neighbours.prepare(&points, &drifts, 1.0, &images, 1);
                assert_complete(&points, &neighbours, &images);
                for (x, d) in points.iter_mut().zip(&drifts) {
                    *x = [0, 1, 2].map(|a| x[a] + d[a]);
                }
                assert_complete(&points, &neighbours, &images);
            }
        }
    }

    #[test]
    fn a_common_motion_wears_no_list_out() {
        let (mut points, mut neighbours) = ordered(500);
        let images = Images::new([Ends::Planes { near: false, far: None }; 3], false, [0.0; 3]);
        neighbours.prepare(&points, &vec![[0.0; 3]; 500], 1.0, &images, 1);
        let slack = neighbours.blocks[0].slack;
        let drifts = vec![[0.5, -0.2, 0.1]; 500];
        neighbours.prepare(&points, &drifts, 1.0, &images, 1);
        points.iter_mut().for_each(|x| x[0] += 0.5);
        assert!((neighbours.blocks[0].slack - slack).abs() < 1e-15);
    }
}

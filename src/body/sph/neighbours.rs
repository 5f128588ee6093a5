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
    /// How far anything may still move against anything before what is not among the surroundings
    /// could be a neighbour.
    clearance: f64,
}

/// Neighbours of all particles, or those of other points among the particles.
#[derive(Default)]
pub struct Neighbours {
    pub blocks: Vec<Block>,
    /// Of the sources.
    tree: BlockTree,
    /// How far a neighbour may be away.
    reach: f64,
    /// Sources of all blocks when the particles were sorted.
    sorted_sources: usize,
}

/// Points in the order of a tree's blocks, and the ways that they are about to go, up to a factor.
#[derive(Clone, Copy)]
pub struct Travelling<'a> {
    pub points: &'a [[f64; 3]],
    pub ways: &'a [[f64; 3]],
    pub factor: f64,
}

impl Travelling<'_> {
    /// Bounds of the ways of every block.
    fn drifts(&self, threads: usize) -> Vec<Bounds> {
        let count = self.points.len();
        parallel::map(threads, count.div_ceil(BLOCK), |b| {
            let range = b * BLOCK..((b + 1) * BLOCK).min(count);
            Bounds::of(self.ways[range].iter().map(|way| way.map(|w| self.factor * w)))
        })
    }
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
            clearance: f64::NAN,
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
        Self::between(particles, tree, 1.0)
    }

    /// Neighbours within `reach` of some targets among the sources that stand in the order of the tree's
    /// blocks.
    pub fn between(targets: usize, tree: BlockTree, reach: f64) -> Self {
        let block = |b: usize| Block::empty(b * BLOCK, BLOCK.min(targets - b * BLOCK));
        let blocks = (0..targets.div_ceil(BLOCK)).map(block).collect();
        Self { blocks, tree, reach, sorted_sources: 0 }
    }

    /// The tree over the sources.
    pub fn tree(&self) -> &BlockTree {
        &self.tree
    }

    /// Whether the particles have mixed so much that they should be sorted anew.
    pub fn are_scattered(&self) -> bool {
        self.sorted_sources > 0 && self.sources() as f64 > GROWTH * self.sorted_sources as f64
    }

    fn sources(&self) -> usize {
        self.blocks.iter().map(|block| block.sources.len()).sum()
    }

    /// Makes the lists hold all neighbours of particles where they are and on their way.
    pub fn prepare(&mut self, particles: Travelling, images: &Images, threads: usize) {
        let drifts = particles.drifts(threads);
        self.renew((particles.points, &drifts), (particles.points, &drifts), images, threads);
    }

    /// As [`Self::prepare`], for lists of sources round targets.
    pub fn prepare_between(
        &mut self,
        targets: Travelling,
        sources: Travelling,
        images: &Images,
        threads: usize,
    ) {
        let [aims, drifts] = [targets, sources].map(|points| points.drifts(threads));
        self.renew((targets.points, &aims), (sources.points, &drifts), images, threads);
    }

    /// Makes anew the lists that motions of targets and sources wear out.
    fn renew(
        &mut self,
        (targets, aims): (&[[f64; 3]], &[Bounds]),
        (points, drifts): (&[[f64; 3]], &[Bounds]),
        images: &Images,
        threads: usize,
    ) {
        let motion = widest(aims, drifts, images);
        let all = |block: &Block| span(&aims[block.first / BLOCK], drifts, block, images);
        parallel::for_each(threads, &mut self.blocks, |_, block| {
            block.slack -= all(block);
            block.clearance -= motion;
        });
        let is_worn = |block: &Block| !(block.slack >= MARGIN && block.clearance >= MARGIN);
        if !self.blocks.iter().any(is_worn) {
            return;
        }
        self.tree.refit(points);
        let sources = Sources {
            spots: parallel::map(threads, points.len().div_ceil(BLOCK), |b| {
                Spots::of(&points[b * BLOCK..((b + 1) * BLOCK).min(points.len())])
            }),
            drifts,
            tree: &self.tree,
            images,
            motion,
            reach: self.reach,
        };
        let mut worn: Vec<&mut Block> =
            self.blocks.iter_mut().filter(|block| is_worn(block)).collect();
        parallel::for_each(threads, &mut worn, |_, block| {
            let (first, count) = (block.first, block.count);
            let own = &targets[first..first + count];
            if block.slack >= MARGIN && sources.are_all_around(block, own) {
                block.clearance = SKINS[1] - motion;
            } else {
                **block = list(first, own, &aims[first / BLOCK], &sources);
            }
        });
        if self.sorted_sources == 0 {
            self.sorted_sources = self.sources();
        }
    }
}

/// What lists are made from.
struct Sources<'a> {
    spots: Vec<Spots>,
    drifts: &'a [Bounds],
    tree: &'a BlockTree,
    images: &'a Images,
    /// How far anything moves against anything at most.
    motion: f64,
    reach: f64,
}

impl Sources<'_> {
    /// Whether nothing but its surroundings has come near to a block.
    fn are_all_around(&self, block: &Block, own: &[[f64; 3]]) -> bool {
        let bounds = Bounds::of(own.iter().copied());
        let near = surroundings(&bounds, self.tree, self.images, self.reach + SKINS[1]);
        self.motion < SKINS[1] - MARGIN && near.iter().all(|part| block.surroundings.contains(part))
    }
}

/// How far any target moves against any source or image at most.
fn widest(aims: &[Bounds], drifts: &[Bounds], images: &Images) -> f64 {
    let joined = |all: &[Bounds]| all.iter().copied().reduce(|all, part| all.joined(&part));
    let (Some(aim), Some(drift)) = (joined(aims), joined(drifts)) else { return 0.0 };
    let image = |all: Bounds, &code: &u8| all.joined(&drift.turned(images.get(code)));
    images.codes().iter().fold(aim, image).diagonal()
}

/// How far a block's targets and what surrounds them move against each other at most; nothing where
/// nothing surrounds them.
fn span(aim: &Bounds, drifts: &[Bounds], block: &Block, images: &Images) -> f64 {
    let drift = |&(b, code): &(usize, u8)| drifts[b].turned(images.get(code));
    if block.surroundings.is_empty() {
        return 0.0;
    }
    block.surroundings.iter().fold(*aim, |all, part| all.joined(&drift(part))).diagonal()
}

/// Lists what surrounds a block of targets, whose ways have the bounds `aim`.
fn list(first: usize, own: &[[f64; 3]], aim: &Bounds, sources: &Sources) -> Block {
    let Sources { spots, drifts, tree, images, motion: most, .. } = sources;
    let mut block = Block::empty(first, own.len());
    let bounds = Bounds::of(own.iter().copied());
    block.centre = bounds.centre();
    let widest = sources.reach + SKINS[1];
    block.surroundings = surroundings(&bounds, tree, images, widest);
    let motion = span(aim, drifts, &block, images);
    let skin = (SKIN_STEPS * motion).clamp(SKINS[0], SKINS[1]).max(1.5 * motion);
    let reach = sources.reach + skin;
    if skin > SKINS[1] {
        block.surroundings = surroundings(&bounds, tree, images, reach);
    }
    block.slack = skin - motion;
    block.clearance = skin.max(SKINS[1]) - most;
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

    fn on_way<'a>(points: &'a [[f64; 3]], ways: &'a [[f64; 3]]) -> Travelling<'a> {
        Travelling { points, ways, factor: 1.0 }
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
            neighbours.prepare(on_way(&points, &[[0.0; 3]; 700]), &images, threads);
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
                neighbours.prepare(on_way(&points, &drifts), &images, 1);
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
        neighbours.prepare(on_way(&points, &[[0.0; 3]; 500]), &images, 1);
        let slack = neighbours.blocks[0].slack;
        let drifts = vec![[0.5, -0.2, 0.1]; 500];
        neighbours.prepare(on_way(&points, &drifts), &images, 1);
        points.iter_mut().for_each(|x| x[0] += 0.5);
        assert!((neighbours.blocks[0].slack - slack).abs() < 1e-15);
    }

    #[test]
    fn what_comes_from_far_away_is_seen() {
        // Two clouds, each as stiff as a body, of which one flies through the other.
        let open = Images::new([Ends::Planes { near: false, far: None }; 3], false, [0.0; 3]);
        let (mut points, _) = ordered(2 * BLOCK);
        points[BLOCK..].iter_mut().for_each(|x| x[0] += 7.0);
        let (order, tree) = Neighbours::order(&points, 1);
        points = order.iter().map(|&i| points[i as usize]).collect();
        let mut neighbours = Neighbours::of_ordered(tree, points.len());
        let ways: Vec<_> =
            points.iter().map(|x| [if x[0] > 5.0 { -0.07 } else { 0.0 }, 0.0, 0.0]).collect();
        for _ in 0..100 {
            neighbours.prepare(on_way(&points, &ways), &open, 1);
            points.iter_mut().zip(&ways).for_each(|(x, way)| x[0] += way[0]);
            assert_complete(&points, &neighbours, &open);
        }
    }

    #[test]
    fn other_points_find_their_neighbours_among_particles() {
        for images in models() {
            let (mut points, particles) = ordered(700);
            let mut targets = Neighbours::between(300, particles.tree().clone(), 0.8);
            let mut at: Vec<[f64; 3]> =
                points.iter().take(300).map(|x| x.map(|x| 3.0 - x)).collect();
            let (order, _) = Neighbours::order(&at, 1);
            at = order.iter().map(|&i| at[i as usize]).collect();
            let ways: Vec<_> = (0..700).map(|i| [0.02 * number(i), 0.01, 0.0]).collect();
            for _ in 0..20 {
                let still = [[0.0; 3]; 300];
                targets.prepare_between(on_way(&at, &still), on_way(&points, &ways), &images, 1);
                points.iter_mut().zip(&ways).for_each(|(x, w)| (0..3).for_each(|a| x[a] += w[a]));
                for block in &targets.blocks {
                    for k in 0..block.count {
                        let listed: usize = (block.neighbours(k).into_iter().flatten().flatten())
                            .filter(|&&place| place > 0)
                            .map(|&place| block.sources[place as usize - 1])
                            .filter(|s| {
                                gap(
                                    at[block.first + k],
                                    images.get(s.code()).place(points[s.particle()]),
                                ) < 0.8
                            })
                            .count();
                        let all =
                            images.codes().iter().flat_map(|&c| points.iter().map(move |p| (c, p)));
                        let near = all.filter(|(c, p)| {
                            gap(at[block.first + k], images.get(*c).place(**p)) < 0.8
                        });
                        assert_eq!(listed, near.count());
                    }
                }
            }
        }
    }

    fn gap(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>().sqrt()
    }
}

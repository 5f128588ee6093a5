//! Lists of neighbouring particles and images: for every block its surroundings, and for every
//! particle a list of places in these.
//!
//! Lengths are in units of the support radius. The lists reach farther than the kernel by a skin,
//! so they remain valid until neighbours have moved against each other by its width.

mod displacements;
mod runs;

pub use displacements::Displacements;

use std::ops::Range;

use super::candidates::{Candidates, Near, Points, RelativePoints, inside};
use super::images::{Images, Source};
use super::lanes::WIDTH;
use super::order::{BLOCK, BlockTree, Bounds, GROUP};
use crate::runtime::parallel::Team;
use runs::Runs;

/// Reach of the lists beyond the kernel over the root of the relative motion of neighbours in a
/// step, and its bounds. The cost of a step is proportional to `(1 + s)³ P + L m/s`, with the skin
/// s, the motion m, the time P of all sums and the time L of making lists. L is a fifth to a half
/// of P; the cost is least at `s = √(m L/3P)`.
const SKIN: f64 = 0.3;
const SKINS: [f64; 2] = [1e-3, 0.3];
/// Fraction of the skin reserved for rounding in single precision.
const MARGIN: f64 = 1e-5;

/// Particles of a block and all that surrounds them.
pub struct Block {
    /// Index of the first particle.
    pub first: usize,
    pub count: usize,
    /// Origin of local coordinates.
    pub centre: [f64; 3],
    /// The particles' neighbours, themselves included: first those without, then those with an
    /// image at the wall. Place 0 of local copies is a dummy, so the k-th source has place k + 1.
    sources: Vec<Source>,
    /// Places of neighbours: 0, or those of sources.
    all: Runs,
    /// Those nearer than a radius; empty where none was given.
    near: Runs,
    /// Blocks that contain all sources, with the codes of their images.
    surroundings: Vec<(usize, u8)>,
    /// Remaining relative motion of neighbours before the lists expire.
    slack: f64,
    /// Remaining relative motion of any two particles before one outside the surroundings can
    /// become a neighbour.
    clearance: f64,
    /// True if the block has more surroundings than its lists can hold; they are then empty.
    is_crowded: bool,
}

/// Memory shared by searches.
#[derive(Default)]
struct SearchBuffers {
    near_block: Candidates,
    near_group: Candidates,
    places: Vec<u16>,
}

/// Neighbours of all particles.
#[derive(Default)]
pub struct Neighbours {
    pub blocks: Vec<Block>,
    tree: BlockTree,
}

impl Block {
    fn empty(first: usize, count: usize) -> Self {
        Self {
            first,
            count,
            centre: [0.0; 3],
            sources: Vec::new(),
            all: Runs::default(),
            near: Runs::default(),
            surroundings: Vec::new(),
            slack: f64::NAN,
            clearance: f64::NAN,
            is_crowded: false,
        }
    }

    /// Position of a record about the origin of the block.
    #[inline(always)]
    pub fn about(&self, record: &[f64; 8]) -> [f64; 3] {
        [0, 1, 2].map(|a| record[a] - self.centre[a])
    }

    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Places of the neighbours of the k-th particle of the block: fluid, and images at the wall.
    #[inline(always)]
    pub fn neighbours(&self, k: usize) -> [&[[u16; WIDTH]]; 2] {
        self.all.of(k)
    }

    /// Same, of the neighbours nearer than the radius of [`Neighbours::narrow`]; all where that was not called.
    #[inline(always)]
    pub fn near_neighbours(&self, k: usize) -> [&[[u16; WIDTH]]; 2] {
        if self.near.is_empty() { self.all.of(k) } else { self.near.of(k) }
    }

    /// Lists the neighbours nearer than a radius.
    fn narrow(&mut self, points: &[[f64; 3]], images: &Images, radius: f64) {
        let away = |x: [f64; 3]| [0, 1, 2].map(|a| (x[a] - self.centre[a]) as f32);
        let place = |source: &Source| images.get(source.code()).place(points[source.particle()]);
        let sources: Vec<_> = self.sources.iter().map(|source| away(place(source))).collect();
        let square = (radius * radius) as f32;
        self.near.start(0);
        for k in 0..self.count {
            let at = away(points[self.first + k]);
            let is_near = |place: &u16| {
                usize::from(*place).checked_sub(1).is_some_and(|source| {
                    let d = [0, 1, 2].map(|a| sources[source][a] - at[a]);
                    d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < square
                })
            };
            let runs = self.all.of(k);
            self.near.push(|run, places| {
                places.extend(runs[run].as_flattened().iter().copied().filter(is_near));
            });
        }
    }

    /// Finds the neighbours of the block's particles among its surroundings, of which those from
    /// `wall` on are at the wall.
    fn find_places(
        &mut self,
        own: &[[f64; 3]],
        wall: usize,
        reach: f64,
        buffers: &mut SearchBuffers,
    ) {
        let SearchBuffers { near_block, near_group, places } = buffers;
        let (_, near_block) = near_block.all();
        self.all.start(own.len() * 160);
        places.resize(near_block.along[0].len() + WIDTH, 0);
        for group in own.chunks(GROUP) {
            let bounds = Bounds::of(group.iter().copied());
            let middle = bounds.centre();
            let away = |a: usize| (self.centre[a] - middle[a]) as f32;
            let shift = [away(0), away(1), away(2)];
            near_group.clear();
            near_group.take(near_block, [1.0; 3], shift, Near::to(&bounds, reach));
            let wall = near_group.last_numbers().partition_point(|&n| (n as usize) < wall);
            let count = near_group.last_numbers().len();
            let (numbers, Points { along, .. }) = near_group.all();
            for point in group {
                let away = |a: usize| (point[a] - middle[a]) as f32;
                let at = [away(0), away(1), away(2)];
                let within = Within { at, square: (reach * reach) as f32 };
                let parts = [0..wall, wall..count];
                self.all.push(|run, all| {
                    let found = select(along, numbers, parts[run].clone(), within, places);
                    all.extend_from_slice(&places[..found]);
                });
            }
        }
        // Loops over pairs rely on this without a further check.
        let highest = usize::from(self.all.highest());
        assert!(highest <= self.sources.len(), "a place beyond all sources");
    }

    /// Empties the lists of a block with too many neighbours.
    fn discard_lists(&mut self) {
        self.sources.clear();
        self.all.discard(self.count);
        self.is_crowded = true;
    }
}

impl Neighbours {
    /// Neighbours of particles sorted into blocks; the lists are made when first needed.
    ///
    /// # Panics
    /// If there are more particles than [`Source::MOST`].
    pub fn of(points: &[[f64; 3]], team: &Team) -> Self {
        let count = points.len();
        assert!(count <= Source::MOST, "{count} particles, at most {}", Source::MOST);
        let block = |b: usize| Block::empty(b * BLOCK, BLOCK.min(count - b * BLOCK));
        let blocks = (0..count.div_ceil(BLOCK)).map(block).collect();
        Self { blocks, tree: BlockTree::over(points, team) }
    }

    /// Lists the neighbours nearer than a radius at these positions, for the sums that reach no farther.
    pub fn narrow(&mut self, points: &[[f64; 3]], images: &Images, radius: f64, team: &Team) {
        team.for_each(&mut self.blocks, |_, block| block.narrow(points, images, radius));
    }

    /// Volume of the blocks' surroundings when lists were last made, summed over blocks.
    pub fn surrounded(&self) -> f64 {
        self.tree.surrounded(1.0)
    }

    /// Position of a block with more surroundings than its lists can hold.
    pub fn crowded(&self) -> Option<[f64; 3]> {
        self.blocks.iter().find(|block| block.is_crowded).map(|block| block.centre)
    }

    /// Updates the lists so that they hold all neighbours of particles at their positions and along
    /// their paths.
    pub fn prepare(
        &mut self,
        points: &[[f64; 3]],
        displacements: &Displacements,
        images: &Images,
        team: &Team,
    ) {
        let drifts = &displacements.of_blocks;
        let motion = widest(drifts, images);
        team.for_each(&mut self.blocks, |b, block| {
            block.slack -= span(&drifts[b], drifts, &block.surroundings, images);
            block.clearance -= motion;
        });
        let is_worn = |block: &Block| !(block.slack >= MARGIN && block.clearance >= MARGIN);
        if !self.blocks.iter().any(is_worn) {
            return;
        }
        self.tree.refit(points, team);
        let blocks: Vec<&[[f64; 3]]> = points.chunks(BLOCK).collect();
        let search = Search {
            points,
            displacements,
            spots: team.map(blocks.len(), |b| RelativePoints::of(blocks[b])),
            tree: &self.tree,
            images,
            motion,
        };
        let mut worn: Vec<&mut Block> =
            self.blocks.iter_mut().filter(|block| is_worn(block)).collect();
        team.for_pieces(&mut worn, |_, blocks| {
            let mut buffers = SearchBuffers::default();
            for block in blocks {
                if block.slack >= MARGIN && search.is_undisturbed(block) {
                    block.clearance = SKINS[1] - motion;
                } else {
                    search.list(block, &mut buffers);
                }
            }
        });
    }
}

/// Upper bound on the motion of any particle against any particle or image.
fn widest(drifts: &[Bounds], images: &Images) -> f64 {
    let all = drifts.iter().copied().reduce(|all, part| all.joined(&part));
    let Some(drift) = all else { return 0.0 };
    let image = |all: Bounds, &code: &u8| all.joined(&drift.turned(images.get(code)));
    images.codes().iter().fold(drift, image).diagonal()
}

/// Upper bound on the motion of a block's particles against their surroundings.
fn span(own: &Bounds, drifts: &[Bounds], surroundings: &[(usize, u8)], images: &Images) -> f64 {
    let drift = |&(block, code): &(usize, u8)| drifts[block].turned(images.get(code));
    surroundings.iter().fold(*own, |all, part| all.joined(&drift(part))).diagonal()
}

/// Inputs from which lists are made.
struct Search<'a> {
    points: &'a [[f64; 3]],
    displacements: &'a Displacements,
    spots: Vec<RelativePoints>,
    tree: &'a BlockTree,
    images: &'a Images,
    /// Upper bound on the motion of any two particles.
    motion: f64,
}

impl Search<'_> {
    fn own(&self, block: &Block) -> &[[f64; 3]] {
        &self.points[block.first..block.first + block.count]
    }

    /// Returns true if no particle from outside its surroundings has come near a block.
    fn is_undisturbed(&self, block: &Block) -> bool {
        let bounds = Bounds::of(self.own(block).iter().copied());
        let near = surroundings(&bounds, self.tree, self.images, 1.0 + SKINS[1]);
        self.motion < SKINS[1] - MARGIN && near.iter().all(|part| block.surroundings.contains(part))
    }

    /// Lists the surroundings of a block.
    fn list(&self, block: &mut Block, buffers: &mut SearchBuffers) {
        let Search { displacements, spots, tree, images, .. } = self;
        let own = self.own(block);
        let bounds = Bounds::of(own.iter().copied());
        block.centre = bounds.centre();
        block.surroundings = surroundings(&bounds, tree, images, 1.0 + SKINS[1]);
        let motion = span(
            &displacements.of_blocks[block.first / BLOCK],
            &displacements.of_blocks,
            &block.surroundings,
            images,
        );
        let skin = skin(motion, displacements.steps);
        let reach = 1.0 + skin;
        if skin > SKINS[1] {
            block.surroundings = surroundings(&bounds, tree, images, reach);
        }
        block.slack = skin - motion;
        block.clearance = skin.max(SKINS[1]) - self.motion;
        let mut wall = 0;
        block.sources.clear();
        buffers.near_block.clear();
        for &(b, code) in &block.surroundings {
            let near = Near::to(&bounds, reach);
            buffers.near_block.take_images(&spots[b], images.get(code), block.centre, near);
            let source = |&k: &u32| Source::new(b * BLOCK + k as usize, code);
            block.sources.extend(buffers.near_block.last_numbers().iter().map(source));
            if !images.is_at_wall(code) {
                wall = block.sources.len();
            }
        }
        block.is_crowded = false;
        block.near.start(0);
        match block.sources.len() < usize::from(u16::MAX) {
            true => block.find_places(own, wall, reach, buffers),
            false => block.discard_lists(),
        }
    }
}

/// Reach of lists beyond the kernel, if they are to serve for a number of steps of a motion.
fn skin(motion: f64, steps: f64) -> f64 {
    // Particles may become faster by half, and do not leave the lists within this step.
    let needed = 1.5 * motion;
    (SKIN * motion.sqrt()).min(steps * needed).clamp(SKINS[0], SKINS[1]).max(needed)
}

/// Blocks whose images come close to `bounds`, those at the wall last.
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

/// Points within a distance of a point, given by its square.
#[derive(Debug, Clone, Copy)]
struct Within {
    at: [f32; 3],
    square: f32,
}

/// Writes the places of those points of a range that are within the distance, in order; returns
/// their number. There must be room for the whole range and one vector more, and as much padding
/// behind the points.
fn select(
    along: [&[f32]; 3],
    numbers: &[u32],
    range: Range<usize>,
    within: Within,
    places: &mut [u16],
) -> usize {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has the features that the function requires.
        return unsafe { select_avx512(along, numbers, range, within, places) };
    }
    select_each(along, numbers, range, within, places)
}

/// Processes one point at a time without a branch: always writes, keeps what is near.
fn select_each(
    [x, y, z]: [&[f32]; 3],
    numbers: &[u32],
    range: Range<usize>,
    Within { at, square }: Within,
    places: &mut [u16],
) -> usize {
    let mut found = 0;
    for k in range {
        let d = [x[k] - at[0], y[k] - at[1], z[k] - at[2]];
        let near = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < square;
        places[found] = numbers[k] as u16 + 1;
        found += usize::from(near);
    }
    found
}

/// Processes sixteen points at a time, with the same roundings.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn select_avx512(
    along: [&[f32]; 3],
    numbers: &[u32],
    range: Range<usize>,
    Within { at, square }: Within,
    places: &mut [u16],
) -> usize {
    use std::arch::x86_64::*;
    let length = along[0].len().min(along[1].len()).min(along[2].len()).min(numbers.len());
    assert!(range.end + WIDTH <= length && range.len() + WIDTH <= places.len());
    let [x, y, z] = along.map(<[f32]>::as_ptr);
    let [ax, ay, az] = [_mm512_set1_ps(at[0]), _mm512_set1_ps(at[1]), _mm512_set1_ps(at[2])];
    let (reach, one) = (_mm512_set1_ps(square), _mm512_set1_epi32(1));
    let mut found = 0;
    for k in range.clone().step_by(WIDTH) {
        // SAFETY: there are sixteen numbers from k on, and places from `found` on.
        unsafe {
            let dx = _mm512_sub_ps(_mm512_loadu_ps(x.add(k)), ax);
            let dy = _mm512_sub_ps(_mm512_loadu_ps(y.add(k)), ay);
            let dz = _mm512_sub_ps(_mm512_loadu_ps(z.add(k)), az);
            let xy = _mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy));
            let distance = _mm512_add_ps(xy, _mm512_mul_ps(dz, dz));
            let near = inside(range.end - k) & _mm512_cmp_ps_mask::<_CMP_LT_OQ>(distance, reach);
            let number = _mm512_loadu_epi32(numbers.as_ptr().add(k).cast());
            let place = _mm512_maskz_compress_epi32(near, _mm512_add_epi32(number, one));
            let end = places.as_mut_ptr().add(found);
            _mm256_storeu_si256(end.cast(), _mm512_cvtepi32_epi16(place));
            found += near.count_ones() as usize;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::sph::images::Ends;
    use crate::method::sph::order::space_order;

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
        let order = space_order(&points, &Team::new(1));
        let points: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let neighbours = Neighbours::of(&points, &Team::new(1));
        (points, neighbours)
    }

    /// Asserts that the lists hold all pairs within the support, and returns the number of pairs.
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
    fn lists_match_brute_force() {
        for (images, threads) in models().into_iter().zip([1, 3]) {
            let (points, mut neighbours) = ordered(700);
            neighbours.prepare(&points, &Displacements::none(700), &images, &Team::new(threads));
            let listed = assert_complete(&points, &neighbours, &images);
            let near = |i: usize, code: u8| {
                let reach = (1.0 + skin(0.0, 1.0)).powi(2);
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
    fn lists_remain_complete_while_particles_move() {
        let drift =
            |i: usize, step: usize| [0, 1, 2].map(|a| 0.03 * (number(i + 11 * a + step / 9) - 0.5));
        for (images, steps) in models().into_iter().zip([1.0, 9.0]) {
            let (mut points, mut neighbours) = ordered(300);
            for step in 0..20 {
                let drifts: Vec<_> = (0..300).map(|i| drift(i, step)).collect();
                let team = Team::new(1);
                neighbours.prepare(
                    &points,
                    &Displacements::along(&drifts, steps, &team),
                    &images,
                    &team,
                );
                assert_complete(&points, &neighbours, &images);
                for (x, d) in points.iter_mut().zip(&drifts) {
                    *x = [0, 1, 2].map(|a| x[a] + d[a]);
                }
                assert_complete(&points, &neighbours, &images);
            }
        }
    }

    #[test]
    fn common_motion_does_not_expire_lists() {
        let (mut points, mut neighbours) = ordered(500);
        let images = Images::new([Ends::Planes { near: false, far: None }; 3], false, [0.0; 3]);
        let team = Team::new(1);
        neighbours.prepare(&points, &Displacements::none(500), &images, &team);
        let slack = neighbours.blocks[0].slack;
        let drifts = vec![[0.5, -0.2, 0.1]; 500];
        neighbours.prepare(&points, &Displacements::along(&drifts, 9.0, &team), &images, &team);
        points.iter_mut().for_each(|x| x[0] += 0.5);
        assert!((neighbours.blocks[0].slack - slack).abs() < 1e-15);
    }

    #[test]
    fn particles_from_afar_are_found() {
        // Two clouds, each moving as a rigid body, one through the other.
        let open = Images::new([Ends::Planes { near: false, far: None }; 3], false, [0.0; 3]);
        let (mut points, _) = ordered(2 * BLOCK);
        points[BLOCK..].iter_mut().for_each(|x| x[0] += 7.0);
        let team = Team::new(1);
        let order = space_order(&points, &team);
        points = order.iter().map(|&i| points[i as usize]).collect();
        let mut neighbours = Neighbours::of(&points, &team);
        let displacements: Vec<_> =
            points.iter().map(|x| [if x[0] > 5.0 { -0.07 } else { 0.0 }, 0.0, 0.0]).collect();
        for _ in 0..100 {
            neighbours.prepare(
                &points,
                &Displacements::along(&displacements, 100.0, &team),
                &open,
                &team,
            );
            points.iter_mut().zip(&displacements).for_each(|(x, way)| x[0] += way[0]);
            assert_complete(&points, &neighbours, &open);
        }
    }
}

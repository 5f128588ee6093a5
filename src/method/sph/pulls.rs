//! Forces of the grid's points on the particles.

use std::marker::PhantomData;

use super::candidates::Numbers;
use super::dispatch::{Work, dispatch};
use super::field::{Field, Nearby};
use super::fractions::{Slopes, spread_lanes};
use super::grid::Spread;
use super::images::Images;
use super::lanes::{Lanes, WIDTH};
use super::order::{BLOCK, Bounds, GROUP};
use super::rings::{Form, with_form};
use super::smoothing::{PullSum, SheetSlopes, Smoothing};
use crate::kernel::Number;
use crate::runtime::parallel::Team;
use crate::scene::Precision;

/// Force of the grid's points on a particle, over its volume at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// Force by points on the fluid's side of the wall, and by their images beyond it.
    pub by_fluid: [f64; 3],
    pub by_wall: [f64; 3],
    /// φ, the derivative of the energy by the particle's volume.
    pub potential: f64,
}

/// The pull of the grid's points on particles.
///
/// With the slopes A, b of a point and d from the particle to it,
/// `f = Σ [∇∇W(d) A + b ∇W(d)]`,  `φ = Σ [A·∇W(d) + b W(d)]`.
///
/// An image of the grid pulls as the grid pulls an image of the particle, turned back.
pub struct Pulls<'a> {
    pub images: &'a Images,
    pub smoothing: Smoothing,
    pub precision: Precision,
    /// True if particles are rings and points are circles.
    pub rings: bool,
    /// Positions of the sheets' points.
    pub spread: &'a Spread,
    /// All sheets that pull, sorted into blocks, and their middles.
    pub sheets: &'a [u32],
    pub middles: &'a [[f64; 3]],
    /// Slopes of all sheets.
    pub slopes: &'a [Slopes],
}

impl Pulls<'_> {
    /// Computes the pulls on particles sorted into blocks.
    pub fn on(&self, positions: &[[f64; 3]], pulls: &mut [Pull], team: &Team) {
        pulls.fill(Pull::default());
        let field = Field::of(self.middles, team);
        let mut blocks: Vec<_> = positions.chunks(BLOCK).zip(pulls.chunks_mut(BLOCK)).collect();
        team.for_pieces(&mut blocks, |_, blocks| {
            with_form!(self.rings, F => {
                let (field, form) = (&field, PhantomData::<F>);
                dispatch(PullsOnBlocks { pulls: self, field, blocks, form }, self.precision);
            });
        });
    }
}

/// Bounds of a model that determine how surface tension may change its momentum.
#[derive(Debug, Clone, Copy)]
pub struct Bounded {
    /// Axes along which there is no motion as a whole.
    pub even: [bool; 2],
    pub walled: bool,
}

/// Accelerations by pulls on particles: by fluid along x, y, z and by the wall along z. They change
/// no momentum but that of the wall.
///
/// The total force on the fluid across the wall acts on the wall, at the places where images of the
/// grid pull. Far from a wall this force consists of rounding and, along z, of the effect of the
/// grid's position; it is subtracted from all particles alike.
pub fn balanced(pulls: &[Pull], masses: &[f64], bounded: Bounded, team: &Team) -> Vec<[f64; 4]> {
    let (mut total, mut across, mut mass) = ([0.0; 3], 0.0, 0.0);
    for (Pull { by_fluid, by_wall, .. }, m) in pulls.iter().zip(masses) {
        (0..3).for_each(|a| total[a] += m * (by_fluid[a] + by_wall[a]));
        across += m * by_wall[2].abs();
        mass += m;
    }
    let walled = bounded.walled && across > 0.0;
    let share = if walled { total[2] / across } else { 0.0 };
    let free = [!bounded.even[0], !bounded.even[1], !walled];
    let left = [0, 1, 2].map(|a| if free[a] { total[a] / mass } else { 0.0 });
    team.map(pulls.len(), |i| {
        let pull = &pulls[i];
        let to_wall = share * pull.by_wall[2].abs();
        let [x, y, z] = [0, 1, 2].map(|a| pull.by_fluid[a] + pull.by_wall[a] - left[a]);
        [x, y, z - to_wall, to_wall]
    })
}

/// Work: pulls on the particles of some blocks.
struct PullsOnBlocks<'a, 'b, F> {
    pulls: &'a Pulls<'a>,
    field: &'a Field,
    blocks: &'a mut [(&'b [[f64; 3]], &'b mut [Pull])],
    form: PhantomData<F>,
}

impl<F: Form> Work for PullsOnBlocks<'_, '_, F> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Pulls { images, smoothing, spread, .. } = *self.pulls;
        let [_, _, length] = smoothing.of_pull();
        let lanes = spread_lanes::<L>(spread, smoothing.reach);
        let mut round = Round::<L::Real>::default();
        for (positions, pulls) in self.blocks {
            for &code in images.codes() {
                let image = images.get(code);
                let image_of = |part: &[[f64; 3]]| Bounds::of(part.iter().copied()).image(image);
                round.gather(self.pulls, self.field, &image_of(positions));
                if round.sheets.is_empty() {
                    continue;
                }
                for (group, pulls) in positions.chunks(GROUP).zip(pulls.chunks_mut(GROUP)) {
                    let bounds = image_of(group).widened(spread.half);
                    round.of_group.narrow(&mut round.of_block, &bounds, smoothing.reach);
                    for (&position, pull) in group.iter().zip(pulls) {
                        let at = image.place(position);
                        let sum = round.sum::<L, F>(at, (spread, &lanes), smoothing.reach);
                        let [x, y, z, potential] = sum.total();
                        let force = image.turn([x, y, z]);
                        let side = match images.is_at_wall(code) {
                            true => &mut pull.by_wall,
                            false => &mut pull.by_fluid,
                        };
                        (0..3).for_each(|a| side[a] += force[a]);
                        pull.potential += length * potential;
                    }
                }
            }
        }
    }
}

/// Sheets around a block of particles. Its memory is reused from one block to the next.
#[derive(Default)]
struct Round<R> {
    of_block: Nearby,
    of_group: Nearby,
    of_particle: Numbers,
    sheets: Vec<SheetSlopes<R>>,
}

impl<R: Number> Round<R> {
    #[inline(always)]
    fn gather(&mut self, pulls: &Pulls, field: &Field, bounds: &Bounds) {
        let Pulls { smoothing, spread, images, .. } = *pulls;
        let [by_gradient, by_fraction, _] = smoothing.of_pull();
        self.of_block.clear(bounds);
        let near = (&bounds.widened(spread.half), smoothing.reach);
        field.take(near, images.get(0), &mut self.of_block);
        let (centre, nearer) = (self.of_block.centre, 1.0 / smoothing.reach);
        self.sheets.clear();
        for &k in self.of_block.indices() {
            let (middle, sheet) = (&pulls.middles[k as usize], pulls.sheets[k as usize]);
            let slopes = &pulls.slopes[sheet as usize];
            let mut local = SheetSlopes {
                middle: [R::constant(0.0); 3],
                by_gradient: [[R::constant(0.0); WIDTH]; 3],
                by_fraction: [R::constant(0.0); WIDTH],
            };
            for a in 0..3 {
                local.middle[a] = R::constant(nearer * (middle[a] - centre[a]));
                for lane in 0..WIDTH {
                    local.by_gradient[a][lane] =
                        R::constant(by_gradient * slopes.by_gradient[a][lane]);
                }
            }
            for lane in 0..WIDTH {
                local.by_fraction[lane] = R::constant(by_fraction * slopes.by_fraction[lane]);
            }
            self.sheets.push(local);
        }
    }

    /// Sums over the sheets near a particle of the group that they were last narrowed to.
    #[inline(always)]
    fn sum<L: Lanes<Real = R>, F: Form>(
        &mut self,
        position: [f64; 3],
        spread: (&Spread, &[L; 3]),
        reach: f64,
    ) -> PullSum<L> {
        self.of_group.near(&spread.0.bounds(position), reach, &mut self.of_particle);
        let mut at = [R::constant(0.0); 3];
        for a in 0..3 {
            at[a] = R::constant((position[a] - self.of_block.centre[a]) / reach);
        }
        let numbers = self.of_group.numbers();
        let centre = L::constant(self.of_block.centre[0] / reach);
        let mut sum = PullSum::none();
        for &k in self.of_particle.list() {
            let sheet = &self.sheets[numbers[k as usize] as usize];
            sum.add::<F>(&at, spread.1, sheet, centre);
        }
        sum
    }
}

//! Smoothed volume fractions at the points of a grid, and the derivatives of their energy.

use std::f64::consts::TAU;
use std::marker::PhantomData;

use super::candidates::Numbers;
use super::dispatch::{Work, dispatch};
use super::field::{Field, Nearby};
use super::grid::Spread;
use super::images::Images;
use super::lanes::{Lanes, WIDTH};
use super::order::{Bounds, GROUP};
use super::rings::{Form, with_form};
use super::smoothing::{FractionSum, Smoothing};
use super::tension::SurfaceEnergy;
use crate::kernel::Number;
use crate::runtime::parallel::Team;
use crate::scene::Precision;

/// Sixteen points of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Middle of the points, relative to the grid's origin.
    pub middle: [f64; 3],
    /// Number of points, from the first on, that represent the wall; 0 where all represent the
    /// space above it.
    pub at_wall: usize,
}

/// Derivatives of the energy by ∇C and by C at the points of a sheet, and their energy.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slopes {
    pub by_gradient: [[f64; WIDTH]; 3],
    pub by_fraction: [f64; WIDTH],
    pub energy: f64,
}

impl Slopes {
    /// Returns true if the points contribute nothing.
    pub fn are_none(&self) -> bool {
        let mut all = self.by_gradient.iter().flatten().chain(&self.by_fraction);
        all.all(|&slope| slope == 0.0)
    }
}

/// Fractions and lengths of their gradients at sixteen points.
pub type Sample = [[f64; 2]; WIDTH];

/// The particles whose fractions are evaluated, and the grid.
pub struct Fractions<'a> {
    pub field: &'a Field,
    pub images: &'a Images,
    pub positions: &'a [[f64; 3]],
    /// Volumes at rest, so that the energy depends on positions alone.
    pub volumes: &'a [f64],
    pub smoothing: Smoothing,
    pub precision: Precision,
    /// True if particles are rings and points are circles.
    pub rings: bool,
    /// Origin of the grid.
    pub origin: [f64; 3],
}

impl Fractions<'_> {
    /// Fractions and lengths of their gradients at sixteen points about each of some middles.
    pub fn about(&self, middles: &[[f64; 3]], spread: &Spread, team: &Team) -> Vec<Sample> {
        let mut samples = vec![[[0.0; 2]; WIDTH]; middles.len()];
        let mut groups: Vec<_> = middles.chunks(GROUP).zip(samples.chunks_mut(GROUP)).collect();
        team.for_pieces(&mut groups, |_, groups| {
            with_form!(self.rings, F => {
                let form = PhantomData::<F>;
                dispatch(Samples { fractions: self, spread, groups, form }, self.precision);
            });
        });
        samples
    }

    /// Slopes at the points of sheets; `together` gives the lengths of consecutive groups of
    /// neighbouring sheets.
    pub fn slopes(
        &self,
        (mut sheets, together): (&[Sheet], &[usize]),
        (energies, spread): (&Energies, &Spread),
        mut slopes: &mut [Slopes],
        team: &Team,
    ) {
        let mut groups = Vec::with_capacity(together.len());
        for &count in together {
            let group = slopes.split_off_mut(..count).expect("there are slopes for all sheets");
            groups.push((&sheets[..count], group));
            sheets = &sheets[count..];
        }
        team.for_pieces(&mut groups, |_, groups| {
            with_form!(self.rings, F => {
                let (fractions, form) = (self, PhantomData::<F>);
                let work = SlopesOfSheets { fractions, energies, spread, groups, form };
                dispatch(work, self.precision);
            });
        });
    }
}

/// Energies of points that represent a volume, and of those that represent an area of the wall.
pub struct Energies {
    pub law: SurfaceEnergy,
    pub volume: f64,
    pub area: f64,
}

/// Work: fractions and lengths of gradients.
struct Samples<'a, 'b, F> {
    fractions: &'a Fractions<'a>,
    spread: &'a Spread,
    groups: &'a mut [(&'b [[f64; 3]], &'b mut [Sample])],
    form: PhantomData<F>,
}

impl<F: Form> Work for Samples<'_, '_, F> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Fractions { smoothing, origin, .. } = *self.fractions;
        let spread = spread_lanes::<L>(self.spread, smoothing.reach);
        let mut round = Round::<L::Real>::default();
        for (middles, samples) in self.groups {
            let bounds = |middle: &[f64; 3]| self.spread.bounds(from(origin, *middle));
            round.gather(self.fractions, middles.iter().map(bounds));
            for (middle, sample) in middles.iter().zip(&mut **samples) {
                let sum = round.sum::<L, F>(&bounds(middle), &spread, smoothing.reach);
                let [value, x, y, z] = fraction(sum, smoothing);
                let length = (x * x + y * y + z * z).sqrt();
                let (value, length) = (value.to_array(), length.to_array());
                for lane in 0..WIDTH {
                    sample[lane] = [value[lane].into(), length[lane].into()];
                }
            }
        }
    }
}

/// Work: slopes of groups of sheets.
struct SlopesOfSheets<'a, 'b, F> {
    fractions: &'a Fractions<'a>,
    energies: &'a Energies,
    spread: &'a Spread,
    groups: &'a mut [(&'b [Sheet], &'b mut [Slopes])],
    form: PhantomData<F>,
}

impl<F: Form> Work for SlopesOfSheets<'_, '_, F> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Energies { law, volume, area } = self.energies;
        let Fractions { smoothing, origin, .. } = *self.fractions;
        let spread = spread_lanes::<L>(self.spread, smoothing.reach);
        let mut round = Round::<L::Real>::default();
        for (sheets, slopes) in self.groups {
            let bounds = |sheet: &Sheet| self.spread.bounds(from(origin, sheet.middle));
            round.gather(self.fractions, sheets.iter().map(bounds));
            for (sheet, slopes) in sheets.iter().zip(&mut **slopes) {
                let sum = round.sum::<L, F>(&bounds(sheet), &spread, smoothing.reach);
                let [value, x, y, z] = fraction(sum, smoothing);
                let (count, mut numbers) = if sheet.at_wall > 0 {
                    let (by_fraction, energy) = law.of_wall(value, *area);
                    let none = L::constant(0.0);
                    (sheet.at_wall, [none, none, none, by_fraction, energy])
                } else {
                    let ([x, y, z], by_fraction, energy) = law.of_free(value, [x, y, z], *volume);
                    (WIDTH, [x, y, z, by_fraction, energy])
                };
                if F::ROUND {
                    // A point represents its circle.
                    let middle = L::constant(from(origin, sheet.middle)[0] / smoothing.reach);
                    let circle = L::constant(TAU * smoothing.reach) * (middle + spread[0]);
                    for number in &mut numbers {
                        *number = circle * *number;
                    }
                }
                slopes.store(count, numbers);
            }
        }
    }
}

impl Slopes {
    /// Stores the derivatives by ∇C and C, and the energy, of the first `count` points.
    #[inline(always)]
    fn store<L: Lanes>(&mut self, count: usize, [x, y, z, by_fraction, energy]: [L; 5]) {
        let (by_gradient, energy) = ([x.to_array(), y.to_array(), z.to_array()], energy.to_array());
        let by_fraction = by_fraction.to_array();
        *self = Self::default();
        for lane in 0..count {
            for (slopes, along) in self.by_gradient.iter_mut().zip(&by_gradient) {
                slopes[lane] = along[lane].into();
            }
            self.by_fraction[lane] = by_fraction[lane].into();
            self.energy += energy[lane].into();
        }
    }
}

/// Position of a place that is given relative to the grid's origin.
pub fn from(origin: [f64; 3], place: [f64; 3]) -> [f64; 3] {
    [origin[0] + place[0], origin[1] + place[1], origin[2] + place[2]]
}

/// C and ∇C.
#[inline(always)]
fn fraction<L: Lanes>(sum: FractionSum<L>, smoothing: Smoothing) -> [L; 4] {
    let [scale, steep] = smoothing.of_fraction();
    let (scale, steep) = (L::constant(scale), L::constant(steep));
    let [x, y, z] = sum.gradient;
    [scale * sum.value, steep * x, steep * y, steep * z]
}

/// Particles around a box. Its memory is reused from one box to the next.
#[derive(Default)]
struct Round<R> {
    of_box: Nearby,
    of_sheet: Numbers,
    /// Position about the centre, over h, and volume.
    records: Vec<[R; 4]>,
}

impl<R: Number> Round<R> {
    #[inline(always)]
    fn gather(&mut self, fractions: &Fractions, boxes: impl Iterator<Item = Bounds>) {
        let bounds = boxes.reduce(|all, one| all.joined(&one)).expect("there is a box");
        let Fractions { field, images, positions, volumes, smoothing, .. } = *fractions;
        self.of_box.clear(&bounds);
        self.records.clear();
        let ([x, y, z], nearer) = (self.of_box.centre, 1.0 / smoothing.reach);
        for &code in images.codes() {
            let image = images.get(code);
            let before = self.of_box.indices().len();
            field.take((&bounds, smoothing.reach), image, &mut self.of_box);
            for &i in &self.of_box.indices()[before..] {
                let [u, v, w] = image.place(positions[i as usize]);
                self.records.push([
                    R::constant(nearer * (u - x)),
                    R::constant(nearer * (v - y)),
                    R::constant(nearer * (w - z)),
                    R::constant(volumes[i as usize]),
                ]);
            }
        }
    }

    /// Sums over the particles near sixteen of the points inside the box. The points stand at
    /// `spread` about the middle of their box, in lengths of h.
    #[inline(always)]
    fn sum<L: Lanes<Real = R>, F: Form>(
        &mut self,
        bounds: &Bounds,
        spread: &[L; 3],
        reach: f64,
    ) -> FractionSum<L> {
        self.of_box.near(bounds, reach, &mut self.of_sheet);
        let (own, mut at) = (bounds.centre(), *spread);
        for a in 0..3 {
            at[a] = at[a] + L::constant((own[a] - self.of_box.centre[a]) / reach);
        }
        let centre = L::constant(self.of_box.centre[0] / reach);
        let mut sum = FractionSum::none();
        for &k in self.of_sheet.list() {
            sum.add::<F>(&at, &self.records[k as usize], centre);
        }
        sum
    }
}

/// A spread over h.
#[inline(always)]
pub fn spread_lanes<L: Lanes>(spread: &Spread, reach: f64) -> [L; 3] {
    let mut lanes = [L::constant(0.0); 3];
    for (lanes, along) in lanes.iter_mut().zip(&spread.along) {
        let mut places = lanes.to_array();
        for (place, along) in places.iter_mut().zip(along) {
            *place = L::Real::constant(along / reach);
        }
        *lanes = L::of_array(&places);
    }
    lanes
}

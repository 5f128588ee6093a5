//! Forces by stresses of particles, along the lines of pairs.

use super::super::images::{Images, Source};
use super::super::lanes::{Lanes, WIDTH, lanes, scaled};
use super::super::loops::{Local, PairSum};
use super::super::neighbours::Block;
use super::super::rings::{Arc, Form, PLACES, Turn, flat};
use super::tensor::AXES;
use super::weights::Weights;
use crate::kernel::Shape;

/// `Σ V_j F x (x·G_i x + x·G_j x)`, by fluid and by the wall, with a form G of each particle: the
/// derivative of its energy with respect to the sums of [`Elongation`](super::strain::Elongation).
pub struct Stress<'a> {
    pub images: &'a Images,
    /// Position and the first five numbers of G of each particle.
    pub records: &'a [[f64; 8]],
    /// The last number of G, volume, and 1.
    pub annexes: &'a [[f64; 4]],
    pub weights: Weights,
}

impl PairSum for Stress<'_> {
    type Output = [[f64; 3]; 2];
    const ANNEX: bool = true;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn annexes(&self) -> &[[f64; 4]] {
        self.annexes
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, xx, yy, zz, xy, yz] = self.records[source.particle()];
        let [x, y, z] = image.place([x, y, z]);
        let signs = image.signs;
        [x, y, z, xx, yy, zz, signs[0] * signs[1] * xy, signs[1] * signs[2] * yz]
    }

    #[inline(always)]
    fn annex(&self, source: Source) -> [f64; 4] {
        let image = self.images.get(source.code());
        let [xz, volume, ..] = self.annexes[source.particle()];
        [image.signs[0] * image.signs[2] * xz, volume, image.signs[2], 0.0]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> [[f64; 3]; 2] {
        let i = block.first + k;
        let (own, annex) = (&self.records[i], &self.annexes[i]);
        let here = Here::<L> {
            position: lanes(block.about(own)),
            form: Form6::of([own[3], own[4], own[5], own[6], own[7], annex[0]]),
            narrowing: L::constant(self.weights.narrowing),
            centre: L::constant(block.centre[0]),
        };
        let [fluid, wall] = block.near_neighbours(k);
        [
            flat::<F>(scaled(
                total::<L, S, F>(shape, &here, fluid, local),
                self.weights.normalisation,
            )),
            flat::<F>(scaled(
                total::<L, S, F>(shape, &here, wall, local),
                self.weights.normalisation,
            )),
        ]
    }
}

/// A quadratic form in all lanes.
#[derive(Clone, Copy)]
struct Form6<L>([L; 6]);

impl<L: Lanes> Form6<L> {
    #[inline(always)]
    fn of(numbers: [f64; 6]) -> Self {
        let mut form = [L::constant(0.0); 6];
        for n in 0..6 {
            form[n] = L::constant(numbers[n]);
        }
        Self(form)
    }

    #[inline(always)]
    fn at(&self, x: [L; 3]) -> L {
        let mut sum = self.0[0] * x[0] * x[0];
        for (n, (a, b)) in AXES.into_iter().enumerate().skip(1) {
            sum = sum + self.0[n] * x[a] * x[b];
        }
        sum
    }
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    form: Form6<L>,
    narrowing: L,
    /// x of the origin of the positions.
    centre: L,
}

#[inline(always)]
fn total<L: Lanes, S: Shape, F: Form>(
    shape: S,
    here: &Here<L>,
    neighbours: &[[u16; WIDTH]],
    local: &Local<L::Real>,
) -> [L; 3] {
    let mut force = [L::constant(0.0); 3];
    for places in neighbours {
        let ([x, y, z, xx, yy, zz, xy, yz], annex) =
            (local.gather::<L>(places), local.gather_annex::<L>(places));
        let [xz, volume, sign, _] = annex;
        let theirs = Neighbour { position: [x, y, z], form: Form6([xx, yy, zz, xy, yz, xz]), sign };
        if !F::ROUND {
            add::<L, S>(shape, &mut force, here, &theirs, volume, None);
            continue;
        }
        let d = [here.position[0] - x, here.position[2] - z];
        let radii = [here.position[0] + here.centre, x + here.centre];
        let arc = Arc::about(radii[0], radii[1], d[0] * d[0] + d[1] * d[1]);
        for place in 0..PLACES {
            let turn = arc.turn(place);
            add::<L, S>(shape, &mut force, here, &theirs, volume * turn.weight, Some(turn));
        }
    }
    force
}

/// Sixteen neighbours; in a model of rings at φ = 0.
struct Neighbour<L> {
    position: [L; 3],
    form: Form6<L>,
    /// −1 for an image where the fluid sticks, whose force has the opposite sign along the plane.
    sign: L,
}

#[inline(always)]
fn add<L: Lanes, S: Shape>(
    shape: S,
    force: &mut [L; 3],
    here: &Here<L>,
    theirs: &Neighbour<L>,
    volume: L,
    turn: Option<Turn<L>>,
) {
    let [x, y, z] = match turn {
        None => theirs.position,
        Some(turn) => turn.place(theirs.position),
    };
    let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
    let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let weight = volume * shape.slope_over_q(q * here.narrowing);
    // In the frame of the turned ring.
    let seen = match turn {
        None => d,
        Some(turn) => turn.seen(d),
    };
    let (own, other) = (weight * here.form.at(d), weight * theirs.form.at(seen));
    let tangential = own + theirs.sign * other;
    force[0] = force[0] + tangential * d[0];
    force[1] = force[1] + tangential * d[1];
    force[2] = force[2] + (own + other) * d[2];
}

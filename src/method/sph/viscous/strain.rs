//! Elongation of pairs: forces along their lines, and the sums from which strain rates follow.

use super::super::images::{Images, Source};
use super::super::lanes::{Lanes, WIDTH, lanes, scaled};
use super::super::loops::{Local, PairSum};
use super::super::neighbours::Block;
use super::super::rings::{Arc, Form, PLACES, flat};
use super::tensor::{AXES, Products};
use super::weights::Weights;
use crate::kernel::Shape;

/// Sums over the rates of elongation `e = u_ij·x` of all pairs of a particle.
pub struct Strain<'a> {
    pub images: &'a Images,
    /// Position, velocity, volume and viscosity of each particle.
    pub records: &'a [[f64; 8]],
    pub weights: Weights,
}

/// Sums for one particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Elongation {
    /// `Σ V_j (−F) e φ`.
    pub rates: Products,
    /// `Σ V_j (−F) e²`.
    pub squares: f64,
    /// `Σ V_j F (ν_i + ν_j) e x`, by fluid and by the wall.
    pub forces: [[f64; 3]; 2],
    /// Rate of the density over itself; 0 where pressure is not solved.
    pub compression: f64,
}

impl PairSum for Strain<'_> {
    type Output = Elongation;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    /// Images across z, where the fluid sticks, have a negative viscosity as their mark.
    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, u, v, w, volume, viscosity] = self.records[source.particle()];
        let ([x, y, z], [u, v, w]) = (image.place([x, y, z]), image.no_slip([u, v, w]));
        [x, y, z, u, v, w, volume, image.signs[2] * viscosity]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> Elongation {
        let own = &self.records[block.first + k];
        let here = Here::<L> {
            position: lanes(block.about(own)),
            velocity: lanes([own[3], own[4], own[5]]),
            viscosity: L::constant(own[7]),
            narrowing: L::constant(self.weights.narrowing),
            centre: L::constant(block.centre[0]),
        };
        let [fluid, wall] = block.near_neighbours(k);
        let (mut by_fluid, mut by_wall) = (Sums::<L>::zero(), Sums::<L>::zero());
        by_fluid.add_all::<S, F>(shape, &here, fluid, local);
        by_wall.add_all::<S, F>(shape, &here, wall, local);
        let scale = self.weights.normalisation;
        let mut rates = [0.0; 6];
        for (n, rate) in rates.iter_mut().enumerate() {
            let cancels = F::ROUND && (n == 3 || n == 4);
            let sum: f64 = (by_fluid.rates[n] + by_wall.rates[n]).sum().into();
            *rate = if cancels { 0.0 } else { -scale * sum };
        }
        let forces =
            [flat::<F>(scaled(by_fluid.force, scale)), flat::<F>(scaled(by_wall.force, scale))];
        let squares: f64 = (by_fluid.squares + by_wall.squares).sum().into();
        Elongation { rates, squares: -scale * squares, forces, compression: 0.0 }
    }
}

/// The particle whose neighbours are summed, broadcast to all lanes.
struct Here<L> {
    position: [L; 3],
    velocity: [L; 3],
    viscosity: L,
    narrowing: L,
    /// x of the origin of the positions.
    centre: L,
}

struct Sums<L> {
    rates: [L; 6],
    squares: L,
    force: [L; 3],
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn zero() -> Self {
        let zero = L::constant(0.0);
        Self { rates: [zero; 6], squares: zero, force: [zero; 3] }
    }

    #[inline(always)]
    fn add_all<S: Shape, F: Form>(
        &mut self,
        shape: S,
        here: &Here<L>,
        neighbours: &[[u16; WIDTH]],
        local: &Local<L::Real>,
    ) {
        for places in neighbours {
            let neighbour = local.gather(places);
            if !F::ROUND {
                self.add(shape, here, neighbour);
                continue;
            }
            let [x, _, z, ..] = neighbour;
            let d = [here.position[0] - x, here.position[2] - z];
            let radii = [here.position[0] + here.centre, x + here.centre];
            let arc = Arc::about(radii[0], radii[1], d[0] * d[0] + d[1] * d[1]);
            for place in 0..PLACES {
                self.add(shape, here, arc.turn(place).record(neighbour));
            }
        }
    }

    /// Adds sixteen neighbours. The energy of a pair is the mean of both ends' energies. For an
    /// image where the fluid sticks, the other end sees the pair reflected: its elongation is
    /// `u_z z − (u_x x + u_y y)`, and its force has the opposite sign along the plane.
    #[inline(always)]
    fn add<S: Shape>(&mut self, shape: S, here: &Here<L>, neighbour: [L; 8]) {
        let [x, y, z, vx, vy, vz, volume, viscosity] = neighbour;
        let d = [here.position[0] - x, here.position[1] - y, here.position[2] - z];
        let u = [here.velocity[0] - vx, here.velocity[1] - vy, here.velocity[2] - vz];
        let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let weight = volume * shape.slope_over_q(q * here.narrowing);
        let (along, across) = (u[0] * d[0] + u[1] * d[1], u[2] * d[2]);
        let elongation = along + across;
        let sign = viscosity.choose_below(0.0, L::constant(-1.0), L::constant(1.0));
        let elongating = weight * elongation;
        let own = elongating * here.viscosity;
        let theirs = weight * sign * viscosity;
        let tangential = own + theirs * (along + sign * across);
        let normal = own + theirs * (across + sign * along);
        self.force[0] = self.force[0] + tangential * d[0];
        self.force[1] = self.force[1] + tangential * d[1];
        self.force[2] = self.force[2] + normal * d[2];
        self.squares = self.squares + elongating * elongation;
        for (n, (a, b)) in AXES.into_iter().enumerate() {
            self.rates[n] = self.rates[n] + elongating * d[a] * d[b];
        }
    }
}

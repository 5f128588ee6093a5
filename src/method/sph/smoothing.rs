//! The smoothed volume fraction and its derivatives: the innermost loops of surface tension.

use super::lanes::{Lanes, WIDTH};
use super::rings::{Arc, Form, PLACES};
use crate::kernel::{Kernel, Shape, WendlandC2};

/// The smoothing kernel W of support h. Kernels whose Fourier transform has zeros, such as (1 −
/// q²)ⁿ, do not resist unevenness of some wavelengths, and particles detach.
///
/// The sums below use lengths over h and omit factors common to all their terms.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Smoothing {
    /// h over H.
    pub reach: f64,
    /// σ_d/h^d.
    scale: f64,
}

impl Smoothing {
    pub fn of(reach: f64, dimension: usize) -> Self {
        Self { reach, scale: Kernel::WendlandC2.scale(reach, dimension) }
    }

    /// Factors of the sums of [`FractionSum`]: for C and for ∇C.
    pub fn of_fraction(&self) -> [f64; 2] {
        [self.scale, self.scale / self.reach]
    }

    /// Factors of A and b for [`SheetSlopes`], and of the resulting potential.
    pub fn of_pull(&self) -> [f64; 3] {
        let slope = self.scale / self.reach;
        [slope / self.reach, slope, self.reach]
    }
}

/// Sums over particles at points in lanes: `Σ V w` and `Σ V (w′/q) ξ`, ξ from the particle to the
/// point.
#[derive(Clone, Copy)]
pub struct FractionSum<L> {
    pub value: L,
    pub gradient: [L; 3],
}

impl<L: Lanes> FractionSum<L> {
    #[inline(always)]
    pub fn none() -> Self {
        Self { value: L::constant(0.0), gradient: [L::constant(0.0); 3] }
    }

    /// Adds a particle with its position and volume; `centre` is x of the origin of the positions.
    #[inline(always)]
    pub fn add<F: Form>(&mut self, at: &[L; 3], particle: &[L::Real; 4], centre: L) {
        let [x, y, z, volume] = *particle;
        let (own, volume) = ([L::splat(x), L::splat(y), L::splat(z)], L::splat(volume));
        let d = [at[0] - own[0], at[1] - own[1], at[2] - own[2]];
        if !F::ROUND {
            self.add_at(d, volume);
            return;
        }
        let square = d[0] * d[0] + d[2] * d[2];
        let arc = Arc::about(at[0] + centre, own[0] + centre, square);
        for place in 0..PLACES {
            let turn = arc.turn(place);
            let [x, y, z] = turn.place(own);
            self.add_at([at[0] - x, at[1] - y, at[2] - z], volume * turn.weight);
        }
        // Contributions from both sides of the plane y = 0 cancel.
        self.gradient[1] = L::constant(0.0);
    }

    #[inline(always)]
    fn add_at(&mut self, d: [L; 3], volume: L) {
        let q = length(d);
        let slope = volume * WendlandC2.slope_over_q(q);
        self.value = self.value + volume * WendlandC2.value(q);
        for (sum, d) in self.gradient.iter_mut().zip(d) {
            *sum = *sum + slope * d;
        }
    }
}

/// Sums over points in lanes, ξ from the particle to the points: the force
/// `Σ [((w′/q)′/q ξ·a + β w′/q) ξ + (w′/q) a]` and the potential `Σ [(w′/q) ξ·a + β w]`.
#[derive(Clone, Copy)]
pub struct PullSum<L> {
    force: [L; 3],
    potential: L,
}

/// Sixteen points: their middle, and a and β.
#[derive(Debug, Clone, Copy)]
pub struct SheetSlopes<R> {
    pub middle: [R; 3],
    pub by_gradient: [[R; WIDTH]; 3],
    pub by_fraction: [R; WIDTH],
}

impl<L: Lanes> PullSum<L> {
    #[inline(always)]
    pub fn none() -> Self {
        Self { force: [L::constant(0.0); 3], potential: L::constant(0.0) }
    }

    /// Adds a sheet whose points stand at `spread` about its middle; `centre` is x of the origin of
    /// the positions.
    #[inline(always)]
    pub fn add<F: Form>(
        &mut self,
        at: &[L::Real; 3],
        spread: &[L; 3],
        sheet: &SheetSlopes<L::Real>,
        centre: L,
    ) {
        let mut d = *spread;
        let mut a = *spread;
        for n in 0..3 {
            d[n] = d[n] + (L::splat(sheet.middle[n]) - L::splat(at[n]));
            a[n] = L::of_array(&sheet.by_gradient[n]);
        }
        let b = L::of_array(&sheet.by_fraction);
        if !F::ROUND {
            self.add_at(d, a, b);
            return;
        }
        let own = L::splat(at[0]) + centre;
        let arc = Arc::about(own, own + d[0], d[0] * d[0] + d[2] * d[2]);
        for place in 0..PLACES {
            let turn = arc.turn(place);
            let [x, y, z] = turn.vector(a);
            let a = [turn.weight * x, turn.weight * y, turn.weight * z];
            self.add_at(turn.place(d), a, turn.weight * b);
        }
        self.force[1] = L::constant(0.0);
    }

    /// Adds points at `d` from the particle, with their slopes.
    #[inline(always)]
    fn add_at(&mut self, d: [L; 3], a: [L; 3], b: L) {
        let q = length(d);
        let slope = WendlandC2.slope_over_q(q);
        let down = d[0] * a[0] + d[1] * a[1] + d[2] * a[2];
        let along = WendlandC2.bend_over_q(q) * down + b * slope;
        for n in 0..3 {
            self.force[n] = self.force[n] + (along * d[n] + slope * a[n]);
        }
        self.potential = self.potential + (slope * down + b * WendlandC2.value(q));
    }

    /// Force and potential.
    #[inline(always)]
    pub fn total(self) -> [f64; 4] {
        let [x, y, z] = self.force;
        [x.sum().into(), y.sum().into(), z.sum().into(), self.potential.sum().into()]
    }
}

#[inline(always)]
fn length<L: Lanes>(d: [L; 3]) -> L {
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

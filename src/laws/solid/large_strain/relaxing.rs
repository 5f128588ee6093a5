//! Rubber and gels: neo-Hooke with Maxwell branches in shear.
//!
//! The energy of the change of shape per reference volume is `½ µ (J^(−2/3) tr C − 3)`, `C = FᵀF`. All deviatoric
//! stresses have the form
//!
//! `P = J^(−2/3) [F Q − ⅓ (C : Q) F^(−T)]`
//!
//! with a symmetric Q that is `µ 1` for neo-Hooke. A branch of fraction γ and time τ keeps a stress H in the reference
//! configuration, `Q = γ_∞ µ 1 + Σ γ H`, which follows `Ḣ + H/τ = dS̃/dt` with the elastic `S̃ = µ F̄^(−1) dev(F̄F̄ᵀ)
//! F̄^(−T)`, `F̄ = J^(−1/3) F` (J. C. Simo and T. J. R. Hughes 1998, *Computational Inelasticity*, §10.4). The step `H
//! ← e^(−x) H + (1 − e^(−x))/x ΔS̃`, `x = Δt/τ`, is exact for S̃ linear in time, however long the step.

use super::{Deformed, Isochoric, Tangent};
use crate::math::matrix3::{
    Matrix3, Symmetric, contraction, eigenvalue_bound, full, packed, product, transposed,
};

/// Branches by which the shear modulus relaxes; without any the solid is neo-Hookean.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Relaxing {
    pub branches: Vec<MaxwellBranch>,
}

/// A Maxwell branch of the deviatoric stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellBranch {
    /// Part of the instantaneous shear modulus.
    pub fraction: f64,
    /// Relaxation time [s].
    pub time: f64,
}

/// Q over a step, and what it follows from.
struct Carried {
    carrier: Matrix3,
    energy: f64,
}

impl Relaxing {
    /// S̃ and the H of each branch.
    pub fn history(&self) -> usize {
        if self.branches.is_empty() { 0 } else { 6 * (1 + self.branches.len()) }
    }

    /// Part of the shear modulus that remains.
    fn remaining(&self) -> f64 {
        1.0 - self.branches.iter().map(|branch| branch.fraction).sum::<f64>()
    }

    pub fn respond(&self, shear: f64, at: &Deformed, dt: f64, history: &mut [f64]) -> Isochoric {
        let c = product(&transposed(&at.gradient), &at.gradient);
        let Carried { carrier, energy } = self.carry(shear, at, &c, dt, history);
        let j = at.dilatation.powf(-2.0 / 3.0);
        let along = product(&at.gradient, &carrier);
        let third = contraction(&c, &carrier) / 3.0;
        let entry = |a: usize, b: usize| j * (along[a][b] - third * at.inverse_transposed[a][b]);
        // Waves along the axis of the smallest stretch, exact for neo-Hooke in principal axes.
        let trace = c[0][0] + c[1][1] + c[2][2];
        let largest = eigenvalue_bound(&carrier).max(shear);
        let wave = largest * j * (5.0 / 9.0 * trace * at.steepest() - 1.0 / 3.0);
        let stress = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
        Isochoric { stress, energy, wave }
    }

    /// Advances the history by a step.
    fn carry(
        &self,
        shear: f64,
        at: &Deformed,
        c: &Matrix3,
        dt: f64,
        history: &mut [f64],
    ) -> Carried {
        let j = at.dilatation.powf(-2.0 / 3.0);
        let trace = c[0][0] + c[1][1] + c[2][2];
        let lasting = self.remaining() * shear;
        let mut carrier = [[0.0; 3]; 3];
        (0..3).for_each(|a| carrier[a][a] = lasting);
        let mut energy = 0.5 * lasting * (j * trace - 3.0);
        if self.branches.is_empty() {
            return Carried { carrier, energy };
        }
        let elastic = elastic(shear, at, trace);
        let (before, kept) = history.split_at_mut(6);
        for (branch, h) in self.branches.iter().zip(kept.chunks_mut(6)) {
            let x = dt / branch.time;
            let (decay, growth) = ((-x).exp(), part(x));
            for a in 0..6 {
                h[a] = decay * h[a] + growth * (elastic[a] - before[a]);
            }
            let stress = full(std::array::from_fn(|a| h[a]));
            for n in 0..9 {
                carrier[n / 3][n % 3] += branch.fraction * stress[n / 3][n % 3];
            }
            energy += branch.fraction * branch_energy(shear, &stress, c, j);
        }
        before.copy_from_slice(&elastic);
        Carried { carrier, energy }
    }

    pub fn tangent(&self, shear: f64, at: &Deformed, dt: f64, before: &[f64]) -> Tangent {
        let c = product(&transposed(&at.gradient), &at.gradient);
        let mut history = before.to_vec();
        let mut fixed = self.carry(shear, at, &c, dt, &mut history).carrier;
        // Each branch adds Q = e^(−x) H + (1 − e^(−x))/x ΔS̃, of which only S̃ depends on F. In the stress of S̃ its
        // multiple of C⁻¹ drops out, so that it acts as a constant `µ 1` does.
        let moves = |branch: &MaxwellBranch| branch.fraction * part(dt / branch.time);
        let moving = shear * self.branches.iter().map(moves).sum::<f64>();
        if moving > 0.0 {
            let trace = c[0][0] + c[1][1] + c[2][2];
            let g = &at.inverse_transposed;
            let inverse = product(&transposed(g), g);
            for n in 0..9 {
                fixed[n / 3][n % 3] += moving * trace / 3.0 * inverse[n / 3][n % 3];
            }
        }
        of_constant_carrier(at, &fixed, &c)
    }
}

/// S̃ = µ [1 − ⅓ (tr C) C⁻¹].
fn elastic(shear: f64, at: &Deformed, trace: f64) -> Symmetric {
    let inverse = product(&transposed(&at.inverse_transposed), &at.inverse_transposed);
    let unit = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
    let entry = |a: usize, b: usize| shear * (unit(a, b) - trace / 3.0 * inverse[a][b]);
    packed(&std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b))))
}

/// Energy of a branch of the whole modulus, `|dev(F̄HF̄ᵀ)|²/4µ`: exact for small strain.
fn branch_energy(shear: f64, h: &Matrix3, c: &Matrix3, j: f64) -> f64 {
    let along = product(h, c);
    let square = product(&along, &along);
    let trace = contraction(h, c);
    j * j * (square[0][0] + square[1][1] + square[2][2] - trace * trace / 3.0) / (4.0 * shear)
}

/// `(1 − e^(−x))/x`.
fn part(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}

/// `∂P/∂F` of `P = J^(−2/3) [F Q − ⅓ (C : Q) F^(−T)]` at constant Q.
pub(super) fn of_constant_carrier(at: &Deformed, q: &Matrix3, c: &Matrix3) -> Tangent {
    let j = at.dilatation.powf(-2.0 / 3.0);
    let g = &at.inverse_transposed;
    let along = product(&at.gradient, q);
    let trace = contraction(c, q);
    std::array::from_fn(|row| {
        let (i, a) = (row / 3, row % 3);
        std::array::from_fn(|column| {
            let (k, b) = (column / 3, column % 3);
            let same = if i == k { q[b][a] } else { 0.0 };
            let cross = -2.0 / 3.0 * (g[k][b] * along[i][a] + g[i][a] * along[k][b]);
            let rest = trace * (2.0 / 9.0 * g[i][a] * g[k][b] + 1.0 / 3.0 * g[i][b] * g[k][a]);
            j * (same + cross + rest)
        })
    })
}

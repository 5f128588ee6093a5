//! Tangent of an isotropic Kirchhoff stress `s = µ dev b̄`, where b̄ is an isotropic function of that of a trial.
//!
//! Both have the same axes. In these a change of the trial for `L = δF F⁻¹` is `δb̄_tr = L b̄_tr + b̄_tr Lᵀ − ⅔ (tr L)
//! b̄_tr`, and that of s couples principal values with each other, and each entry beside them with itself alone. So
//! `P = s F^(−T)` has the derivative `∂P_ia/∂F_kl = c_ijkm G_ja G_ml − (s G)_il G_ka` with `G = F^(−T)` and a c of 21
//! entries.

use super::{Deformed, Tangent};
use crate::math::matrix3::{IDENTITY, Matrix3, product, transposed};

/// Changes of s about a deformation.
pub(super) struct Isotropic {
    /// Axes as columns.
    axes: Matrix3,
    /// G, its rows along the axes.
    inverse_transposed: Matrix3,
    /// Principal values of s [Pa].
    stress: [f64; 3],
    /// Change of s_pp by L_rr, and of s_pq by L_pq and L_qp [Pa].
    along: Matrix3,
    own: Matrix3,
    mirrored: Matrix3,
}

/// A function of the trial: principal values, and derivatives of b̄ by the trial.
pub(super) struct Function {
    pub axes: Matrix3,
    pub trial: [f64; 3],
    pub elastic: [f64; 3],
    /// Of principal values by each other, and of what is beside them.
    pub along: Matrix3,
    pub across: Matrix3,
}

const THIRD: f64 = 1.0 / 3.0;

impl Isotropic {
    pub(super) fn new(shear: f64, at: &Deformed, function: &Function) -> Self {
        let Function { axes, trial, elastic, along, across } = function;
        let mean = |values: [f64; 3]| THIRD * values.iter().sum::<f64>();
        let sum = mean(*elastic);
        let by_stretch = |p: usize, r: usize| -> f64 {
            let trial = |c: usize| 2.0 * trial[c] * (IDENTITY[c][r] - THIRD);
            (0..3).map(|c| along[p][c] * trial(c)).sum()
        };
        let columns: Matrix3 = std::array::from_fn(|r| {
            let column: [f64; 3] = std::array::from_fn(|p| by_stretch(p, r));
            let mean = mean(column);
            column.map(|value| shear * (value - mean))
        });
        let beside = |p: usize, q: usize, by: usize| match p == q {
            true => 0.0,
            false => shear * across[p][q] * trial[by],
        };
        Self {
            axes: *axes,
            inverse_transposed: product(&transposed(axes), &at.inverse_transposed),
            stress: elastic.map(|value| shear * (value - sum)),
            along: transposed(&columns),
            own: std::array::from_fn(|p| std::array::from_fn(|q| beside(p, q, q))),
            mirrored: std::array::from_fn(|p| std::array::from_fn(|q| beside(p, q, p))),
        }
    }

    /// P [Pa].
    pub(super) fn stress(&self) -> Matrix3 {
        let rows: Matrix3 =
            std::array::from_fn(|p| self.inverse_transposed[p].map(|value| self.stress[p] * value));
        product(&self.axes, &rows)
    }

    /// Derivatives of row p of P, along the axes, by row r of F: `∂P_pa/∂F_rl`.
    fn block(&self, p: usize, r: usize) -> Matrix3 {
        let g = &self.inverse_transposed;
        let mut block = [[0.0; 3]; 3];
        let mut add = |factor: f64, left: &[f64; 3], right: &[f64; 3]| {
            for (row, left) in block.iter_mut().zip(left) {
                row.iter_mut()
                    .zip(right)
                    .for_each(|(value, right)| *value += factor * left * right);
            }
        };
        add(self.along[p][r], &g[p], &g[r]);
        match p == r {
            true => (0..3).filter(|&q| q != p).for_each(|q| add(self.own[p][q], &g[q], &g[q])),
            false => add(self.mirrored[p][r], &g[r], &g[p]),
        }
        add(-self.stress[p], &g[r], &g[p]);
        block
    }

    /// ∂P/∂F.
    pub(super) fn tangent(&self) -> Tangent {
        let mut tangent = [[0.0; 9]; 9];
        for r in 0..3 {
            // Rows of P along the body's axes first.
            let mut turned = [[[0.0; 3]; 3]; 3];
            for p in 0..3 {
                let block = self.block(p, r);
                for (i, turned) in turned.iter_mut().enumerate() {
                    for n in 0..9 {
                        turned[n / 3][n % 3] += self.axes[i][p] * block[n / 3][n % 3];
                    }
                }
            }
            for (row, line) in tangent.iter_mut().enumerate() {
                for (column, value) in line.iter_mut().enumerate() {
                    *value += self.axes[column / 3][r] * turned[row / 3][row % 3][column % 3];
                }
            }
        }
        tangent
    }

    /// `∂P_aa/∂F_aa`.
    pub(super) fn slope(&self, a: usize) -> f64 {
        let of_pair =
            |p: usize, r: usize| self.axes[a][p] * self.axes[a][r] * self.block(p, r)[a][a];
        (0..3).flat_map(|p| (0..3).map(move |r| (p, r))).map(|(p, r)| of_pair(p, r)).sum()
    }
}

//! Rubber-like solids: compressible neo-Hooke with Maxwell branches in shear.
//!
//! The energy per reference volume is `W = ½ µ (J^(−2/3) tr C − 3) + U(J)`, `U = ½ κ (½ (J² − 1) − ln J)`, with the
//! deformation gradient F, `C = FᵀF` and `J = det F` (Simo & Hughes 1998, Computational Inelasticity, eq. 9.2.3). All
//! isochoric stresses have the form
//!
//! `P = J^(−2/3) [F Q − ⅓ (C : Q) F^(−T)]`
//!
//! (first Piola–Kirchhoff) with a symmetric Q that is `µ 1` for neo-Hooke. A branch of fraction γ and time τ keeps a stress H in the
//! reference configuration, `Q = γ_∞ µ 1 + Σ γ H`, which follows `Ḣ + H/τ = dS̃/dt` with the elastic
//! `S̃ = µ F̄^(−1) dev(F̄F̄ᵀ) F̄^(−T)`, `F̄ = J^(−1/3) F` (ibid., eqs. 10.4.5–10.4.9). The step
//! `H ← e^(−x) H + (1 − e^(−x))/x ΔS̃`, `x = Δt/τ`, is exact for S̃ linear in time, however long the step.

use crate::math::matrix3::{
    Matrix3, Symmetric, contraction, eigenvalue_bound, full, inverse, packed, product, transposed,
};

/// A Maxwell branch of the deviatoric stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// Part of the instantaneous shear modulus.
    pub fraction: f64,
    /// Relaxation time [s].
    pub time: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Hyperelastic {
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
    /// Instantaneous shear modulus µ [Pa].
    pub shear: f64,
    pub branches: Vec<Branch>,
}

/// Isochoric response of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isochoric {
    /// P without the part of the pressure [Pa].
    pub stress: Matrix3,
    /// Q [Pa].
    pub carrier: Matrix3,
    /// Energy stored per reference volume, without that of the dilatation [J/m³].
    pub energy: f64,
}

/// Kinematics of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deformed {
    pub gradient: Matrix3,
    /// F^(−T).
    pub inverse_transposed: Matrix3,
    /// J.
    pub dilatation: f64,
}

impl Deformed {
    pub fn of(gradient: Matrix3) -> Self {
        let (inverse, dilatation) = inverse(&gradient);
        Self { gradient, inverse_transposed: transposed(&inverse), dilatation }
    }
}

impl Hyperelastic {
    /// Numbers of history of a point: S̃ and the H of each branch.
    pub fn history(&self) -> usize {
        if self.branches.is_empty() { 0 } else { 6 * (1 + self.branches.len()) }
    }

    /// Part of the shear modulus that remains.
    fn remaining(&self) -> f64 {
        1.0 - self.branches.iter().map(|branch| branch.fraction).sum::<f64>()
    }

    /// Modulus of plane waves in the undeformed body [Pa].
    pub fn wave_modulus(&self) -> f64 {
        self.bulk + 4.0 / 3.0 * self.shear
    }

    /// U′ and U″ at a dilatation [Pa].
    pub fn pressure(&self, j: f64) -> [f64; 2] {
        [0.5 * self.bulk * (j - 1.0 / j), 0.5 * self.bulk * (1.0 + 1.0 / (j * j))]
    }

    /// U [J/m³].
    pub fn energy_of_dilatation(&self, j: f64) -> f64 {
        0.5 * self.bulk * (0.5 * (j * j - 1.0) - j.ln())
    }

    /// Advances the history by a time step; returns the response at its end.
    pub fn respond(&self, at: &Deformed, dt: f64, history: &mut [f64]) -> Isochoric {
        let j = at.dilatation.powf(-2.0 / 3.0);
        let c = product(&transposed(&at.gradient), &at.gradient);
        let trace = c[0][0] + c[1][1] + c[2][2];
        let mut carrier = [[0.0; 3]; 3];
        (0..3).for_each(|a| carrier[a][a] = self.remaining() * self.shear);
        let mut energy = 0.5 * self.remaining() * self.shear * (j * trace - 3.0);
        if !self.branches.is_empty() {
            let elastic = self.elastic(at, trace);
            let (before, kept) = history.split_at_mut(6);
            for (branch, h) in self.branches.iter().zip(kept.chunks_mut(6)) {
                let x = dt / branch.time;
                let (decay, growth) = ((-x).exp(), part(x));
                for a in 0..6 {
                    h[a] = decay * h[a] + growth * (elastic[a] - before[a]);
                }
                let stress = full(std::array::from_fn(|a| h[a]));
                (0..9)
                    .for_each(|n| carrier[n / 3][n % 3] += branch.fraction * stress[n / 3][n % 3]);
                energy += branch.fraction * self.branch_energy(&stress, &c, j);
            }
            before.copy_from_slice(&elastic);
        }
        let stress = isochoric(at, &carrier, &c, j);
        Isochoric { stress, carrier, energy }
    }

    /// S̃ = µ [1 − ⅓ (tr C) C⁻¹].
    fn elastic(&self, at: &Deformed, trace: f64) -> Symmetric {
        let inverse = product(&transposed(&at.inverse_transposed), &at.inverse_transposed);
        let unit = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
        let entry = |a: usize, b: usize| self.shear * (unit(a, b) - trace / 3.0 * inverse[a][b]);
        packed(&std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b))))
    }

    /// Energy of a branch of the whole modulus, `|dev(F̄HF̄ᵀ)|²/4µ`: exact for small strain.
    fn branch_energy(&self, h: &Matrix3, c: &Matrix3, j: f64) -> f64 {
        let square = product(&product(h, c), &product(h, c));
        let trace = contraction(h, c);
        let norm = j * j * (square[0][0] + square[1][1] + square[2][2] - trace * trace / 3.0);
        norm / (4.0 * self.shear)
    }

    /// `∂P/∂F` at constant history and pressure p of the dilatation; `[3 i + J][3 k + L]`.
    pub fn tangent(&self, at: &Deformed, carrier: &Matrix3, dt: f64, pressure: f64) -> Tangent {
        // Each branch adds Q = e^(−x) H + (1 − e^(−x))/x ΔS̃, of which only S̃ depends on F. In the stress of S̃ its multiple
        // of C⁻¹ drops out, so that it acts as a constant `µ 1` does.
        let part = |branch: &Branch| branch.fraction * part(dt / branch.time);
        let moving = self.shear * self.branches.iter().map(part).sum::<f64>();
        let mut fixed = *carrier;
        let j = at.dilatation.powf(-2.0 / 3.0);
        let c = product(&transposed(&at.gradient), &at.gradient);
        if moving > 0.0 {
            let trace = c[0][0] + c[1][1] + c[2][2];
            let inverse = product(&transposed(&at.inverse_transposed), &at.inverse_transposed);
            for n in 0..9 {
                fixed[n / 3][n % 3] += moving * trace / 3.0 * inverse[n / 3][n % 3];
            }
        }
        let mut tangent = isochoric_tangent(at, &fixed, &c, j);
        let (g, jp) = (&at.inverse_transposed, at.dilatation * pressure);
        for (row, line) in tangent.iter_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                let ((i, jj), (k, l)) = ((row / 3, row % 3), (column / 3, column % 3));
                *value += jp * (g[i][jj] * g[k][l] - g[i][l] * g[k][jj]);
            }
        }
        tangent
    }

    /// Bound on the modulus of plane waves in the reference configuration [Pa]: that of waves along the axis of the
    /// smallest stretch, exact for neo-Hooke in principal axes.
    pub fn wave_modulus_at(&self, at: &Deformed, carrier: &Matrix3, j_of_group: f64) -> f64 {
        let g = &at.inverse_transposed;
        let inverse = product(&transposed(g), g);
        let steepest = eigenvalue_bound(&inverse);
        let c = product(&transposed(&at.gradient), &at.gradient);
        let trace = c[0][0] + c[1][1] + c[2][2];
        let largest = eigenvalue_bound(carrier).max(self.shear);
        let shear =
            largest * at.dilatation.powf(-2.0 / 3.0) * (5.0 / 9.0 * trace * steepest - 1.0 / 3.0);
        let [_, stiff] = self.pressure(j_of_group);
        shear + stiff * at.dilatation * at.dilatation * steepest
    }
}

pub type Tangent = [[f64; 9]; 9];

/// `(1 − e^(−x))/x`.
fn part(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}

fn isochoric(at: &Deformed, q: &Matrix3, c: &Matrix3, j: f64) -> Matrix3 {
    let along = product(&at.gradient, q);
    let third = contraction(c, q) / 3.0;
    let entry = |a: usize, b: usize| j * (along[a][b] - third * at.inverse_transposed[a][b]);
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

/// `∂P/∂F` of [`isochoric`] at constant Q.
fn isochoric_tangent(at: &Deformed, q: &Matrix3, c: &Matrix3, j: f64) -> Tangent {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Hyperelastic {
        let branches =
            vec![Branch { fraction: 0.5, time: 0.3 }, Branch { fraction: 0.2, time: 5.0 }];
        Hyperelastic { bulk: 7.0, shear: 3.0, branches }
    }

    const GRADIENT: Matrix3 = [[1.2, 0.3, -0.1], [0.05, 0.8, 0.2], [-0.2, 0.1, 1.1]];

    #[test]
    fn the_tangent_is_the_derivative_of_the_stress() {
        let law = law();
        let mut history = vec![0.0; law.history()];
        law.respond(
            &Deformed::of([[1.1, 0.1, 0.0], [0.0, 0.9, 0.0], [0.2, 0.0, 1.0]]),
            0.1,
            &mut history,
        );
        let stress = |f: Matrix3| {
            let at = Deformed::of(f);
            let mut history = history.clone();
            law.respond(&at, 0.2, &mut history).stress
        };
        let at = Deformed::of(GRADIENT);
        let mut after = history.clone();
        let carrier = law.respond(&at, 0.2, &mut after).carrier;
        let tangent = law.tangent(&at, &carrier, 0.2, 0.0);
        for column in 0..9 {
            let moved = |by: f64| {
                let mut f = GRADIENT;
                f[column / 3][column % 3] += by;
                stress(f)
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            for row in 0..9 {
                let found = (up[row / 3][row % 3] - down[row / 3][row % 3]) / 2e-6;
                assert!(
                    (found - tangent[row][column]).abs() < 1e-7,
                    "{row} {column}: {found} {}",
                    tangent[row][column]
                );
            }
        }
    }

    #[test]
    fn stress_turns_with_the_body_and_needs_no_volume() {
        let law = law();
        let (s, c) = 0.7_f64.sin_cos();
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let mut histories = [vec![0.0; law.history()], vec![0.0; law.history()]];
        let plain = law.respond(&Deformed::of(GRADIENT), 0.1, &mut histories[0]);
        let turned = law.respond(&Deformed::of(product(&turn, &GRADIENT)), 0.1, &mut histories[1]);
        let expected = product(&turn, &plain.stress);
        for n in 0..9 {
            assert!((turned.stress[n / 3][n % 3] - expected[n / 3][n % 3]).abs() < 1e-13);
        }
        // P : F of isochoric stress is its mean, which vanishes.
        assert!(contraction(&plain.stress, &GRADIENT).abs() < 1e-13);
    }
}

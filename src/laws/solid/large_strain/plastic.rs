//! Metals that flow: multiplicative J₂ plasticity with isotropic hardening.
//!
//! The elastic left Cauchy–Green tensor of the change of shape, `b̄ = J^(−2/3) F C_p⁻¹ Fᵀ`, has the energy `½ µ (tr b̄
//! − 3)` and the Kirchhoff stress `s = µ dev b̄`, with the plastic right tensor C_p. The body yields at `‖s‖ = √⅔
//! σ_y(α)`, `σ_y = σ₀ + H α + (σ_∞ − σ₀)(1 − e^(−δα))` (E. Voce 1955). A step returns radially with `µ̄ = ⅓ µ tr b̄`:
//!
//! `s = s_tr − 2 µ̄ Δγ n`, `‖s_tr‖ − 2 µ̄ Δγ = √⅔ σ_y(α + √⅔ Δγ)`
//!
//! (J. C. Simo 1988, doi 10.1016/0045-7825(88)90076-X; Simo and Hughes 1998, box 9.1). The spherical part of b̄ after
//! the return follows from `det b̄ = 1`, so that flow keeps the volume and the energy is elastic. The tangent is the
//! derivative of this step, which is not symmetric.

use super::{Deformed, Isochoric, Tangent};
use crate::math::matrix3::{
    IDENTITY, Matrix3, contraction, full, inverse, packed, product, transposed,
};

/// Yield stress over the equivalent plastic strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plastic {
    /// σ₀ [Pa].
    pub yield_stress: f64,
    /// H [Pa].
    pub hardening: f64,
    /// σ_∞ [Pa]; σ₀ without saturation.
    pub saturation: f64,
    /// δ [1].
    pub rate: f64,
}

/// A step of a point.
struct Step {
    /// `b̄` if nothing flowed.
    trial: Matrix3,
    /// `s_tr`, its norm, and `n`.
    stress: Matrix3,
    norm: f64,
    direction: Matrix3,
    /// µ̄ and Δγ.
    modulus: f64,
    flow: f64,
    /// Slope of σ_y at the end of the step.
    slope: f64,
}

const THIRD: f64 = 1.0 / 3.0;
/// Iterations of the return, which converges from below: the yield stress is concave.
const ITERATIONS: usize = 60;
/// Flow over the yield strain at which the return has converged.
const CONVERGED: f64 = 1e-15;

impl Plastic {
    /// `C_p⁻¹ − 1` (xx, yy, zz, xy, yz, xz) and α.
    pub const HISTORY: usize = 7;
    /// Place of α.
    pub const STRAIN: usize = 6;

    fn yield_stress(&self, alpha: f64) -> [f64; 2] {
        let Self { yield_stress, hardening, saturation, rate } = *self;
        let rest = (saturation - yield_stress) * (-rate * alpha).exp();
        [saturation - rest + hardening * alpha, rate * rest + hardening]
    }

    fn step(&self, shear: f64, at: &Deformed, before: &[f64]) -> Step {
        let j = at.dilatation.powf(-2.0 * THIRD);
        let mut plastic = full(std::array::from_fn(|n| before[n]));
        (0..3).for_each(|a| plastic[a][a] += 1.0);
        let trial = product(&product(&at.gradient, &plastic), &transposed(&at.gradient));
        let trial: Matrix3 = trial.map(|row| row.map(|value| j * value));
        let trace = trial[0][0] + trial[1][1] + trial[2][2];
        let stress = deviator(&trial.map(|row| row.map(|value| shear * value)));
        let norm = contraction(&stress, &stress).sqrt();
        let modulus = shear * trace * THIRD;
        let root = (2.0 * THIRD).sqrt();
        let (mut flow, mut slope) = (0.0, 0.0);
        if norm > root * self.yield_stress(before[Self::STRAIN])[0] {
            for _ in 0..ITERATIONS {
                let [now, rise] = self.yield_stress(before[Self::STRAIN] + root * flow);
                slope = rise;
                let excess = norm - 2.0 * modulus * flow - root * now;
                let change = excess / (2.0 * modulus + 2.0 * THIRD * rise);
                flow += change;
                if change.abs() <= CONVERGED * norm / modulus {
                    break;
                }
            }
        }
        let direction = stress.map(|row| row.map(|value| value / norm.max(f64::MIN_POSITIVE)));
        Step { trial, stress, norm, direction, modulus, flow, slope }
    }

    pub fn respond(&self, shear: f64, at: &Deformed, history: &mut [f64]) -> Isochoric {
        let step = self.step(shear, at, history);
        let kept = kirchhoff(&step);
        let mut trace = step.trial[0][0] + step.trial[1][1] + step.trial[2][2];
        if step.flow > 0.0 {
            let mean = spherical(&kept.map(|row| row.map(|value| value / shear)));
            trace = 3.0 * mean;
            // b̄ = s/µ + ⅓ (tr b̄) 1, pulled back.
            let entry = |a: usize, b: usize| kept[a][b] / shear + mean * IDENTITY[a][b];
            let b = std::array::from_fn(|a| std::array::from_fn(|c| entry(a, c)));
            let back = transposed(&at.inverse_transposed);
            let j = at.dilatation.powf(2.0 * THIRD);
            let plastic = product(&product(&back, &b), &at.inverse_transposed);
            let plastic = packed(&plastic.map(|row| row.map(|value| j * value)));
            for (n, value) in plastic.into_iter().enumerate() {
                history[n] = if n < 3 { value - 1.0 } else { value };
            }
            history[Self::STRAIN] += (2.0 * THIRD).sqrt() * step.flow;
        }
        let stiffness = 4.0 * THIRD * step.modulus.max(shear);
        Isochoric {
            stress: product(&kept, &at.inverse_transposed),
            energy: 0.5 * shear * (trace - 3.0),
            wave: stiffness * at.steepest() * at.dilatation.max(1.0),
        }
    }

    pub fn tangent(&self, shear: f64, at: &Deformed, before: &[f64]) -> Tangent {
        let step = self.step(shear, at, before);
        let j = at.dilatation.powf(-2.0 * THIRD);
        let mut plastic = full(std::array::from_fn(|n| before[n]));
        (0..3).for_each(|a| plastic[a][a] += 1.0);
        // J^(−2/3) C_p⁻¹ Fᵀ.
        let half = product(&plastic, &transposed(&at.gradient));
        let kept = kirchhoff(&step);
        let mut tangent = [[0.0; 9]; 9];
        for column in 0..9 {
            let (k, l) = (column / 3, column % 3);
            // δb̄ for δF = e_k ⊗ e_l.
            let mut change = [[0.0; 3]; 3];
            for b in 0..3 {
                change[k][b] += j * half[l][b];
                change[b][k] += j * half[l][b];
            }
            let swelling = 2.0 * THIRD * at.inverse_transposed[k][l];
            for n in 0..9 {
                change[n / 3][n % 3] -= swelling * step.trial[n / 3][n % 3];
            }
            let moved = self.change(shear, &step, &change);
            // P = s F^(−T), and δF^(−T) = −F^(−T) δFᵀ F^(−T).
            let first = product(&moved, &at.inverse_transposed);
            for (row, line) in tangent.iter_mut().enumerate() {
                let (i, a) = (row / 3, row % 3);
                let along: f64 = (0..3).map(|m| kept[i][m] * at.inverse_transposed[m][l]).sum();
                line[column] = first[i][a] - along * at.inverse_transposed[k][a];
            }
        }
        tangent
    }

    /// Change of s for a change of b̄.
    fn change(&self, shear: f64, step: &Step, change: &Matrix3) -> Matrix3 {
        let trial = deviator(&change.map(|row| row.map(|value| shear * value)));
        if step.flow == 0.0 {
            return trial;
        }
        let Step { norm, direction, modulus, flow, slope, .. } = step;
        let along = contraction(direction, &trial);
        let of_modulus = shear * THIRD * (change[0][0] + change[1][1] + change[2][2]);
        let of_flow = (along - 2.0 * flow * of_modulus) / (2.0 * modulus + 2.0 * THIRD * slope);
        let entry = |a: usize, b: usize| {
            let turned = (trial[a][b] - direction[a][b] * along) / norm;
            trial[a][b]
                - 2.0 * (flow * of_modulus + modulus * of_flow) * direction[a][b]
                - 2.0 * modulus * flow * turned
        };
        std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
    }
}

/// Multiple of the identity that makes the determinant of a deviator 1, by Newton's method from above.
fn spherical(deviator: &Matrix3) -> f64 {
    let half = 0.5 * contraction(deviator, deviator);
    let (_, determinant) = inverse(deviator);
    // The cubic rises and is convex from the larger of its extrema on, and above 1 at this start.
    let mut mean = 1.0 + half.sqrt();
    for _ in 0..ITERATIONS {
        let excess = mean * (mean * mean - half) + determinant - 1.0;
        let change = excess / (3.0 * mean * mean - half);
        mean -= change;
        if change.abs() <= CONVERGED * mean {
            break;
        }
    }
    mean
}

fn kirchhoff(step: &Step) -> Matrix3 {
    let by = 2.0 * step.modulus * step.flow;
    let entry = |a: usize, b: usize| step.stress[a][b] - by * step.direction[a][b];
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

fn deviator(m: &Matrix3) -> Matrix3 {
    let mean = THIRD * (m[0][0] + m[1][1] + m[2][2]);
    std::array::from_fn(|a| std::array::from_fn(|b| m[a][b] - mean * IDENTITY[a][b]))
}

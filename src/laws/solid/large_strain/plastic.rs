//! Metals that flow: multiplicative J₂ plasticity with isotropic hardening.
//!
//! The elastic left Cauchy–Green tensor of the change of shape, `b̄ = J^(−2/3) F C_p⁻¹ Fᵀ`, has the energy `½ µ (tr b̄
//! − 3)` and the Kirchhoff stress `s = µ dev b̄`, with the plastic right tensor C_p. The body yields at `‖s‖ = √⅔
//! σ_y(α)`, `σ_y = σ₀ + H α + (σ_∞ − σ₀)(1 − e^(−δα))` (E. Voce 1955). A step of flow is exponential (G. Weber and L.
//! Anand 1990, doi 10.1016/0045-7825(90)90131-5; J. C. Simo 1992, doi 10.1016/0045-7825(92)90123-2): with `b̄_tr` that
//! of a step without flow, along whose axes all tensors are,
//!
//! `b̄ = e^(−2N) b̄_tr`, `s = µ dev b̄ = √⅔ σ_y(α + √⅔ ‖N‖) N/‖N‖`.
//!
//! Flow keeps the volume, and the step is exact, however long, where the axes of the flow stay. N minimises the energy
//! that is stored and dissipated, which is convex; so the step has one, the stress is the derivative of that energy by F,
//! and its tangent is symmetric. With kinematic hardening a step is that of [`kinematic`].

use super::isotropic::{Function, Isotropic};
use super::relaxing::of_constant_carrier;
use super::{Deformed, Isochoric, Tangent, kinematic};
use crate::math::matrix3::{
    IDENTITY, Matrix3, contraction, eigen, full, inverse, packed, product, transposed,
};

/// Yield stress over the equivalent plastic strain, and the modulus of the back stress.
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
    /// H_k [Pa].
    pub kinematic: f64,
}

/// A step of a point that flows, in the axes of `b̄_tr`.
struct Step {
    /// Axes as columns, and the principal values of `b̄_tr`.
    axes: Matrix3,
    trial: [f64; 3],
    /// µ [Pa].
    shear: f64,
    flow: Flow,
}

/// Flow of a step, by its principal values. N has no trace, so that two directions span it and its changes.
struct Flow {
    logarithms: [f64; 3],
    /// Those of `e^(−2N)`.
    decay: [f64; 3],
    /// `s − √⅔ σ_y N/‖N‖` [Pa].
    residual: [f64; 3],
    /// The direction of N, and the one across it.
    directions: [[f64; 3]; 2],
    /// Derivative of the residual by N along these [Pa]. Across a small N it is far larger than along it.
    slope: [[f64; 2]; 2],
}

const THIRD: f64 = 1.0 / 3.0;
/// `√⅔`
pub(super) const ROOT: f64 = 0.816_496_580_927_726;
const ITERATIONS: usize = 60;
/// Halvings of an iteration, after which the residual falls no more.
const HALVINGS: usize = 12;
/// Residual over the modulus at which N has converged.
const CONVERGED: f64 = 256.0 * f64::EPSILON;
/// Difference of principal values, relative to the largest, below which they count as equal.
const EQUAL: f64 = 1e-7;

impl Plastic {
    /// `C_p⁻¹ − 1` (xx, yy, zz, xy, yz, xz) and α.
    pub const HISTORY: usize = 7;
    /// Place of α.
    pub const STRAIN: usize = 6;

    /// Returns true if a run may produce a history of a point: α is none below zero, and C_p⁻¹ positive definite.
    pub fn is_sound(history: &[f64]) -> bool {
        let m = unpacked(history);
        let minor = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        history[Self::STRAIN] >= 0.0 && m[0][0] > 0.0 && minor > 0.0 && inverse(&m).1 > 0.0
    }

    /// σ_y and its slope at an α.
    pub(super) fn yield_stress(&self, alpha: f64) -> [f64; 2] {
        let Self { yield_stress, hardening, saturation, rate, .. } = *self;
        let rest = match saturation - yield_stress {
            0.0 => 0.0,
            range => range * (-rate * alpha).exp(),
        };
        [saturation - rest + hardening * alpha, rate * rest + hardening]
    }

    /// Stress at an α of a bar that is drawn out of its initial state, and its slope: that of the back stress included.
    pub fn flow_stress(&self, alpha: f64) -> [f64; 2] {
        let [stress, slope] = self.yield_stress(alpha);
        [stress + self.kinematic * alpha, slope + self.kinematic]
    }

    /// Work of that stress up to an α [J/m³].
    pub fn work(&self, alpha: f64) -> f64 {
        let Self { yield_stress, hardening, saturation, rate, kinematic } = *self;
        let missing = match saturation - yield_stress {
            0.0 => 0.0,
            range => -range * (-rate * alpha).exp_m1() / rate,
        };
        saturation * alpha - missing + 0.5 * (hardening + kinematic) * alpha * alpha
    }

    /// Logarithmic plastic strain `½ ln C_p` of a history, in axes of the reference configuration.
    pub fn logarithmic_strain(history: &[f64]) -> Matrix3 {
        let (stretches, axes) = eigen(&unpacked(history));
        let logarithms = stretches.map(|inverse| -0.5 * inverse.ln());
        let entry = |a: usize, b: usize| -> f64 {
            (0..3).map(|n| axes[a][n] * logarithms[n] * axes[b][n]).sum()
        };
        std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
    }

    /// Returns `None` for a point that stays elastic.
    fn step(&self, shear: f64, trial: &Matrix3, before: &[f64]) -> Option<Step> {
        let stress = deviator(&trial.map(|row| row.map(|value| shear * value)));
        let size = contraction(&stress, &stress).sqrt();
        let modulus = shear * THIRD * trace(trial);
        let alpha = before[Self::STRAIN];
        let [radius, rise] = self.yield_stress(alpha);
        // Beyond rounding: a point that begins a step on its yield surface is elastic where it unloads.
        if size <= ROOT * radius + 2.0 * CONVERGED * modulus {
            return None;
        }
        let (trial, axes) = eigen(trial);
        let stress = deviatoric(trial.map(|value| shear * value));
        // The radial return of small strain.
        let first = (size - ROOT * radius) / (2.0 * modulus + 2.0 * THIRD * rise);
        let mut now = self.flow(shear, trial, alpha, stress.map(|own| first / size * own));
        for _ in 0..ITERATIONS {
            let excess = norm(now.residual);
            if excess <= CONVERGED * modulus {
                break;
            }
            let change = now.improvement();
            let parts = (0..HALVINGS).map(|halvings| 0.5_f64.powi(halvings as i32));
            let trials = parts.map(|part| {
                let to = std::array::from_fn(|a| now.logarithms[a] + part * change[a]);
                self.flow(shear, trial, alpha, to)
            });
            // Rounding alone is left where no part of an iteration is better.
            let Some(next) = trials.into_iter().find(|next| norm(next.residual) < excess) else {
                break;
            };
            now = next;
        }
        Some(Step { axes, trial, shear, flow: now })
    }

    /// Residual at an N, from an α.
    fn flow(&self, shear: f64, trial: [f64; 3], alpha: f64, logarithms: [f64; 3]) -> Flow {
        let decay = logarithms.map(|own| (-2.0 * own).exp());
        let elastic: [f64; 3] = std::array::from_fn(|a| shear * trial[a] * decay[a]);
        let size = norm(logarithms);
        let direction = logarithms.map(|own| own / size);
        let [radius, rise] = self.yield_stress(alpha + ROOT * size);
        let stress = deviatoric(elastic);
        let residual = std::array::from_fn(|a| stress[a] - ROOT * radius * direction[a]);
        let [x, y, z] = direction.map(|own| own / 3.0_f64.sqrt());
        let directions = [direction, [y - z, z - x, x - y]];
        let entry = |a: usize, b: usize| {
            let pair = directions[a].iter().zip(directions[b]).zip(elastic);
            -2.0 * pair.map(|((own, other), elastic)| own * other * elastic).sum::<f64>()
        };
        let slope = [
            [entry(0, 0) - 2.0 * THIRD * rise, entry(0, 1)],
            [entry(1, 0), entry(1, 1) - ROOT * radius / size],
        ];
        Flow { logarithms, decay, residual, directions, slope }
    }

    pub fn respond(&self, shear: f64, at: &Deformed, history: &mut [f64]) -> Isochoric {
        if self.kinematic > 0.0 {
            return kinematic::respond(self, shear, at, history);
        }
        let trial = elastic(at, &unpacked(history));
        let stiffness = 4.0 * THIRD * (shear * THIRD * trace(&trial)).max(shear);
        let step = self.step(shear, &trial, history);
        let b = match step {
            None => trial,
            Some(step) => {
                let b = turned(&step.axes, step.elastic());
                let back = transposed(&at.inverse_transposed);
                let j = at.dilatation.powf(2.0 * THIRD);
                let plastic = product(&product(&back, &b), &at.inverse_transposed);
                pack(&plastic.map(|row| row.map(|value| j * value)), history);
                history[Self::STRAIN] += ROOT * norm(step.flow.logarithms);
                b
            }
        };
        let stress = deviator(&b.map(|row| row.map(|value| shear * value)));
        Isochoric {
            stress: product(&stress, &at.inverse_transposed),
            energy: 0.5 * shear * (trace(&b) - 3.0),
            wave: stiffness * at.steepest() * at.dilatation.max(1.0),
        }
    }

    pub fn tangent(&self, shear: f64, at: &Deformed, before: &[f64]) -> Tangent {
        if self.kinematic > 0.0 {
            return kinematic::tangent(self, shear, at, before);
        }
        let plastic = unpacked(before);
        match self.step(shear, &elastic(at, &plastic), before) {
            Some(step) => Isotropic::new(shear, at, &step.function()).tangent(),
            None => of_elastic(shear, at, &plastic),
        }
    }

    /// `P_aa` and `∂P_aa/∂F_aa` over a step from a history.
    pub(super) fn along(&self, shear: f64, at: &Deformed, before: &[f64], a: usize) -> [f64; 2] {
        let plastic = unpacked(before);
        let trial = elastic(at, &plastic);
        let step = if self.kinematic > 0.0 { None } else { self.step(shear, &trial, before) };
        if let Some(step) = step {
            let linear = Isotropic::new(shear, at, &step.function());
            return [linear.stress()[a][a], linear.slope(a)];
        }
        let mut history = before.to_vec();
        let stress = self.respond(shear, at, &mut history).stress[a][a];
        [stress, self.tangent(shear, at, before)[4 * a][4 * a]]
    }
}

/// ∂P/∂F at a constant C_p⁻¹.
fn of_elastic(shear: f64, at: &Deformed, plastic: &Matrix3) -> Tangent {
    let c = product(&transposed(&at.gradient), &at.gradient);
    of_constant_carrier(at, &plastic.map(|row| row.map(|value| shear * value)), &c)
}

impl Flow {
    /// Change of N for a change of the residual, whose trace does not count.
    fn change(&self, residual: [f64; 3]) -> [f64; 3] {
        let [first, second] = self
            .directions
            .map(|own| own.iter().zip(residual).map(|(own, residual)| own * residual).sum::<f64>());
        let [[a, b], [c, d]] = self.slope;
        let determinant = a * d - b * c;
        let parts =
            [(d * first - b * second) / determinant, (a * second - c * first) / determinant];
        std::array::from_fn(|i| parts[0] * self.directions[0][i] + parts[1] * self.directions[1][i])
    }

    /// Change of N by which Newton's method improves it.
    fn improvement(&self) -> [f64; 3] {
        self.change(self.residual.map(|own| -own))
    }
}

impl Step {
    /// Principal values of b̄ after the step.
    fn elastic(&self) -> [f64; 3] {
        std::array::from_fn(|a| self.trial[a] * self.flow.decay[a])
    }

    /// b̄ as a function of `b̄_tr`.
    fn function(&self) -> Function {
        let (decay, elastic) = (&self.flow.decay, self.elastic());
        // The residual stays zero: ∂r/∂N · δN = −∂r/∂b̄_tr · δb̄_tr.
        let by_trial: Matrix3 = std::array::from_fn(|b| {
            self.flow.change(std::array::from_fn(|a| self.shear * decay[b] * IDENTITY[a][b]))
        });
        let entry =
            |a: usize, b: usize| decay[a] * IDENTITY[a][b] + 2.0 * elastic[a] * by_trial[b][a];
        let along: Matrix3 = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
        let largest = self.trial.iter().copied().fold(0.0, f64::max);
        // An isotropic function turns with its argument.
        let ratio = |a: usize, b: usize| {
            let apart = self.trial[a] - self.trial[b];
            match apart.abs() > EQUAL * largest {
                true => (elastic[a] - elastic[b]) / apart,
                false => along[a][a] - along[a][b],
            }
        };
        let across = std::array::from_fn(|a| std::array::from_fn(|b| ratio(a, b)));
        Function { axes: self.axes, trial: self.trial, elastic, along, across }
    }
}

/// C_p⁻¹ of a history.
pub(super) fn unpacked(history: &[f64]) -> Matrix3 {
    let mut plastic = full(std::array::from_fn(|n| history[n]));
    (0..3).for_each(|a| plastic[a][a] += 1.0);
    plastic
}

/// Writes C_p⁻¹ to a history.
pub(super) fn pack(plastic: &Matrix3, history: &mut [f64]) {
    for (n, value) in packed(plastic).into_iter().enumerate() {
        history[n] = if n < 3 { value - 1.0 } else { value };
    }
}

/// b̄ of a C_p⁻¹.
pub(super) fn elastic(at: &Deformed, plastic: &Matrix3) -> Matrix3 {
    let j = at.dilatation.powf(-2.0 * THIRD);
    let b = product(&product(&at.gradient, plastic), &transposed(&at.gradient));
    b.map(|row| row.map(|value| j * value))
}

/// Changes of b̄ with F at a constant C_p⁻¹.
pub(super) struct Changes<'a> {
    at: &'a Deformed,
    /// b̄.
    elastic: &'a Matrix3,
    j: f64,
    /// C_p⁻¹ Fᵀ.
    half: Matrix3,
}

impl<'a> Changes<'a> {
    pub(super) fn new(at: &'a Deformed, plastic: &Matrix3, elastic: &'a Matrix3) -> Self {
        let half = product(plastic, &transposed(&at.gradient));
        Self { at, elastic, j: at.dilatation.powf(-2.0 * THIRD), half }
    }

    /// δb̄ for δF = e_k ⊗ e_l.
    pub(super) fn of(&self, k: usize, l: usize) -> Matrix3 {
        let mut change = [[0.0; 3]; 3];
        (0..3).for_each(|b| {
            change[k][b] += self.j * self.half[l][b];
            change[b][k] += self.j * self.half[l][b];
        });
        let swelling = 2.0 * THIRD * self.at.inverse_transposed[k][l];
        for n in 0..9 {
            change[n / 3][n % 3] -= swelling * self.elastic[n / 3][n % 3];
        }
        change
    }
}

/// ∂P/∂F, with the changes of s for `δF = e_k ⊗ e_l`: `P = s F^(−T)`, and `δF^(−T) = −F^(−T) δFᵀ F^(−T)`.
pub(super) fn of_kirchhoff(
    at: &Deformed,
    kept: &Matrix3,
    moved: impl Fn(usize, usize) -> Matrix3,
) -> Tangent {
    let mut tangent = [[0.0; 9]; 9];
    for column in 0..9 {
        let (k, l) = (column / 3, column % 3);
        let first = product(&moved(k, l), &at.inverse_transposed);
        for (row, line) in tangent.iter_mut().enumerate() {
            let (i, a) = (row / 3, row % 3);
            let along: f64 = (0..3).map(|m| kept[i][m] * at.inverse_transposed[m][l]).sum();
            line[column] = first[i][a] - along * at.inverse_transposed[k][a];
        }
    }
    tangent
}

/// Matrix of principal values along axes, the columns of a matrix.
fn turned(axes: &Matrix3, values: [f64; 3]) -> Matrix3 {
    let entry = |a: usize, b: usize| (0..3).map(|n| axes[a][n] * values[n] * axes[b][n]).sum();
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

fn deviatoric(values: [f64; 3]) -> [f64; 3] {
    let mean = THIRD * values.iter().sum::<f64>();
    values.map(|value| value - mean)
}

pub(super) fn norm(values: [f64; 3]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

pub(super) fn trace(m: &Matrix3) -> f64 {
    m[0][0] + m[1][1] + m[2][2]
}

pub(super) fn deviator(m: &Matrix3) -> Matrix3 {
    let mean = THIRD * (m[0][0] + m[1][1] + m[2][2]);
    std::array::from_fn(|a| std::array::from_fn(|b| m[a][b] - mean * IDENTITY[a][b]))
}

//! Back stress of metals of large strain: linear kinematic hardening with a stored energy.
//!
//! With `F = F_e F_p`, plastic stretch stores the energy `½ h (tr b_p − 3)`, `b_p = F_p F_pᵀ`, `h = ⅓ H_k`, beside the
//! elastic `½ µ (tr C̄_e − 3)`, `C̄_e = J^(−2/3) F_p^(−T) C F_p⁻¹`. In the intermediate configuration
//!
//! - the back stress is the deviator `χ = h dev b_p`, which is `⅔ H_k εₚ` for small strains (W. Prager 1956);
//! - yield: `‖ξ‖ ≤ √⅔ σ_y(α)`, `ξ = µ dev C̄_e − χ`;
//! - flow: `Ḟ_p F_p⁻¹ = γ̇ ξ/‖ξ‖`, without spin, `α̇ = √⅔ γ̇`, and `‖ξ‖ γ̇ ≥ 0` is dissipated.
//!
//! This is the model of W. Dettmer and S. Reese (2004, doi 10.1016/j.cma.2003.09.005) and I. N. Vladimirov et al.
//! (2008, doi 10.1002/nme.2234) without recovery. Turning the intermediate configuration changes nothing, so the
//! history is C_p, and any F_p of that C_p serves, here a triangular one. χ and C̄_e need not have common axes (F. J.
//! Montáns and K.-J. Bathe 2005, doi 10.1002/nme.1270): a return along the axes of the trial would turn χ.
//!
//! A step is `F_p ← e^N F_p`, `N = Δγ ξ/‖ξ‖` with ξ of its end (G. Weber and L. Anand 1990, doi
//! 10.1016/0045-7825(90)90131-5): it keeps the volume, and is exact where the axes of ξ stay. N follows from Newton's
//! method in its principal axes; the tangent is the derivative of this step, which is not symmetric.

use nalgebra::{Matrix6, Vector6};

use super::plastic::{
    Changes, Plastic, ROOT, deviator, elastic, norm, of_kirchhoff, pack, trace, unpacked,
};
use super::{Deformed, Isochoric, Tangent};
use crate::math::matrix3::{
    Matrix3, contraction, eigen, full, inverse, packed, product, transposed,
};

/// A point at the end of a step without flow, in the intermediate configuration.
struct Point<'a> {
    metal: &'a Plastic,
    /// µ and h [Pa].
    shear: f64,
    back: f64,
    /// Lower triangle `F_p⁻¹` before the step.
    frame: Matrix3,
    /// C̄_e and b_p.
    elastic: Matrix3,
    plastic: Matrix3,
    /// α before the step.
    accumulated: f64,
}

/// Flow over a step, with all tensors in the principal axes of N.
struct Flow {
    /// Principal values of N, and its axes as columns.
    logarithms: [f64; 3],
    axes: Matrix3,
    /// C̄_e without flow.
    trial: Matrix3,
    /// `ξ − √⅔ σ_y N/‖N‖` [Pa], and its derivative by N.
    residual: Matrix3,
    slope: Matrix6<f64>,
}

const THIRD: f64 = 1.0 / 3.0;
const ITERATIONS: usize = 60;
/// Halvings of an iteration, after which the residual falls no more.
const HALVINGS: usize = 12;
/// Residual over the moduli at which N has converged, and that which may remain where it falls no more.
const CONVERGED: f64 = 4.0 * f64::EPSILON;
const STALLED: f64 = 1e-12;

/// Advances the history; returns the response, which is not a number where no flow is found.
pub(super) fn respond(
    metal: &Plastic,
    shear: f64,
    at: &Deformed,
    history: &mut [f64],
) -> Isochoric {
    let point = Point::new(metal, shear, at, history);
    if point.yields() {
        match point.flow() {
            Some(flow) => {
                pack(&point.plastic_after(&flow), history);
                history[Plastic::STRAIN] += ROOT * norm(flow.logarithms);
            }
            None => history.fill(f64::NAN),
        }
    }
    let plastic = unpacked(history);
    let b = elastic(at, &plastic);
    let stress = deviator(&b.map(|row| row.map(|value| shear * value)));
    let stored = shear * (trace(&b) - 3.0) + point.back * (trace(&inverse(&plastic).0) - 3.0);
    let stiffness = 4.0 * THIRD * (THIRD * shear * trace(&point.elastic)).max(shear);
    Isochoric {
        stress: product(&stress, &at.inverse_transposed),
        energy: 0.5 * stored,
        wave: stiffness * at.steepest() * at.dilatation.max(1.0),
    }
}

/// ∂P/∂F over a step from a history.
pub(super) fn tangent(metal: &Plastic, shear: f64, at: &Deformed, before: &[f64]) -> Tangent {
    let point = Point::new(metal, shear, at, before);
    let flow = if point.yields() { point.flow() } else { None };
    let plastic = flow.as_ref().map_or_else(|| unpacked(before), |flow| point.plastic_after(flow));
    let b = elastic(at, &plastic);
    let kept = deviator(&b.map(|row| row.map(|value| shear * value)));
    let changes = Changes::new(at, &plastic, &b);
    let by_flow = flow.map(|flow| ByFlow::new(&point, at, flow));
    of_kirchhoff(at, &kept, |k, l| {
        let mut change = changes.of(k, l);
        if let Some(by_flow) = &by_flow {
            add(&mut change, &by_flow.of(k, l));
        }
        deviator(&change.map(|row| row.map(|value| shear * value)))
    })
}

impl<'a> Point<'a> {
    fn new(metal: &'a Plastic, shear: f64, at: &Deformed, before: &[f64]) -> Self {
        let frame = triangle(&unpacked(before));
        let (stretch, _) = inverse(&frame);
        let j = at.dilatation.powf(-2.0 * THIRD);
        let elastic = square(&product(&at.gradient, &frame));
        Self {
            metal,
            shear,
            back: THIRD * metal.kinematic,
            frame,
            elastic: elastic.map(|row| row.map(|value| j * value)),
            plastic: square(&transposed(&stretch)),
            accumulated: before[Plastic::STRAIN],
        }
    }

    /// ξ of C̄_e and b_p.
    fn driving(&self, elastic: &Matrix3, plastic: &Matrix3) -> Matrix3 {
        let entry = |a: usize, b: usize| self.shear * elastic[a][b] - self.back * plastic[a][b];
        deviator(&std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b))))
    }

    /// Beyond rounding: a point that begins a step on its yield surface is elastic where it unloads.
    fn yields(&self) -> bool {
        let driving = self.driving(&self.elastic, &self.plastic);
        let [radius, _] = self.metal.yield_stress(self.accumulated);
        contraction(&driving, &driving).sqrt() > ROOT * radius + 2.0 * CONVERGED * self.moduli()
    }

    /// Scale of ξ and of its changes [Pa].
    fn moduli(&self) -> f64 {
        self.shear * trace(&self.elastic) + self.back * trace(&self.plastic)
    }

    /// N by Newton's method with a line search, from a radial return.
    fn flow(&self) -> Option<Flow> {
        let driving = self.driving(&self.elastic, &self.plastic);
        let size = contraction(&driving, &driving).sqrt();
        let [radius, rise] = self.metal.yield_stress(self.accumulated);
        let moduli = self.moduli();
        let first = (size - ROOT * radius) / (2.0 * THIRD * (moduli + rise));
        let mut logarithm = driving.map(|row| row.map(|value| first / size * value));
        let mut now = self.at(&logarithm);
        for _ in 0..ITERATIONS {
            let excess = now.excess();
            if excess <= CONVERGED * moduli {
                return Some(now);
            }
            let mut change = now.improvement()?;
            let next = (0..HALVINGS).find_map(|_| {
                let mut to = logarithm;
                add(&mut to, &change);
                let trial = self.at(&to);
                change = change.map(|row| row.map(|value| 0.5 * value));
                (trial.excess() < excess).then_some((to, trial))
            });
            let Some(next) = next else { break };
            (logarithm, now) = next;
        }
        (now.excess() <= STALLED * moduli).then_some(now)
    }

    /// State at an N.
    fn at(&self, logarithm: &Matrix3) -> Flow {
        let (logarithms, axes) = eigen(logarithm);
        let [trial, before] = [&self.elastic, &self.plastic].map(|own| turned(&axes, own));
        let growth = logarithms.map(f64::exp);
        let scaled = |m: &Matrix3, by: [f64; 3]| -> Matrix3 {
            std::array::from_fn(|a| std::array::from_fn(|b| by[a] * m[a][b] * by[b]))
        };
        let decay = logarithms.map(|value| (-value).exp());
        let (elastic, plastic) = (scaled(&trial, decay), scaled(&before, growth));
        let size = norm(logarithms);
        let direction = logarithms.map(|value| value / size);
        let [radius, rise] = self.metal.yield_stress(self.accumulated + ROOT * size);
        let mut residual = self.driving(&elastic, &plastic);
        (0..3).for_each(|a| residual[a][a] -= ROOT * radius * direction[a]);
        let of = |strain: Matrix3| {
            let elastic = both(&product(&slope(logarithms, -1.0, &strain), &trial), decay);
            let plastic = both(&product(&slope(logarithms, 1.0, &strain), &before), growth);
            let mut change = self.driving(&elastic, &plastic);
            let along: f64 = (0..3).map(|a| direction[a] * strain[a][a]).sum();
            let turning = ROOT * radius / size;
            for (a, row) in change.iter_mut().enumerate() {
                for (value, strain) in row.iter_mut().zip(strain[a]) {
                    *value -= turning * strain;
                }
                row[a] += (turning - 2.0 * THIRD * rise) * along * direction[a];
            }
            // N has no trace: that of a residual is none of its changes.
            let mean = THIRD * (trace(&change) + (self.shear + turning) * trace(&strain));
            (0..3).for_each(|a| change[a][a] -= mean);
            change
        };
        let columns: [Vector6<f64>; 6] = std::array::from_fn(|n| vector(&of(unit(n))));
        Flow { logarithms, axes, trial, residual, slope: Matrix6::from_columns(&columns) }
    }

    /// C_p⁻¹ after a flow.
    fn plastic_after(&self, flow: &Flow) -> Matrix3 {
        let frame = product(&self.frame, &flow.axes);
        let decay = flow.logarithms.map(|value| (-2.0 * value).exp());
        let entry = |a: usize, b: usize| (0..3).map(|n| frame[a][n] * decay[n] * frame[b][n]).sum();
        std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
    }
}

impl Flow {
    /// Norm of the residual [Pa].
    fn excess(&self) -> f64 {
        contraction(&self.residual, &self.residual).sqrt()
    }

    /// Change of N by which Newton's method improves it, in the axes of the intermediate configuration.
    fn improvement(&self) -> Option<Matrix3> {
        let change = self.slope.lu().solve(&-vector(&self.residual))?;
        Some(turned(&transposed(&self.axes), &matrix(&change)))
    }
}

/// Derivative of b̄ by F that is due to the flow.
struct ByFlow {
    flow: Flow,
    slope: nalgebra::LU<f64, nalgebra::U6, nalgebra::U6>,
    /// `F_p⁻¹` before the step and `F F_p⁻¹`, whose columns are the axes of N.
    frame: Matrix3,
    along: Matrix3,
    /// F^(−T), J^(−2/3) and µ.
    inverse_transposed: Matrix3,
    j: f64,
    shear: f64,
}

impl ByFlow {
    fn new(point: &Point, at: &Deformed, flow: Flow) -> Self {
        let frame = product(&point.frame, &flow.axes);
        Self {
            slope: flow.slope.lu(),
            frame,
            along: product(&at.gradient, &frame),
            inverse_transposed: at.inverse_transposed,
            j: at.dilatation.powf(-2.0 * THIRD),
            shear: point.shear,
            flow,
        }
    }

    /// Part of δb̄ for δF = e_k ⊗ e_l.
    fn of(&self, k: usize, l: usize) -> Matrix3 {
        let (along, frame, trial) = (self.along[k], self.frame[l], &self.flow.trial);
        let decay = self.flow.logarithms.map(|value| (-value).exp());
        let swelling = 2.0 * THIRD * self.inverse_transposed[k][l];
        let pushed = |a: usize, b: usize| {
            let change = self.j * (along[a] * frame[b] + frame[a] * along[b]);
            decay[a] * (change - swelling * trial[a][b]) * decay[b]
        };
        let pushed = std::array::from_fn(|a| std::array::from_fn(|b| -self.shear * pushed(a, b)));
        let found = self.slope.solve(&vector(&deviator(&pushed)));
        // A flow was found with this slope, so it has an inverse.
        let strain = found.map_or([[f64::NAN; 3]; 3], |found| matrix(&found));
        let change = slope(self.flow.logarithms, -1.0, &strain);
        let change = std::array::from_fn(|a| {
            std::array::from_fn(|b| self.j * change[a][b] * (decay[a] + decay[b]))
        });
        product(&product(&self.along, &change), &transposed(&self.along))
    }
}

/// Change of `e^(±N)` for a change of N, in the principal axes of N.
fn slope(logarithms: [f64; 3], sign: f64, change: &Matrix3) -> Matrix3 {
    let entry = |a: usize, b: usize| {
        let apart = sign * (logarithms[a] - logarithms[b]);
        let mean = if apart == 0.0 { 1.0 } else { apart.exp_m1() / apart };
        sign * (sign * logarithms[b]).exp() * mean * change[a][b]
    };
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

/// `X D + D Xᵀ` with a diagonal D.
fn both(x: &Matrix3, d: [f64; 3]) -> Matrix3 {
    std::array::from_fn(|a| std::array::from_fn(|b| x[a][b] * d[b] + d[a] * x[b][a]))
}

/// Lower triangle L with `L Lᵀ` = m; not a number where there is none.
fn triangle(m: &Matrix3) -> Matrix3 {
    let mut l: Matrix3 = [[0.0; 3]; 3];
    for a in 0..3 {
        for b in 0..=a {
            let rest = m[a][b] - (0..b).map(|n| l[a][n] * l[b][n]).sum::<f64>();
            l[a][b] = if a == b { rest.sqrt() } else { rest / l[b][b] };
        }
    }
    l
}

/// `mᵀm`
fn square(m: &Matrix3) -> Matrix3 {
    product(&transposed(m), m)
}

/// `Qᵀ m Q`
fn turned(axes: &Matrix3, m: &Matrix3) -> Matrix3 {
    product(&product(&transposed(axes), m), axes)
}

fn add(sum: &mut Matrix3, other: &Matrix3) {
    sum.iter_mut().flatten().zip(other.as_flattened()).for_each(|(sum, other)| *sum += other);
}

/// Symmetric matrix of a component, shears twice.
fn unit(component: usize) -> Matrix3 {
    full(std::array::from_fn(|n| f64::from(u8::from(n == component))))
}

fn vector(m: &Matrix3) -> Vector6<f64> {
    Vector6::from(packed(m))
}

fn matrix(v: &Vector6<f64>) -> Matrix3 {
    full((*v).into())
}

#[cfg(test)]
mod tests;

//! Newton's method with a line search: displacements and enhanced strains under which forces balance.
//!
//! Over a step, stress is the derivative of a convex energy, because the laws are associated and do not soften. The
//! work of the residual forces on a change of displacement therefore decreases along the change. A change is shortened
//! if this work reverses its sign strongly. Tangents are consistent, so convergence is quadratic in the end. Linear
//! systems are solved only as accurately as this requires (S. C. Eisenstat and H. F. Walker 1996, doi 10.1137/0917003).

use super::grid::{Grid, Iterate};
use super::problem::InelasticError;
use super::tangent::TangentSolver;
use crate::laws::{PointConstants, Relaxation};
use crate::math::separable::dot;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

/// Iterations and residual of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Linear systems solved.
    pub iterations: usize,
    /// Total number of conjugate-gradient iterations; zero if tangents are factored.
    pub linear_iterations: usize,
    /// Residual forces, relative to the forces of single elements on nodes.
    pub residual: f64,
}

/// Relative residual at which a step has converged.
const TOLERANCE: f64 = 1e-12;
/// Residual that is accepted where rounding prevents a smaller one.
const ROUNDED: f64 = 1e-10;
/// Largest number of linear systems in a step.
const MOST_ITERATIONS: usize = 60;
/// Approximate number of updates of unknowns for the response of all points to a change and the set-up of a linear
/// system.
const ROUNDS: f64 = 10.0;
/// Largest number of evaluations along a change.
const MOST_LOOKS: usize = 8;

/// One step: all data that are constant during the iterations.
pub struct Step<'a> {
    pub grid: &'a Grid,
    pub solver: &'a TangentSolver,
    pub team: &'a Team,
    pub constants: &'a [PointConstants],
    /// Of each layer of elements.
    pub relaxation: &'a [Option<&'a Relaxation>],
    pub old: &'a [f64],
    /// Nodal forces.
    pub load: &'a [f64],
    pub allowance: &'a Allowance,
}

impl Step<'_> {
    /// Finds equilibrium from the displacements and amplitudes of an iterate.
    pub fn balance(&self, iterate: &mut Iterate) -> Result<Progress, InelasticError> {
        self.respond(iterate);
        let mut left = self.left(iterate);
        let mut part = self.measure(iterate, &left);
        let mut progress = Progress { iterations: 0, linear_iterations: 0, residual: part };
        let mut before = f64::INFINITY;
        let mut accuracy = 1e-3;
        while part > TOLERANCE {
            let gains_nothing = part <= ROUNDED && part > 0.9 * before;
            if gains_nothing {
                break;
            }
            if progress.iterations == MOST_ITERATIONS || !part.is_finite() {
                return Err(InelasticError::NoEquilibrium {
                    iterations: progress.iterations,
                    residual: part,
                    tolerance: TOLERANCE,
                });
            }
            self.grid.condense(self.team, iterate, &mut left);
            self.solver.hold(self.grid, &mut left);
            let (change, linear) =
                self.solver.solve(self.grid, iterate, &left, accuracy, self.team)?;
            progress.iterations += 1;
            progress.linear_iterations += linear;
            let rounds = ROUNDS + linear as f64;
            self.allowance.spend(rounds, "iterations of equilibrium", left.len())?;
            self.advance(iterate, &change);
            left = self.left(iterate);
            before = part;
            part = self.measure(iterate, &left);
            let gain: f64 = part / before;
            // No more accurate than quadratic convergence will gain, or than the final tolerance requires.
            accuracy = (0.5 * gain * gain).max(0.1 * TOLERANCE / part).clamp(1e-10, 1e-2);
        }
        progress.residual = part;
        Ok(progress)
    }

    fn respond(&self, iterate: &mut Iterate) {
        self.grid.respond(self.team, (self.constants, self.relaxation), self.old, iterate);
    }

    /// Returns the residual forces of the displacements.
    fn left(&self, iterate: &Iterate) -> Vec<f64> {
        let mut left: Vec<f64> =
            self.load.iter().zip(&iterate.forces).map(|(load, force)| load - force).collect();
        self.solver.hold(self.grid, &mut left);
        left
    }

    /// Norm of the residual forces, on nodes and on amplitudes.
    fn measure(&self, iterate: &Iterate, left: &[f64]) -> f64 {
        let elements: f64 = iterate.scales.iter().map(|[force, _]| force * force).sum();
        let scale = elements.sqrt().max(dot(self.load, self.load).sqrt());
        let nodes = dot(left, left).sqrt();
        let modes = self.grid.kit.treatment.modes();
        let mut part = if nodes == 0.0 { 0.0 } else { nodes / scale };
        if modes > 0 {
            let volume = iterate.scales.iter().fold(0.0_f64, |most, [_, s]| most.max(*s));
            let most =
                iterate.mode_forces.iter().fold(0.0_f64, |most, force| match force.is_nan() {
                    true => f64::INFINITY,
                    false => most.max(force.abs()),
                });
            part = part.max(if most == 0.0 { 0.0 } else { most / volume });
        }
        part
    }

    /// Moves along a change as far as energy decreases.
    fn advance(&self, iterate: &mut Iterate, change: &[f64]) {
        let amplitudes = self.grid.following(self.team, iterate, change);
        let base = (iterate.displacement.clone(), iterate.amplitudes.clone());
        let first = self.slope(iterate, change, &amplitudes);
        let go = |part: f64, iterate: &mut Iterate| {
            let along = |to: &mut [f64], from: &[f64], by: &[f64]| {
                to.iter_mut().zip(from).zip(by).for_each(|((to, from), by)| *to = from + part * by);
            };
            along(&mut iterate.displacement, &base.0, change);
            along(&mut iterate.amplitudes, &base.1, &amplitudes);
            self.respond(iterate);
            self.slope(iterate, change, &amplitudes)
        };
        let mut slope = go(1.0, iterate);
        let (mut low, mut high) = ((0.0, first), (1.0, slope));
        let mut enough = 0.8;
        for _ in 0..MOST_LOOKS {
            if slope <= enough * first.abs() {
                return;
            }
            enough = 0.5;
            let width = high.0 - low.0;
            let crossing = low.0 - low.1 * width / (high.1 - low.1);
            let inside = crossing.clamp(low.0 + 0.1 * width, low.0 + 0.9 * width);
            let part = if inside.is_finite() { inside } else { low.0 + 0.5 * width };
            slope = go(part, iterate);
            if slope < 0.0 {
                if slope.abs() <= enough * first.abs() {
                    return;
                }
                low = (part, slope);
            } else {
                high = (part, slope);
            }
        }
    }

    /// Derivative of energy along a change.
    fn slope(&self, iterate: &Iterate, change: &[f64], amplitudes: &[f64]) -> f64 {
        dot(&iterate.forces, change) - dot(self.load, change)
            + dot(&iterate.mode_forces, amplitudes)
    }
}

//! One step in time: four stages, of which the first is explicit, of third order with an error estimate of second
//! (A. Kværnø 2004, doi 10.1023/B:BITN.0000046811.70614.38, method 3(2)).
//!
//! All stages are of second order, so moving prescribed temperatures do not reduce the order. The last stage is the end
//! of the step and damps fast modes completely (L-stable). The stage before it, with which the end is compared, does
//! not damp them, so a step after a jump is recognised as too long.

use super::body::{Body, Drive, Flow};
use super::setup::Loads;
use super::stage::{Stage, Unsolved};
use crate::method::heat_totals::HeatTotals;
use crate::runtime::allowance::Allowance;

/// γ: root of `γ³ − 3γ² + 3γ/2 − 1/6`.
const GAMMA: f64 = 0.435_866_521_508_459;
const STAGES: usize = 4;
/// Fraction of the tolerance allowed for the residual of Newton's method.
const NEWTON: f64 = 0.02;

/// Times of the stages, and the weights of their flows.
const TIMES: [f64; STAGES] = [0.0, 2.0 * GAMMA, 1.0, 1.0];
const WEIGHTS: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [GAMMA, GAMMA, 0.0, 0.0],
    [
        (-4.0 * GAMMA * GAMMA + 6.0 * GAMMA - 1.0) / (4.0 * GAMMA),
        (1.0 - 2.0 * GAMMA) / (4.0 * GAMMA),
        GAMMA,
        0.0,
    ],
    [
        (6.0 * GAMMA - 1.0) / (12.0 * GAMMA),
        -1.0 / ((24.0 * GAMMA - 12.0) * GAMMA),
        (-6.0 * GAMMA * GAMMA + 6.0 * GAMMA - 1.0) / (6.0 * GAMMA - 3.0),
        GAMMA,
    ],
];

/// Result of a step.
pub struct Outcome {
    pub contents: Vec<f64>,
    /// Heat that entered and left the mesh during the step [J].
    pub passed: HeatTotals,
    /// Estimate of the error over the tolerance.
    pub error: f64,
}

#[derive(Clone, Copy)]
pub struct Step<'a> {
    pub body: &'a Body,
    pub loads: &'a [Loads<'a>],
    /// Beginning within the loads' polynomials, and length of the step [s].
    pub start: f64,
    pub length: f64,
    /// [K]
    pub tolerance: f64,
    pub allowance: &'a Allowance,
}

impl Step<'_> {
    pub fn take(&self, contents: &[f64]) -> Result<Outcome, Unsolved> {
        let body = self.body;
        let drive = |stage: usize| Drive::at(self.loads, self.start + TIMES[stage] * self.length);
        let first = drive(0);
        let mut begin = contents.to_vec();
        body.hold(&mut begin, &first);
        let mut flows = vec![body.flow(&body.fields(&begin), &first)];
        let mut ends = vec![begin];
        for (stage, weights) in WEIGHTS.iter().enumerate().skip(1) {
            let drive = drive(stage);
            let known = self.gained(contents, &flows, weights);
            let mut guess = self.guess(stage, &ends);
            body.hold(&mut guess, &drive);
            let tau = GAMMA * self.length;
            let tolerance = NEWTON * self.tolerance;
            let allowance = self.allowance;
            let solver = Stage { body, drive: &drive, tau, known: &known, tolerance, allowance };
            let (end, flow) = solver.solve(guess)?;
            ends.push(end);
            flows.push(flow);
        }
        Ok(self.outcome(contents, &ends, &flows))
    }

    /// `V H + Δt Σ a R` over the stages so far [J].
    fn gained(&self, contents: &[f64], flows: &[Flow], weights: &[f64; STAGES]) -> Vec<f64> {
        let mut known: Vec<f64> =
            contents.iter().zip(&self.body.volumes).map(|(h, volume)| h * volume).collect();
        for (flow, weight) in flows.iter().zip(weights) {
            let factor = weight * self.length;
            known.iter_mut().zip(&flow.nodes).for_each(|(sum, heat)| *sum += factor * heat);
        }
        known
    }

    /// Initial guess of Newton's method: on the line through the beginning and the second stage; for the last stage,
    /// the third one, which is at the same time.
    fn guess(&self, stage: usize, ends: &[Vec<f64>]) -> Vec<f64> {
        match stage {
            2 => {
                let part = TIMES[2] / TIMES[1];
                ends[0].iter().zip(&ends[1]).map(|(a, b)| a + part * (b - a)).collect()
            }
            _ => ends[stage - 1].clone(),
        }
    }

    fn outcome(&self, contents: &[f64], ends: &[Vec<f64>], flows: &[Flow]) -> Outcome {
        let body = self.body;
        let weights = &WEIGHTS[STAGES - 1];
        let sum = |of: &dyn Fn(&Flow) -> f64| -> f64 {
            flows.iter().zip(weights).map(|(flow, weight)| self.length * weight * of(flow)).sum()
        };
        let brought_in = sum(&|flow| flow.brought_in);
        let mut lost = sum(&|flow| flow.lost);
        let mut end = ends[STAGES - 1].clone();
        let mut error = 0.0_f64;
        for node in 0..end.len() {
            let heat = sum(&|flow| flow.nodes[node]);
            let volume = body.volumes[node];
            if body.held[node] {
                lost += heat - volume * (end[node] - contents[node]);
                continue;
            }
            end[node] = contents[node] + heat / volume;
            let off = (end[node] - ends[STAGES - 2][node]) / body.law(node).at(end[node]).sensible;
            // Not `max` alone, which ignores NaN.
            error = if off.is_nan() { f64::INFINITY } else { error.max(off.abs()) };
        }
        Outcome {
            contents: end,
            passed: HeatTotals { brought_in, lost },
            error: error / self.tolerance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_satisfy_the_conditions_of_their_orders() {
        let sum = |row: usize, power: i32| -> f64 {
            (0..STAGES).map(|j| WEIGHTS[row][j] * TIMES[j].powi(power)).sum()
        };
        for (row, time) in TIMES.iter().enumerate().skip(1) {
            assert!((sum(row, 0) - time).abs() < 1e-14);
            assert!((sum(row, 1) - 0.5 * time * time).abs() < 1e-14);
        }
        assert!((sum(3, 2) - 1.0 / 3.0).abs() < 1e-14);
        let nested: f64 = (0..STAGES).map(|j| WEIGHTS[3][j] * sum(j, 1)).sum();
        assert!((nested - 1.0 / 6.0).abs() < 1e-14);
    }
}

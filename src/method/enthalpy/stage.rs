//! One implicit stage: `V H − τ R(H) = known`, by Newton's method with line search.

use super::body::{Body, Drive, Fields, Flow, Losses};
use super::linear::{Coefficients, System};
use crate::math::{bicgstab, conjugate_gradients};
use crate::runtime::allowance::{Allowance, Halt};
use crate::runtime::parallel::Team;

/// Largest number of Newton steps in a stage; if more are needed, a shorter step is cheaper.
const MOST_NEWTON: usize = 16;
/// Largest number of halvings of a Newton step.
const MOST_HALVINGS: usize = 7;
/// Rounding error of a residual, relative to its summands.
const ROUNDING: f64 = 32.0 * f64::EPSILON;
/// Residual reduction of a linear system; stricter when Newton's method is about to end.
const LINEAR: f64 = 1e-2;
/// `∂T/∂H` times the heat capacity below which a node counts as melting at one temperature.
const STILL: f64 = 1e-12;

/// Data of an implicit stage.
pub struct Stage<'a> {
    pub body: &'a Body,
    pub drive: &'a Drive,
    /// Length of the implicit step, γ Δt [s].
    pub tau: f64,
    /// Heat of the nodes without the flow of this stage [J].
    pub known: &'a [f64],
    /// Allowed residual, as a temperature [K].
    pub tolerance: f64,
    pub allowance: &'a Allowance,
}

pub enum Unsolved {
    Diverged,
    Halted(Halt),
}

/// An iterate with its residual.
struct Iterate {
    contents: Vec<f64>,
    fields: Fields,
    flow: Flow,
    /// `V H − τ R − known` [J], zero at held nodes.
    residual: Vec<f64>,
}

impl Stage<'_> {
    /// Improves the enthalpies until they solve the stage; returns them with the resulting heat flow.
    pub fn solve(&self, contents: Vec<f64>) -> Result<(Vec<f64>, Flow), Unsolved> {
        let mut iterate = self.look_at(contents);
        for _ in 0..MOST_NEWTON {
            let system = self.system(&iterate.fields);
            let weights = self.weights(&iterate, &system);
            let (largest, size) = norms(&iterate.residual, &weights);
            if largest <= 1.0 {
                return Ok((iterate.contents, iterate.flow));
            }
            let change = self.direction(&iterate, &system, largest)?;
            iterate = self.search(iterate, &change, &weights, size)?;
        }
        Err(Unsolved::Diverged)
    }

    fn look_at(&self, contents: Vec<f64>) -> Iterate {
        let body = self.body;
        let fields = body.fields(&contents);
        let flow = body.flow(&fields, self.drive);
        let residual = |node: usize| match body.held[node] {
            true => 0.0,
            false => {
                let missing = self.known[node] + self.tau * flow.nodes[node];
                body.volumes[node] * contents[node] - missing
            }
        };
        let residual = (0..contents.len()).map(residual).collect();
        Iterate { contents, fields, flow, residual }
    }

    /// Newton's system at the fields of an iterate.
    fn system(&self, fields: &Fields) -> System<'_> {
        let body = self.body;
        let Losses { nodes: mut loss, ends, aside } = body.losses(fields, self.drive);
        let count = fields.rise.len();
        let mut storage = vec![f64::INFINITY; count];
        let mut ratios = [vec![0.0; count], vec![0.0; count]];
        let mut inverse = vec![0.0; count];
        let plane = body.grid.plane();
        for (k, level) in body.grid.levels.iter().enumerate() {
            let mean = |conductivity: [f64; 2]| {
                let [below, above] = level.heights;
                (below * conductivity[0] + above * conductivity[1]) / level.height()
            };
            let reference = mean(body.reference_conductivity(k));
            for node in k * plane..(k + 1) * plane {
                let own = [0, 1].map(|side| fields.conductivity[side][node]);
                inverse[node] = reference / mean(own);
                for side in 0..2 {
                    ratios[side][node] = own[side] * inverse[node];
                }
                loss[node] *= inverse[node];
                let response = fields.inverse_capacity[node];
                if !body.held[node] && response * fields.sensible[node] > STILL {
                    storage[node] = body.volumes[node] * inverse[node] / response;
                }
            }
        }
        let held = &body.held;
        let coefficients = Coefficients { storage, loss, ratios, inverse, ends, aside, held };
        System::new(&body.grid, &body.lateral, self.tau, coefficients)
    }

    /// For each node, the inverse of the allowed residual [1/J].
    fn weights(&self, iterate: &Iterate, system: &System) -> Vec<f64> {
        let body = self.body;
        let weight = |node: usize| {
            let fields = &iterate.fields;
            let wanted = body.volumes[node] * fields.sensible[node] * self.tolerance;
            let sum = (body.volumes[node] * iterate.contents[node]).abs()
                + self.known[node].abs()
                + self.tau * system.conducted(node) * fields.rise[node].abs()
                + self.tau * system.lost(node) * (fields.rise[node].abs() + body.reference);
            1.0 / (wanted + ROUNDING * sum)
        };
        (0..iterate.contents.len()).map(weight).collect()
    }

    /// Newton's change of the enthalpies.
    fn direction(
        &self,
        iterate: &Iterate,
        system: &System,
        largest: f64,
    ) -> Result<Vec<f64>, Unsolved> {
        let still = |node: usize| !system.is_solved(node) && !self.body.held[node];
        let load = |(node, r): (usize, &f64)| if system.is_solved(node) { -r } else { 0.0 };
        let load: Vec<f64> = iterate.residual.iter().enumerate().map(load).collect();
        let tolerance = (0.1 / largest).clamp(1e-10, LINEAR);
        let solved = match self.body.is_symmetric {
            true => conjugate_gradients::solve(system, &load, tolerance, &Team::new(1)),
            false => bicgstab::solve(system, &load, tolerance),
        };
        let (x, iterations) = solved.map_err(|_| Unsolved::Diverged)?;
        let size = load.len();
        let spent = self.allowance.spend(iterations as f64, "iterations of nonlinear heat", size);
        spent.map_err(Unsolved::Halted)?;
        let mut conducted = vec![0.0; size];
        if (0..size).any(still) {
            system.conduct(&x, &mut conducted);
        }
        let change = |node: usize| match (system.is_solved(node), still(node)) {
            (true, _) => system.storage(node) * x[node] / self.body.volumes[node],
            // The temperature is constant and the enthalpy absorbs all heat.
            (false, true) => {
                let heat = self.tau * conducted[node] - iterate.residual[node];
                heat / self.body.volumes[node]
            }
            (false, false) => 0.0,
        };
        Ok((0..size).map(change).collect())
    }

    /// Moves along a direction as far as the residual decreases.
    fn search(
        &self,
        from: Iterate,
        change: &[f64],
        weights: &[f64],
        size: f64,
    ) -> Result<Iterate, Unsolved> {
        let mut part = 1.0;
        for _ in 0..MOST_HALVINGS {
            let contents = from.contents.iter().zip(change).map(|(h, d)| h + part * d).collect();
            let next = self.look_at(contents);
            if norms(&next.residual, weights).1 <= (1.0 - 0.1 * part) * size {
                return Ok(next);
            }
            part *= 0.5;
        }
        Err(Unsolved::Diverged)
    }
}

fn norms(residual: &[f64], weights: &[f64]) -> (f64, f64) {
    let (mut largest, mut sum) = (0.0_f64, 0.0);
    for (r, w) in residual.iter().zip(weights) {
        let scaled = (r * w).abs();
        // Not `max` alone, which ignores NaN.
        largest = if scaled.is_nan() { f64::INFINITY } else { largest.max(scaled) };
        sum += scaled * scaled;
    }
    (largest, sum)
}

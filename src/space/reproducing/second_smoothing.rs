//! Second smoothing of gradients over a length of the material.
//!
//! The mean gradients `∇̃Ψ(X_K)` of nodal cells are averaged once more, `∇̂Ψ(X_L) = Σ_K w_LK ∇̃Ψ(X_K)`, over cells
//! within a radius R that does not depend on the mesh, so that strain that softens does not localise in one row of
//! nodes. The weights are `V_L w_LK = V_L d_L φ(|X_L − X_K|/R) d_K V_K` with the factors d for which `Σ_K w_LK = 1` (R.
//! Sinkhorn 1964, doi 10.1214/aoms/1177703591; symmetric). As `V_L w_LK` is symmetric, `Σ_L V_L w_LK = V_K` too, hence
//! with forces of the same gradients:
//!
//! - linear displacements keep their gradients, and rotations have no stress;
//! - constant stress balances with its tractions as before, `Σ V ∇̂Ψ = Σ V ∇̃Ψ`;
//! - forces do the work of the stresses and have neither resultant nor moment.
//!
//! Gradients that are linear in X are exact within R of no boundary only, and this cannot be helped: of weights with
//! both sums, exact for `X` everywhere, the mean of `Σ_K w_LK |X_K − X_L|²` over the body is 0, so that they do not
//! smooth.
//!
//! Variations of gradients within a cell remain. Source of two levels: D. Wang & L. Li 2013, Int. J. Damage Mech.
//! 22; of the regularisation: J.-S. Chen, X. Zhang & T. Belytschko 2004, doi 10.1016/j.cma.2003.12.057; the weights are
//! this project's.

use super::super::bins::Bins;
use super::super::{Form, Samples, Value};
use super::kernel::{CubicSpline, Profile};

/// Weights `w_LK` of one cell: other cells in ascending order.
type Weights = Vec<(usize, f64)>;

/// The cells about nodes, of which the points of nodal integration are consecutive parts.
struct Cells {
    volumes: Vec<f64>,
    centres: Vec<[f64; 3]>,
    /// Mean gradient of each function on each cell, by nodes.
    rows: Vec<Vec<(u32, [f64; 3])>>,
}

/// Rounding of a sum of weights at which the factors are found, and iterations, each of which halves the error or
/// better.
const CONVERGED: f64 = 4e-15;
const ITERATIONS: usize = 300;

/// Averages the gradients of points, `points` of which make a cell, over a radius [m].
pub(super) fn smoothed_again(form: Form, samples: &Samples, points: usize, radius: f64) -> Samples {
    let cells = Cells::new(samples, points);
    let weights = weights(form, &cells, radius);
    let nodes = cells.rows.iter().flatten().map(|(node, _)| *node as usize + 1).max().unwrap_or(0);
    let mut row = Row { slots: vec![ABSENT; nodes], values: Vec::new() };
    let mut twice = Samples::default();
    for (cell, weights) in weights.iter().enumerate() {
        for point in cell * points..(cell + 1) * points {
            row.clear();
            for value in samples.row(point) {
                *row.of(value.node) = *value;
            }
            row.add(&cells.rows[cell], -1.0);
            for &(other, weight) in weights {
                row.add(&cells.rows[other], weight);
            }
            row.values.sort_unstable_by_key(|value| value.node);
            twice.push(samples.at[point], samples.weights[point], row.values.iter().copied());
        }
    }
    twice
}

impl Cells {
    fn new(samples: &Samples, points: usize) -> Self {
        let count = samples.len() / points;
        let mut cells = Self { volumes: vec![0.0; count], centres: Vec::new(), rows: Vec::new() };
        for cell in 0..count {
            let (mut centre, mut row) = ([0.0; 3], Vec::new());
            let share = 1.0 / points as f64;
            for point in cell * points..(cell + 1) * points {
                cells.volumes[cell] += samples.weights[point];
                (0..3).for_each(|a| centre[a] += share * samples.at[point][a]);
                let values = samples.row(point);
                row.resize(values.len(), (0, [0.0; 3]));
                for ((node, mean), value) in row.iter_mut().zip(values) {
                    *node = value.node;
                    (0..3).for_each(|a| mean[a] += share * value.gradient[a]);
                }
            }
            cells.centres.push(centre);
            cells.rows.push(row);
        }
        cells
    }
}

fn weights(form: Form, cells: &Cells, radius: f64) -> Vec<Weights> {
    let Cells { volumes, centres, .. } = cells;
    let supports: Vec<_> =
        centres.iter().map(|at| [at.map(|x| x - radius), at.map(|x| x + radius)]).collect();
    let bins = Bins::new(form.axes(), &supports, [radius; 3]);
    let kernel = |a: [f64; 3], b: [f64; 3]| {
        let distance = (0..3).map(|n| (a[n] - b[n]) * (a[n] - b[n])).sum::<f64>().sqrt();
        if distance < radius { CubicSpline::value(distance / radius) } else { 0.0 }
    };
    let near = |cell: usize| -> Weights {
        let of = |&other: &u32| (other as usize, kernel(centres[cell], centres[other as usize]));
        bins.near(centres[cell]).iter().map(of).filter(|(_, value)| *value > 0.0).collect()
    };
    let mut all: Vec<Weights> = (0..centres.len()).map(near).collect();
    let scaled = |factors: &[f64], row: &Weights| -> f64 {
        row.iter().map(|&(other, value)| value * factors[other] * volumes[other]).sum()
    };
    let even = vec![1.0; centres.len()];
    let mut factors: Vec<f64> = all.iter().map(|row| scaled(&even, row).recip().sqrt()).collect();
    for _ in 0..ITERATIONS {
        let sums: Vec<f64> =
            all.iter().zip(&factors).map(|(row, own)| own * scaled(&factors, row)).collect();
        if sums.iter().all(|sum| (sum - 1.0).abs() <= CONVERGED) {
            break;
        }
        factors.iter_mut().zip(&sums).for_each(|(own, sum)| *own /= sum.sqrt());
    }
    for (cell, row) in all.iter_mut().enumerate() {
        row.iter_mut()
            .for_each(|(other, value)| *value *= factors[cell] * factors[*other] * volumes[*other]);
    }
    all
}

/// A row of values under construction.
struct Row {
    /// Place of each node in `values`; `ABSENT` if it has none.
    slots: Vec<u32>,
    values: Vec<Value>,
}

const ABSENT: u32 = u32::MAX;

impl Row {
    fn clear(&mut self) {
        for value in self.values.drain(..) {
            self.slots[value.node as usize] = ABSENT;
        }
    }

    fn of(&mut self, node: u32) -> &mut Value {
        let slot = &mut self.slots[node as usize];
        if *slot == ABSENT {
            *slot = self.values.len() as u32;
            self.values.push(Value { node, value: 0.0, gradient: [0.0; 3] });
        }
        &mut self.values[*slot as usize]
    }

    fn add(&mut self, gradients: &[(u32, [f64; 3])], factor: f64) {
        for (node, gradient) in gradients {
            let own = self.of(*node);
            (0..3).for_each(|a| own.gradient[a] += factor * gradient[a]);
        }
    }
}

#[cfg(test)]
mod tests;

//! Minimum of a convex quadratic function between bounds, by projected Newton steps.
//!
//! Values at a bound that the gradient pushes outwards are held; conjugate gradients find the others' minimum, and the
//! step there is projected onto the bounds and shortened until the function falls (D. P. Bertsekas 1982, doi
//! 10.1137/0320018).

use crate::math::grid_matrix::{GridMatrix, Padded};
use crate::runtime::parallel::Team;

/// Largest numbers of projected steps and of conjugate-gradient iterations in each.
const MOST_STEPS: usize = 60;
const MOST_ITERATIONS: usize = 2000;
/// Reduction of the residual by conjugate gradients in a step.
const REDUCTION: f64 = 1e-3;

/// Minimises `½ d·A d − b·d` over `low ≤ d ≤ 1` from the values of `damage`, until no value would move by more than
/// `tolerance`; only `nodes` change. Returns the gradient there at the values before, and zero elsewhere.
pub fn minimise<const D: usize>(
    (matrix, load): (&GridMatrix<D, 1>, &[f64]),
    nodes: &[u32],
    low: &[f64],
    damage: &mut Padded<1>,
    tolerance: f64,
    team: &Team,
) -> Vec<f64> {
    let gradient_of = |damage: &Padded<1>| -> Vec<f64> {
        let mut product = vec![0.0; nodes.len()];
        matrix.product_of(nodes, damage, &mut product, team);
        let mut gradient = vec![0.0; load.len()];
        for (&n, product) in nodes.iter().zip(&product) {
            gradient[n as usize] = product - load[n as usize];
        }
        gradient
    };
    let first = gradient_of(damage);
    let mut gradient = first.clone();
    for _ in 0..MOST_STEPS {
        let d = damage.inner();
        let is_free = |&n: &u32| {
            let n = n as usize;
            let is_held = d[n] <= low[n] && gradient[n] > 0.0 || d[n] >= 1.0 && gradient[n] < 0.0;
            !is_held
        };
        let free: Vec<u32> = nodes.iter().copied().filter(is_free).collect();
        let step = newton_step(matrix, &free, &gradient, team);
        let moved = project(matrix, &free, &step, &gradient, low, damage, team);
        if moved <= tolerance {
            break;
        }
        gradient = gradient_of(damage);
    }
    first
}

/// Takes the longest of the step and its halves along which the function falls; returns the largest change of a value.
fn project<const D: usize>(
    matrix: &GridMatrix<D, 1>,
    free: &[u32],
    step: &[f64],
    gradient: &[f64],
    low: &[f64],
    damage: &mut Padded<1>,
    team: &Team,
) -> f64 {
    let mut change = Padded::zeros(matrix.grid());
    let mut product = vec![0.0; free.len()];
    let mut part = 1.0;
    for _ in 0..20 {
        let mut largest = 0.0_f64;
        for (&n, step) in free.iter().zip(step) {
            let n = n as usize;
            let d = damage.inner()[n];
            let own = (d + part * step).clamp(low[n], 1.0) - d;
            change.inner_mut()[n] = own;
            largest = largest.max(own.abs());
        }
        matrix.product_of(free, &change, &mut product, team);
        let of_free = free.iter().zip(&product).map(|(&n, product)| {
            let n = n as usize;
            change.inner()[n] * (gradient[n] + 0.5 * product)
        });
        if of_free.sum::<f64>() <= 0.0 {
            for &n in free {
                damage.inner_mut()[n as usize] += change.inner()[n as usize];
            }
            return largest;
        }
        part *= 0.5;
    }
    0.0
}

/// Step of the free values to their minimum, by conjugate gradients preconditioned by the diagonal.
fn newton_step<const D: usize>(
    matrix: &GridMatrix<D, 1>,
    free: &[u32],
    gradient: &[f64],
    team: &Team,
) -> Vec<f64> {
    let mut residual: Vec<f64> = free.iter().map(|&n| -gradient[n as usize]).collect();
    let inverse: Vec<f64> = free.iter().map(|&n| 1.0 / matrix.diagonal(n as usize)[0]).collect();
    let improved = |residual: &[f64]| -> Vec<f64> {
        residual.iter().zip(&inverse).map(|(r, inverse)| r * inverse).collect()
    };
    let mut step = vec![0.0; free.len()];
    let mut direction = improved(&residual);
    let mut energy = dot(&residual, &direction);
    let wanted = REDUCTION * REDUCTION * energy;
    let mut padded = Padded::zeros(matrix.grid());
    let mut product = vec![0.0; free.len()];
    for _ in 0..MOST_ITERATIONS {
        if energy <= wanted || energy <= 0.0 {
            break;
        }
        free.iter().zip(&direction).for_each(|(&n, d)| padded.inner_mut()[n as usize] = *d);
        matrix.product_of(free, &padded, &mut product, team);
        let length = energy / dot(&direction, &product);
        for k in 0..free.len() {
            step[k] += length * direction[k];
            residual[k] -= length * product[k];
        }
        let next = improved(&residual);
        let own = dot(&residual, &next);
        let part = own / energy;
        direction.iter_mut().zip(&next).for_each(|(d, z)| *d = z + part * *d);
        energy = own;
    }
    step
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

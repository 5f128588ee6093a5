//! Highest frequency of a lattice, which bounds its time step.

use nalgebra::DMatrix;

use super::frame::COMPONENTS;
use super::link::Link;

/// Iterations, after which the square of the frequency is known to a thousandth, from below.
const ITERATIONS: usize = 60;
/// Part of the largest number so far below which nothing is left to find.
const NOTHING: f64 = 1e-9;

/// Highest frequency of undamaged links [1/s], whatever holds them; `inverse` has the inverse mass [1/kg] and rotary
/// inertia [1/(kg m²)] of each particle. Lanczos' method (C. Lanczos 1950, doi 10.6028/jres.045.026).
pub fn highest_frequency(links: &[Link], inverse: &[[f64; 2]]) -> f64 {
    let roots: Vec<f64> = inverse
        .iter()
        .flat_map(|[mass, inertia]| [*mass, *mass, *inertia])
        .map(f64::sqrt)
        .collect();
    let mut own = start(roots.len());
    let mut before = vec![0.0; roots.len()];
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for _ in 0..ITERATIONS.min(roots.len()) {
        let mut next = product(links, &roots, &own);
        let coupling = beside.last().copied().unwrap_or(0.0);
        let along: f64 = next.iter().zip(&own).map(|(a, b)| a * b).sum();
        for ((next, own), before) in next.iter_mut().zip(&own).zip(&before) {
            *next -= along * own + coupling * before;
        }
        diagonal.push(along);
        let norm = next.iter().map(|part| part * part).sum::<f64>().sqrt();
        beside.push(norm);
        if norm <= NOTHING * diagonal.iter().copied().fold(0.0, f64::max) {
            break;
        }
        next.iter_mut().for_each(|part| *part /= norm);
        before = std::mem::replace(&mut own, next);
    }
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    };
    let small = DMatrix::from_fn(diagonal.len(), diagonal.len(), entry);
    small.symmetric_eigenvalues().max().max(0.0).sqrt()
}

/// A unit vector without order.
fn start(size: usize) -> Vec<f64> {
    let rough = (0..size).map(|k| (1.3 * k as f64 + 0.7 * (k as f64).powi(2)).sin());
    let rough: Vec<f64> = rough.collect();
    let norm = rough.iter().map(|part| part * part).sum::<f64>().sqrt();
    rough.into_iter().map(|part| part / norm).collect()
}

/// Product of the stiffness with a vector, both scaled by the roots of the inverse masses.
fn product(links: &[Link], roots: &[f64], of: &[f64]) -> Vec<f64> {
    let mut forces = vec![0.0; of.len()];
    for link in links {
        let components = link.ends.map(|end| COMPONENTS * end);
        let at = |k: usize| components[k / COMPONENTS] + k % COMPONENTS;
        let rows = link.rows();
        let q = rows.map(|row| (0..6).map(|k| row[k] * roots[at(k)] * of[at(k)]).sum());
        let conjugate = link.elastic(&q);
        for k in 0..6 {
            forces[at(k)] += (0..3).map(|m| rows[m][k] * conjugate[m]).sum::<f64>();
        }
    }
    forces.iter().zip(roots).map(|(force, root)| force * root).collect()
}

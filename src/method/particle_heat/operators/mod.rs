//! Second derivatives on scattered particles: functions of one particle and its neighbours.
//!
//! `r = x_j − x_i` points from the particle to a neighbour, and `e = r/|r|`. Every neighbour has the weight
//! `w = −F V_j`, with the factor F of `∇_i W_ij = F (x_i − x_j)` and the volume V_j: so `∇_i W_ij V_j = w r`. An
//! operator is a list of coefficients c_j, to be used as `Σ_j c_j (f_j − f_i)`. Coordinates may be scaled along each
//! axis, if tensors are scaled alike.

mod corrected;
mod gradient;
mod plain;

use crate::kernel::Kernel;

pub use corrected::{CONDITION_LIMIT, condition, corrected};
pub use gradient::{Renormalisation, renormalisation};
pub use plain::plain;

/// A neighbour relative to the particle; beyond the dimension, offsets are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// `r = x_j − x_i` [m]
    pub offset: [f64; 3],
    /// `w = −F V_j ≥ 0` [1/m²]
    pub weight: f64,
    /// Conductivity between the two [W/(m K)]; 1 for a bare second derivative.
    pub conductivity: f64,
}

/// A symmetric tensor; zero beyond the dimension.
pub type Tensor = [[f64; 3]; 3];

impl Neighbour {
    /// A neighbour of volume `volume` under a kernel of support radius `support` [m]; `None` out of
    /// reach, and for the particle itself.
    pub fn new(
        offset: [f64; 3],
        volume: f64,
        (kernel, support, dimension): (Kernel, f64, usize),
    ) -> Option<Self> {
        let distance = square(offset).sqrt();
        let seen = 0.0 < distance && distance < support;
        let weight = || -kernel.gradient_factor(distance, support, dimension) * volume;
        seen.then(|| Self { offset, weight: weight(), conductivity: 1.0 })
    }
}

/// Conductivity between two particles: the harmonic mean `2 k_i k_j/(k_i + k_j)`, which keeps the
/// flux across an interface continuous.
///
/// Source: Cleary & Monaghan (1999), J. Comput. Phys. 148, 227–264, doi 10.1006/jcph.1998.6118.
pub fn conductivity_between(k_i: f64, k_j: f64) -> f64 {
    2.0 * k_i * k_j / (k_i + k_j)
}

fn square(v: [f64; 3]) -> f64 {
    dot(v, v)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn times(matrix: &Tensor, v: [f64; 3]) -> [f64; 3] {
    [dot(matrix[0], v), dot(matrix[1], v), dot(matrix[2], v)]
}

#[cfg(test)]
mod tests;

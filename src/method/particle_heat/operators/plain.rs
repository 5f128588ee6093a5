//! The plain second-order operator, without correction.

use super::{Neighbour, Tensor, dot, square, times};

/// Coefficients of `K : ∇∇f`, `c_j = k w [(d + 2) e·K·e − tr K]`, in d dimensions, with the direction e, the weight w
/// and the conductivity k of a pair, and a tensor K of ratios to k. For K = 1 they are `2 k w`, the operator of Cleary
/// and Monaghan.
///
/// Exact for quadratics in the limit of many neighbours all around; the error remains finite wherever the support is
/// cut. Symmetric in volumes, so that one particle gains what another loses.
///
/// Source: Cleary & Monaghan (1999), J. Comput. Phys. 148, 227–264, doi 10.1006/jcph.1998.6118;
/// Español & Revenga (2003), Phys. Rev. E 67, 026705, doi 10.1103/PhysRevE.67.026705 (tensors).
pub fn plain(neighbours: &[Neighbour], dimension: usize, tensor: &Tensor) -> Vec<f64> {
    let trace: f64 = (0..dimension).map(|a| tensor[a][a]).sum();
    let factor = dimension as f64 + 2.0;
    let coefficient = |n: &Neighbour| {
        let along = dot(n.offset, times(tensor, n.offset)) / square(n.offset);
        n.conductivity * n.weight * (factor * along - trace)
    };
    neighbours.iter().map(coefficient).collect()
}

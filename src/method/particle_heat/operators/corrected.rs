//! The corrected second-order operator, exact for quadratic temperatures.

use super::{Neighbour, Renormalisation, Tensor, dot, renormalisation, square, times};
use crate::math::small_inverse::inverse;

/// Largest κ₁ of the systems for B and L, in coordinates of the order of the distances between particles, for which a
/// correction is used. Full supports have about 3 (2-D and 3-D), faces and corners of lattices and disordered clouds
/// some tens. Beyond this limit neighbours are almost missing in some direction. The coefficients, of both signs, then
/// sum to some hundreds of their value in a full support.
pub const CONDITION_LIMIT: f64 = 1e3;

/// Coefficients of `K : ∇∇f`, exact for every quadratic f on any set of neighbours whose offsets are
/// of order one; `None` where a system is near singular ([`CONDITION_LIMIT`]).
///
/// The operator is `⟨K : ∇∇f⟩ = L : Σ_j k w e⊗e [(f_j − f_i) − r·⟨∇f⟩]` with the renormalised
/// gradient (Park 2.98, 2.101, with 2L written L). For a quadratic with the second derivatives H the
/// bracket is `½ (r⊗r − r·B·A) : H` with `A = Σ w r⊗r⊗r`, so that L must solve
/// `Σ_j w (L : e⊗e) (r⊗r − r·B·A) = 2K` (Park 2.99, 2.100): one equation for each pair of axes.
///
/// Source: Fatehi & Manzari (2011), Comput. Math. Appl. 61, 482–498, doi 10.1016/j.camwa.2010.12.028.
pub fn corrected(neighbours: &[Neighbour], dimension: usize, tensor: &Tensor) -> Option<Vec<f64>> {
    let b = renormalisation(neighbours, dimension).filter(|b| b.condition < CONDITION_LIMIT)?;
    let pairs = pairs(dimension);
    let system = system(neighbours, pairs, &b);
    let found = inverse(&system, pairs.len()).filter(|s| s.condition < CONDITION_LIMIT)?;
    let mut l = [[0.0; 3]; 3];
    for (column, &(s, t)) in pairs.iter().enumerate() {
        let solved = |(row, &(p, q)): (usize, &(usize, usize))| {
            2.0 * found.matrix[column][row] * tensor[p][q]
        };
        l[s][t] = pairs.iter().enumerate().map(solved).sum();
        l[t][s] = l[s][t];
    }
    let shares: Vec<f64> = neighbours
        .iter()
        .map(|n| n.conductivity * n.weight * dot(n.offset, times(&l, n.offset)) / square(n.offset))
        .collect();
    // Subtracted by the gradient: Σ_j share_j r_j · B Σ_m w_m r_m (f_m − f_i), neighbour by neighbour.
    let mut sum = [0.0; 3];
    for (n, share) in neighbours.iter().zip(&shares) {
        (0..3).for_each(|a| sum[a] += share * n.offset[a]);
    }
    let taken = b.derivative(neighbours, sum);
    Some(shares.iter().zip(taken).map(|(share, taken)| share - taken).collect())
}

/// The larger κ₁ of the systems for B and L, on which [`corrected`] depends; infinite if one is singular.
pub fn condition(neighbours: &[Neighbour], dimension: usize) -> f64 {
    let largest = || {
        let b = renormalisation(neighbours, dimension)?;
        let pairs = pairs(dimension);
        let of_l = inverse(&system(neighbours, pairs, &b), pairs.len())?;
        Some(b.condition.max(of_l.condition))
    };
    largest().unwrap_or(f64::INFINITY)
}

/// The system for L: `Σ_j w (L : e⊗e) (r⊗r − r·B·A)`, an equation and an unknown for each pair of axes.
fn system(
    neighbours: &[Neighbour],
    pairs: &[(usize, usize)],
    b: &Renormalisation,
) -> [[f64; 6]; 6] {
    let third = third_moment(neighbours);
    let mut system = [[0.0; 6]; 6];
    for n in neighbours {
        let bent = times(&b.matrix, n.offset);
        let squared = square(n.offset);
        for (row, &(p, q)) in pairs.iter().enumerate() {
            let defect = n.offset[p] * n.offset[q] - dot(bent, [0, 1, 2].map(|a| third[a][p][q]));
            for (column, &(s, t)) in pairs.iter().enumerate() {
                let twice = if s == t { 1.0 } else { 2.0 };
                system[row][column] +=
                    n.weight * twice * n.offset[s] * n.offset[t] / squared * defect;
            }
        }
    }
    system
}

/// Pairs of axes: 1, 3 or 6.
fn pairs(dimension: usize) -> &'static [(usize, usize)] {
    match dimension {
        1 => &[(0, 0)],
        2 => &[(0, 0), (1, 1), (0, 1)],
        _ => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
    }
}

/// `A = Σ w r⊗r⊗r`.
fn third_moment(neighbours: &[Neighbour]) -> [Tensor; 3] {
    let mut sum = [[[0.0; 3]; 3]; 3];
    for n in neighbours {
        let r = n.offset;
        for (a, matrix) in sum.iter_mut().enumerate() {
            for (b, row) in matrix.iter_mut().enumerate() {
                for (c, entry) in row.iter_mut().enumerate() {
                    *entry += n.weight * r[a] * r[b] * r[c];
                }
            }
        }
    }
    sum
}

//! The corrected gradient, exact for linear temperatures.

use super::{Neighbour, Tensor, times};
use crate::math::small_inverse::inverse;

/// `B = [Σ w r⊗r]⁻¹`, which makes the gradient of every linear function exact (Park 2.91).
///
/// Source: Randles & Libersky (1996), Comput. Methods Appl. Mech. Eng. 139, 375–408,
/// doi 10.1016/S0045-7825(96)01090-0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Renormalisation {
    pub matrix: Tensor,
    /// κ₁ of the sum.
    pub condition: f64,
}

/// The renormalisation of a particle; `None` where its neighbours lie in a plane or on a line.
pub fn renormalisation(neighbours: &[Neighbour], dimension: usize) -> Option<Renormalisation> {
    let mut sum = [[0.0; 3]; 3];
    for n in neighbours {
        for (a, row) in sum.iter_mut().enumerate() {
            for (b, entry) in row.iter_mut().enumerate() {
                *entry += n.weight * n.offset[a] * n.offset[b];
            }
        }
    }
    let found = inverse(&sum, dimension)?;
    Some(Renormalisation { matrix: found.matrix, condition: found.condition })
}

impl Renormalisation {
    /// Coefficients `w d·B·r` of the derivative along a vector d: `d·⟨∇f⟩ = Σ_j c_j (f_j − f_i)`
    /// (Park 2.90).
    pub fn derivative(&self, neighbours: &[Neighbour], direction: [f64; 3]) -> Vec<f64> {
        // B is symmetric.
        let along = times(&self.matrix, direction);
        neighbours.iter().map(|n| n.weight * super::dot(along, n.offset)).collect()
    }
}

//! Dilatations that points share, and their pressure.
//!
//! The dilatation J̄ of a point is the projection of those of its group on functions that are orthonormal over it,
//! `J̄_p = Σ_k φ_k(p) Σ_q V_q φ_k(q) J_q`: a mean, or one that is linear over the group. The energy `Σ V U(J̄)` has the
//! stress `p ∂J/∂F` with the projection p of `U′(J̄)`, and `dp_q = Σ_kl φ_k(q) D_kl Σ_r V_r φ_l(r) dJ_r` with `D_kl = Σ
//! V U″(J̄) φ_k φ_l` (J. C. Simo, R. L. Taylor & K. S. Pister 1985, doi 10.1016/0045-7825(85)90033-7).

use super::Deformable;
use super::tangent::Swelling;
use crate::laws::solid::large_strain::{Deformed, LargeStrainLaw};
use crate::math::matrix3::Matrix3;
use crate::space::{Shared, Sharing};

/// Pressure of the dilatation at the points of a group, and U″ there [Pa].
pub struct Pressure {
    value: Shared,
    slope: Shared,
}

impl Pressure {
    /// The pressure at a point, by its place in the group.
    pub fn at(&self, place: usize) -> f64 {
        self.value.at(place)
    }
}

impl Deformable {
    /// The dilatation that the points of a group share.
    pub fn shared_dilatation(&self, group: usize, deformed: &[Deformed]) -> Shared {
        self.projected(group, |place| deformed[place].dilatation)
    }

    fn projected(&self, group: usize, value: impl Fn(usize) -> f64) -> Shared {
        let points = &self.space.groups[group];
        let weights = &self.space.volume.weights[points.clone()];
        self.space.sharing.project(points, weights, value)
    }

    /// The pressure of the dilatation of a group.
    pub fn pressure(&self, group: usize, law: &LargeStrainLaw, shared: &Shared) -> Pressure {
        let value = shared.map(|j| law.pressure(j)[0]);
        let slope = shared.map(|j| law.pressure(j)[1]);
        let value = match value {
            Shared::One(_) => value,
            Shared::Each(values) => self.projected(group, |place| values[place]),
        };
        Pressure { value, slope }
    }

    /// The energy of the dilatation of a group, some times [J].
    pub fn energy_of_dilatation(
        &self,
        group: usize,
        law: &LargeStrainLaw,
        (scale, shared): (f64, &Shared),
    ) -> f64 {
        let weights = &self.space.volume.weights[self.space.groups[group].clone()];
        match shared {
            Shared::One(j) => scale * weights.iter().sum::<f64>() * law.energy_of_dilatation(*j),
            Shared::Each(all) => {
                let each = weights.iter().zip(all);
                scale * each.map(|(w, j)| w * law.energy_of_dilatation(*j)).sum::<f64>()
            }
        }
    }

    /// Stiffness of a pressure, a part of it, with the forces A and the changes B of the dilatation of each point.
    pub fn swellings(
        &self,
        group: usize,
        (pressure, part): (&Pressure, f64),
        forces: Vec<Matrix3>,
        changes: Vec<Matrix3>,
    ) -> Vec<Swelling> {
        let points = self.space.groups[group].clone();
        let weights = &self.space.volume.weights[points.clone()];
        let functions = match &self.space.sharing {
            Sharing::Mean => {
                let stiffness = part * pressure.slope.at(0) / weights.iter().sum::<f64>();
                return vec![Swelling { stiffness, forces, changes }];
            }
            Sharing::Linear(functions) => &functions[points],
        };
        let mut slopes = [[0.0; 4]; 4];
        for (place, (own, weight)) in functions.iter().zip(weights).enumerate() {
            let scale = weight * pressure.slope.at(place);
            for (k, row) in slopes.iter_mut().enumerate() {
                row.iter_mut().zip(own).for_each(|(sum, value)| *sum += scale * own[k] * value);
            }
        }
        let used = 1 + self.space.form.axes().len();
        // D = L Lᵀ: each column of L makes one term.
        let lower = cholesky(&slopes, used);
        let term = |column: usize| {
            let along = |own: &[f64; 4]| (0..used).map(|k| lower[k][column] * own[k]).sum::<f64>();
            let times = |all: &[Matrix3]| {
                let of_point = |(own, at): (&[f64; 4], &Matrix3)| {
                    let factor = along(own);
                    at.map(|row| row.map(|value| factor * value))
                };
                functions.iter().zip(all).map(of_point).collect()
            };
            Swelling { stiffness: part, forces: times(&forces), changes: times(&changes) }
        };
        (0..used).map(term).collect()
    }
}

/// The lower factor of the first rows and columns of a positive definite matrix.
fn cholesky(matrix: &[[f64; 4]; 4], size: usize) -> [[f64; 4]; 4] {
    let mut lower = [[0.0; 4]; 4];
    for column in 0..size {
        for row in column..size {
            let known = (0..column).map(|k| lower[row][k] * lower[column][k]).sum::<f64>();
            let rest = matrix[row][column] - known;
            lower[row][column] =
                if row == column { rest.sqrt() } else { rest / lower[column][column] };
        }
    }
    lower
}

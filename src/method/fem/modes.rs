//! Eigenmodes of heat conduction along one axis.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltParams, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Auto, Mat, Par};

use crate::math::eigenvectors::eigenvectors;
use crate::method::mesh::Axis;

/// Condition at an end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EndCondition {
    /// Insulated, or under a flux that does not depend on the temperature.
    Natural,
    /// Prescribed temperature.
    Prescribed,
    /// Convective: heat transfer coefficient over conductivity, `h/k` [1/m].
    Convective(f64),
}

/// Mass-orthonormal modes `(K + h/k e eᵀ) φ = μ M φ` of one axis.
#[derive(Debug, Clone)]
pub struct AxisModes {
    /// Eigenvalues μ [1/m²], ascending.
    pub decay: Vec<f64>,
    /// Modes by columns, at all nodes; zero at nodes of prescribed temperature.
    pub shapes: Mat<f64>,
    /// Mass matrix of the axis.
    pub mass: Mat<f64>,
    /// Stiffness matrix of the axis, convective ends included.
    pub stiffness: Mat<f64>,
}

impl AxisModes {
    /// Solves the eigenproblem of an axis with conditions at its low and high end.
    pub fn of(axis: &Axis, ends: [EndCondition; 2]) -> Self {
        let n = axis.len();
        let mass = axis.mass();
        let mut stiffness = axis.stiffness();
        for (end, node) in ends.iter().zip([0, n - 1]) {
            if let EndCondition::Convective(ratio) = end {
                // The weight of a radial axis makes the end a circle.
                stiffness[(node, node)] += ratio * axis.weight_at(axis.nodes[node]);
            }
        }
        let prescribed = ends.map(|end| end == EndCondition::Prescribed);
        let free: Vec<usize> =
            (0..n).filter(|&i| !(i == 0 && prescribed[0] || i + 1 == n && prescribed[1])).collect();
        let loses_nothing = |end: &EndCondition| {
            matches!(end, EndCondition::Natural | EndCondition::Convective(0.0))
        };
        let insulated = ends.iter().all(loses_nothing);
        let (decay, shapes) = eigenpairs(axis, &ends, &mass, &stiffness, &free, insulated);
        Self { decay, shapes, mass, stiffness }
    }

    pub fn count(&self) -> usize {
        self.decay.len()
    }

    /// Coefficients `φᵀ v` of a nodal vector.
    pub fn project(&self, v: &[f64]) -> Vec<f64> {
        (0..self.count()).map(|k| (0..v.len()).map(|i| self.shapes[(i, k)] * v[i]).sum()).collect()
    }

    /// Values of all modes at a node.
    pub fn at_node(&self, node: usize) -> Vec<f64> {
        (0..self.count()).map(|k| self.shapes[(node, k)]).collect()
    }
}

fn eigenpairs(
    axis: &Axis,
    ends: &[EndCondition; 2],
    mass: &Mat<f64>,
    stiffness: &Mat<f64>,
    free: &[usize],
    insulated: bool,
) -> (Vec<f64>, Mat<f64>) {
    let m = free.len();
    let restricted = |full: &Mat<f64>| Mat::from_fn(m, m, |i, j| full[(free[i], free[j])]);
    let (mass, stiffness) = (restricted(mass), restricted(stiffness));
    // M = L Lᵀ turns the pencil into the symmetric matrix L⁻¹ K L⁻ᵀ.
    let lower = cholesky_factor(mass);
    let mut symmetric = stiffness;
    solve_lower_triangular_in_place(lower.as_ref(), symmetric.as_mut(), Par::Seq);
    let mut symmetric = symmetric.transpose().to_owned();
    solve_lower_triangular_in_place(lower.as_ref(), symmetric.as_mut(), Par::Seq);
    let mut vectors = eigenvectors(&symmetric);
    if insulated {
        deflate_constant(&mut vectors, &lower, m);
    }
    solve_upper_triangular_in_place(lower.transpose(), vectors.as_mut(), Par::Seq);

    let mut shapes = Mat::zeros(axis.len(), m);
    for (i, &node) in free.iter().enumerate() {
        for k in 0..m {
            shapes[(node, k)] = vectors[(i, k)];
        }
    }
    let mut decay: Vec<f64> = (0..m).map(|k| rayleigh_quotient(axis, ends, &shapes, k)).collect();
    if insulated {
        // Rounding of the constant mode would lose all heat in steps of 1e30 s.
        decay[0] = 0.0;
    }
    (decay, shapes)
}

/// Returns the lower triangle L of M = L Lᵀ.
///
/// Like all of this file it works on the calling thread, whatever number of threads a scene allows.
pub(super) fn cholesky_factor(mut mass: Mat<f64>) -> Mat<f64> {
    let m = mass.nrows();
    let parameters: LltParams = Auto::<f64>::auto();
    let scratch = cholesky_in_place_scratch::<f64>(m, Par::Seq, parameters.into());
    cholesky_in_place(
        mass.as_mut(),
        LltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        parameters.into(),
    )
    .expect("a mass matrix is positive definite");
    Mat::from_fn(m, m, |i, j| if i < j { 0.0 } else { mass[(i, j)] })
}

/// Makes the first mode of an insulated axis constant, to rounding, and the others orthogonal to it. Conduction then
/// conserves heat however long a run is.
pub(super) fn deflate_constant(vectors: &mut Mat<f64>, lower: &Mat<f64>, m: usize) {
    let mut constant: Vec<f64> = (0..m).map(|i| (i..m).map(|j| lower[(j, i)]).sum()).collect();
    let norm = constant.iter().map(|v| v * v).sum::<f64>().sqrt();
    constant.iter_mut().for_each(|v| *v /= norm);
    for i in 0..m {
        vectors[(i, 0)] = constant[i];
    }
    for k in 1..m {
        let overlap: f64 = (0..m).map(|i| constant[i] * vectors[(i, k)]).sum();
        for i in 0..m {
            vectors[(i, k)] -= overlap * constant[i];
        }
    }
}

/// Returns `μ = ∫ (φ')² w dx + h/k φ(end)²` of a mass-normal mode. Its error is quadratic in that of the mode, and slow
/// modes are unaffected by the rounding of fast ones.
fn rayleigh_quotient(axis: &Axis, ends: &[EndCondition; 2], shapes: &Mat<f64>, k: usize) -> f64 {
    let mut sum = 0.0;
    for element in 0..axis.elements() {
        let [a, b] = axis.bounds(element);
        for (x, w) in crate::math::gauss::gauss_on(axis.order + 1, a, b) {
            let at = axis.shape_in(element, x);
            // Differences to the first node vanish exactly for a constant.
            let base = shapes[(at.first, k)];
            let slope: f64 =
                (1..at.count).map(|i| at.slopes[i] * (shapes[(at.first + i, k)] - base)).sum();
            sum += w * axis.weight_at(x) * slope * slope;
        }
    }
    for (end, node) in ends.iter().zip([0, axis.len() - 1]) {
        if let EndCondition::Convective(ratio) = end {
            sum += ratio * axis.weight_at(axis.nodes[node]) * shapes[(node, k)].powi(2);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::Weight;
    use std::f64::consts::PI;

    fn line(elements: usize, order: usize) -> Axis {
        let ends: Vec<f64> = (0..=elements).map(|i| i as f64 / elements as f64).collect();
        Axis::from_element_ends(&ends, order, Weight::Uniform)
    }

    #[test]
    fn decay_of_the_first_modes_converges_to_the_exact_spectrum() {
        let prescribed = [EndCondition::Prescribed; 2];
        for (order, rate) in [(1, 2.0), (2, 4.0)] {
            let error = |n: usize| {
                AxisModes::of(&line(n, order), prescribed).decay[1] / (4.0 * PI * PI) - 1.0
            };
            let observed = (error(10) / error(20)).log2();
            assert!((observed - rate).abs() < 0.1, "order {order}: rate {observed}");
        }
    }

    #[test]
    fn insulated_axis_has_a_constant_mode() {
        let modes = AxisModes::of(&line(40, 2), [EndCondition::Natural; 2]);
        assert_eq!(modes.decay[0], 0.0);
        assert!(modes.decay[1] > 9.0);
    }

    #[test]
    fn convective_end_satisfies_the_transcendental_equation() {
        // φ' = −B φ at x = 1 and φ' = 0 at 0: b tan b = B, decay b².
        let modes =
            AxisModes::of(&line(40, 2), [EndCondition::Natural, EndCondition::Convective(2.0)]);
        let b = modes.decay[0].sqrt();
        assert!((b * b.tan() - 2.0).abs() < 1e-6, "{}", b * b.tan());
    }

    #[test]
    fn modes_diagonalise_both_matrices_to_rounding_on_meshes_of_any_size() {
        for (elements, order) in [(12, 2), (160, 1), (100, 2)] {
            let ends = [EndCondition::Natural, EndCondition::Prescribed];
            let modes = AxisModes::of(&line(elements, order), ends);
            let mass = modes.shapes.transpose() * &modes.mass * &modes.shapes;
            let stiffness = modes.shapes.transpose() * &modes.stiffness * &modes.shapes;
            let fastest = modes.decay[modes.count() - 1];
            for i in 0..modes.count() {
                for j in 0..modes.count() {
                    let same = if i == j { 1.0 } else { 0.0 };
                    assert!((mass[(i, j)] - same).abs() < 1e-13, "{elements} {order}");
                    let off = (stiffness[(i, j)] - same * modes.decay[i]).abs();
                    assert!(off < 1e-13 * fastest, "{elements} elements, order {order}: {off:e}");
                }
            }
        }
    }
}

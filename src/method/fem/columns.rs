//! Modes of heat along z through layers that conduct and store it differently.
//!
//! For a mode along the surface, of eigenvalue Λ = λ_x + λ_y, the heat equation reduces to
//! `M(c) θ̇ + [K(k) + Λ M(k)] θ = f` along z, with the mass matrices M of c = ρc(z) and k(z) and the stiffness
//! matrix K, which holds the conductances 1/R of contacts between the two nodes of an interface, and heat transfer
//! at the ends. Each Λ has an eigenproblem of its own.

use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, Par};

use super::modes::{EndCondition, cholesky_factor, deflate_constant};
use crate::laws::Constants;
use crate::math::eigenvectors::eigenvectors;
use crate::math::gauss::gauss_on;
use crate::method::mesh::Mesh;

/// Contact resistance over that of the thinner adjacent layer below which the contact is perfect: the relative
/// temperature jump is no larger.
const PERFECT: f64 = 1e-9;
/// Ratio of eigenvalues from which on modes are orthogonalised more accurately than matrices resolve.
const WIDE: f64 = 1e4;
/// Cosine of the angle between gradients of modes that counts as orthogonal, and largest number of sweeps.
const ORTHOGONAL: f64 = 1e-13;
const SWEEPS: usize = 8;

/// The heat problem along z, for any mode along the surface.
pub struct DepthProblem {
    /// Unknown of each node; nodes of a perfect contact share one, prescribed ones have none.
    unknowns: Vec<Option<usize>>,
    count: usize,
    /// `M(c)` and `M(k)` between nodes.
    pub capacity: Mat<f64>,
    pub conductance: Mat<f64>,
    /// `K(k) = Σ r rᵀ` and `M(k) = Σ r rᵀ`.
    slopes: Vec<Row>,
    values: Vec<Row>,
    /// L of `M(c) = L Lᵀ` between unknowns; `L⁻¹ K L⁻ᵀ` and `L⁻¹ M(k) L⁻ᵀ`.
    lower: Mat<f64>,
    stiffness: Mat<f64>,
    spread: Mat<f64>,
    /// True if no end is prescribed or convective.
    insulated: bool,
}

/// Modes along z for one Λ.
#[derive(Debug, Clone)]
pub struct Column {
    /// Eigenvalues [1/s].
    pub decay: Vec<f64>,
    /// Modes by columns, at all nodes, with `φᵀ M(c) φ = 1`.
    pub shapes: Mat<f64>,
}

/// A sum over up to three nodes, of values or of their differences to the first.
#[derive(Debug, Clone, Copy)]
struct Row {
    first: usize,
    count: usize,
    weights: [f64; 3],
    differences: bool,
}

impl Row {
    fn of(&self, value: impl Fn(usize) -> f64) -> f64 {
        let base = if self.differences { value(self.first) } else { 0.0 };
        let own = usize::from(self.differences)..self.count;
        own.map(|i| self.weights[i] * (value(self.first + i) - base)).sum()
    }

    /// The weights of the nodes.
    fn entries(&self) -> [f64; 3] {
        let mut entries = self.weights;
        if self.differences {
            entries[0] = -entries[1..self.count].iter().sum::<f64>();
        }
        entries
    }
}

impl DepthProblem {
    /// `constants` of the layers from the lowest on, conditions at the bottom and the top, where convective ones
    /// hold the heat transfer coefficient itself [W/(m² K)].
    pub fn new(mesh: &Mesh, constants: &[Constants], ends: [EndCondition; 2]) -> Self {
        let nodes = mesh.sided_counts()[2];
        let mut slopes = Vec::new();
        let mut values = Vec::new();
        let mut capacity = Mat::zeros(nodes, nodes);
        let axis = &mesh.axes[2];
        for element in 0..axis.elements() {
            let [a, b] = axis.bounds(element);
            let layer = &constants[mesh.layering.layer_of(element)];
            for (z, w) in gauss_on(axis.order + 1, a, b) {
                let at = mesh.sided_shape_in(element, z);
                let row = |weights: [f64; 3], factor: f64, differences| Row {
                    first: at.first,
                    count: at.count,
                    weights: weights.map(|weight| factor * weight),
                    differences,
                };
                let root = (w * layer.conductivity).sqrt();
                slopes.push(row(at.slopes, root, true));
                values.push(row(at.values, root, false));
                let root = (w * layer.heat_capacity()).sqrt();
                add_square(&mut capacity, &row(at.values, root, false));
            }
        }
        let contacts: Vec<_> =
            (1..constants.len()).map(|layer| contact(mesh, constants, layer - 1)).collect();
        let (unknowns, count) = numbered(mesh, ends, &contacts);
        let mut first = 0;
        for (layer, contact) in contacts.into_iter().enumerate() {
            first += mesh.layer_axis(layer).len();
            if let Some(conductance) = contact {
                let weights = [0.0, conductance.sqrt(), 0.0];
                slopes.push(Row { first: first - 1, count: 2, weights, differences: true });
            }
        }
        for (end, node) in ends.into_iter().zip([0, nodes - 1]) {
            if let EndCondition::Convective(coefficient) = end {
                let weights = [coefficient.sqrt(), 0.0, 0.0];
                slopes.push(Row { first: node, count: 1, weights, differences: false });
            }
        }
        let insulated = ends == [EndCondition::Natural; 2];
        let conductance = gram(&values, nodes);
        let stiffness = gram(&slopes, nodes);
        let restricted = |full: &Mat<f64>| restricted(full, &unknowns, count);
        let lower = cholesky_factor(restricted(&capacity));
        let reduced = |full: &Mat<f64>| {
            let mut part = restricted(full);
            solve_lower_triangular_in_place(lower.as_ref(), part.as_mut(), Par::Seq);
            let mut part = part.transpose().to_owned();
            solve_lower_triangular_in_place(lower.as_ref(), part.as_mut(), Par::Seq);
            part
        };
        let (stiffness, spread) = (reduced(&stiffness), reduced(&conductance));
        Self {
            unknowns,
            count,
            capacity,
            conductance,
            slopes,
            values,
            lower,
            stiffness,
            spread,
            insulated,
        }
    }

    /// Number of nodes, with those on interfaces counted twice.
    pub fn nodes(&self) -> usize {
        self.unknowns.len()
    }

    /// Number of modes of each column.
    pub fn count(&self) -> usize {
        self.count
    }

    /// `K v` of nodal values.
    pub fn stiffness_times(&self, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; v.len()];
        for row in &self.slopes {
            let value = row.of(|node| v[node]);
            let entries = row.entries();
            for (target, weight) in out[row.first..].iter_mut().zip(&entries[..row.count]) {
                *target += weight * value;
            }
        }
        out
    }

    /// Computes the modes of an eigenvalue Λ [1/m²] along the surface; `uniform` is set for the uniform field along it.
    pub fn column(&self, along: f64, uniform: bool) -> Column {
        let m = self.count;
        let symmetric =
            Mat::from_fn(m, m, |i, j| self.stiffness[(i, j)] + along * self.spread[(i, j)]);
        let mut vectors = eigenvectors(&symmetric);
        let keeps_all = self.insulated && uniform;
        if keeps_all {
            deflate_constant(&mut vectors, &self.lower, m);
        }
        solve_upper_triangular_in_place(self.lower.transpose(), vectors.as_mut(), Par::Seq);
        let at = |node: usize, k: usize| self.unknowns[node].map_or(0.0, |i| vectors[(i, k)]);
        let mut shapes = Mat::from_fn(self.nodes(), m, at);
        if keeps_all {
            // Bitwise equal, so that its gradient is zero.
            let mean = shapes[(0, 0)];
            (0..self.nodes()).for_each(|node| shapes[(node, 0)] = mean);
        }
        let mut gradients: Vec<Vec<f64>> =
            (0..m).map(|k| self.gradient(&shapes, k, along)).collect();
        let squares =
            |gradients: &[Vec<f64>]| gradients.iter().map(|g| dot(g, g)).collect::<Vec<_>>();
        let decay = squares(&gradients);
        let slowest = decay.iter().copied().filter(|&d| d > 0.0).fold(f64::INFINITY, f64::min);
        if decay.iter().any(|&d| d > WIDE * slowest) {
            orthogonalise(&mut gradients, &mut shapes);
        }
        Column { decay: squares(&gradients), shapes }
    }

    /// Vector whose squared norm is the energy of a mode.
    fn gradient(&self, shapes: &Mat<f64>, k: usize, along: f64) -> Vec<f64> {
        let root = along.max(0.0).sqrt();
        let slopes = self.slopes.iter().map(|row| row.of(|node| shapes[(node, k)]));
        let values = self.values.iter().map(|row| root * row.of(|node| shapes[(node, k)]));
        slopes.chain(values).collect()
    }
}

/// Returns the unknown of each node, and their number: nodes of a perfect contact share one, prescribed nodes have
/// none.
fn numbered(
    mesh: &Mesh,
    ends: [EndCondition; 2],
    contacts: &[Option<f64>],
) -> (Vec<Option<usize>>, usize) {
    let nodes = mesh.sided_counts()[2];
    let mut unknowns = Vec::with_capacity(nodes);
    let mut count = 0;
    for layer in 0..mesh.layering.count() {
        for node in 0..mesh.layer_axis(layer).len() {
            let tied = node == 0 && layer > 0 && contacts[layer - 1].is_none();
            let place = unknowns.len();
            let end = [place == 0, place + 1 == nodes];
            let held = (0..2).any(|i| end[i] && ends[i] == EndCondition::Prescribed);
            let own = if tied { unknowns[place - 1] } else { (!held).then_some(count) };
            count += usize::from(!tied && !held);
            unknowns.push(own);
        }
    }
    (unknowns, count)
}

/// Conductance of the contact above a layer [W/(m² K)]; `None` if it is perfect.
fn contact(mesh: &Mesh, constants: &[Constants], below: usize) -> Option<f64> {
    let resistance = mesh.layering.resistance_above(below);
    let own = |layer: usize| {
        let axis = mesh.layer_axis(layer);
        (axis.end() - axis.start()) / constants[layer].conductivity
    };
    (resistance > PERFECT * own(below).min(own(below + 1))).then(|| resistance.recip())
}

/// Rotates pairs of modes until the gradients of all are orthogonal, by one-sided rotations (M. R. Hestenes 1958, doi
/// 10.1137/0106005). Slow modes then have the digits that eigenvectors of a matrix with much faster modes lack (J.
/// Demmel and K. Veselić 1992, doi 10.1137/0613074).
fn orthogonalise(gradients: &mut [Vec<f64>], shapes: &mut Mat<f64>) {
    for _ in 0..SWEEPS {
        let mut turned = false;
        for q in 1..gradients.len() {
            for p in 0..q {
                let (before, after) = gradients.split_at_mut(q);
                let (a, b) = (&mut before[p], &mut after[0]);
                let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
                // The zero vector is orthogonal to all.
                if ab.abs() <= ORTHOGONAL * (aa * bb).sqrt() {
                    continue;
                }
                turned = true;
                let zeta = (bb - aa) / (2.0 * ab);
                let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
                let cosine = tangent.hypot(1.0).recip();
                let sine = cosine * tangent;
                let turn = |x: &mut f64, y: &mut f64| {
                    (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
                };
                a.iter_mut().zip(b.iter_mut()).for_each(|(x, y)| turn(x, y));
                for node in 0..shapes.nrows() {
                    let (mut x, mut y) = (shapes[(node, p)], shapes[(node, q)]);
                    turn(&mut x, &mut y);
                    (shapes[(node, p)], shapes[(node, q)]) = (x, y);
                }
            }
        }
        if !turned {
            return;
        }
    }
}

fn gram(rows: &[Row], nodes: usize) -> Mat<f64> {
    let mut out = Mat::zeros(nodes, nodes);
    rows.iter().for_each(|row| add_square(&mut out, row));
    out
}

fn add_square(out: &mut Mat<f64>, row: &Row) {
    let entries = row.entries();
    for i in 0..row.count {
        for j in 0..row.count {
            out[(row.first + i, row.first + j)] += entries[i] * entries[j];
        }
    }
}

/// Restricts a matrix to the unknowns.
fn restricted(full: &Mat<f64>, unknowns: &[Option<usize>], count: usize) -> Mat<f64> {
    let mut out = Mat::zeros(count, count);
    for (i, row) in unknowns.iter().enumerate() {
        for (j, column) in unknowns.iter().enumerate() {
            if let (Some(row), Some(column)) = (row, column) {
                out[(*row, *column)] += full[(i, j)];
            }
        }
    }
    out
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    crate::math::separable::dot(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::Geometry;
    use crate::method::mesh::Layering;
    use crate::method::mesh::{Axis, Weight};

    fn constants(conductivity: f64, heat_capacity: f64) -> Constants {
        Constants {
            density: heat_capacity,
            specific_heat: 1.0,
            conductivity,
            young: None,
            poisson: None,
            expansion: None,
        }
    }

    /// Ten elements below five much thinner ones.
    fn mesh(order: usize, resistance: f64) -> Mesh {
        let mut ends: Vec<f64> = (0..=10).map(|i| 0.1 * f64::from(i)).collect();
        ends.extend((1..=5).map(|i| 1.0 + 1e-4 * f64::from(i)));
        let height = Axis::from_element_ends(&ends, order, Weight::Uniform);
        Mesh {
            axes: [height.clone(), Axis::point(), height],
            mirrored: [false; 2],
            geometry: Geometry::Box,
            layering: Layering::new(vec![10], vec![resistance]),
        }
    }

    #[test]
    fn modes_diagonalise_all_matrices_and_slow_ones_to_more_digits_than_the_fastest_leave() {
        let layers = [constants(2e3, 2.0), constants(0.2, 3.0)];
        for order in [1, 2] {
            for resistance in [0.0, 1e-3, 10.0] {
                for ends in [
                    [EndCondition::Natural; 2],
                    [EndCondition::Prescribed, EndCondition::Convective(5.0)],
                ] {
                    let depth = DepthProblem::new(&mesh(order, resistance), &layers, ends);
                    for along in [0.0, 3.0, 1e5] {
                        let column = depth.column(along, along == 0.0);
                        let [mass, spread] = [&depth.capacity, &depth.conductance]
                            .map(|m| column.shapes.transpose() * m * &column.shapes);
                        for i in 0..depth.count() {
                            let shape: Vec<f64> =
                                (0..depth.nodes()).map(|n| column.shapes[(n, i)]).collect();
                            let stress = depth.stiffness_times(&shape);
                            for j in 0..depth.count() {
                                let same = if i == j { 1.0 } else { 0.0 };
                                assert!((mass[(i, j)] - same).abs() < 1e-11);
                                let other =
                                    (0..depth.nodes()).map(|n| column.shapes[(n, j)] * stress[n]);
                                let energy = other.sum::<f64>() + along * spread[(i, j)];
                                let scale = (column.decay[i] * column.decay[j]).sqrt();
                                let off = (energy - same * column.decay[i]).abs();
                                let most =
                                    1e-9 * scale + 1e-13 * column.decay[depth.count() - 1].max(1.0);
                                assert!(
                                    off < most,
                                    "{order} {resistance} {along} {i} {j}: {off:e} {scale:e}"
                                );
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn insulated_columns_conserve_heat() {
        let layers = [constants(2e3, 2.0), constants(0.2, 3.0)];
        let depth = DepthProblem::new(&mesh(2, 1e-3), &layers, [EndCondition::Natural; 2]);
        let column = depth.column(0.0, true);
        assert_eq!(column.decay[0], 0.0);
        assert!(column.decay[1..].iter().all(|&decay| decay > 1e-3));
    }
}

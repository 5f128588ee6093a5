//! Brick elements with edges along the axes: Lagrange shape functions of order 1 or 2.
//!
//! On a brick every integral of products of shape functions and their derivatives is a product of
//! integrals along the edges. The linear element carries the enhanced assumed strains of J. C. Simo
//! and M. S. Rifai 1990 (doi 10.1002/nme.1620290802) with the 15 modes that U. Andelfinger and
//! E. Ramm 1993 (doi 10.1002/nme.1620360805) found to remove both shear and volumetric locking:
//! the linear one of each normal strain, the bilinear ones of the normal strains, and the linear
//! ones of the shear strains. The modes are condensed inside the element. The quadratic element
//! projects its dilatation (see [`super::dilatation`]).

use nalgebra::SMatrix;

use super::dilatation::{DilatationProjection, POLYNOMIALS};
use crate::laws::Thermoelastic;
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::{shape, slope};

/// Integrals along an edge of length h between shape functions a and b.
struct Edge {
    /// `∫ N_a N_b dx`
    mass: [[f64; 3]; 3],
    /// `∫ N_a' N_b' dx`
    stiffness: [[f64; 3]; 3],
    /// `∫ N_a' N_b dx`
    mixed: [[f64; 3]; 3],
}

impl Edge {
    fn new(order: usize, length: f64) -> Self {
        let zero = [[0.0; 3]; 3];
        let mut edge = Self { mass: zero, stiffness: zero, mixed: zero };
        for (xi, w) in gauss_legendre(order + 1) {
            let (n, d) = (shape(order, xi), slope(order, xi));
            for a in 0..=order {
                for b in 0..=order {
                    edge.mass[a][b] += w * n[a] * n[b] * length / 2.0;
                    edge.stiffness[a][b] += w * d[a] * d[b] * 2.0 / length;
                    edge.mixed[a][b] += w * d[a] * n[b];
                }
            }
        }
        edge
    }
}

/// Matrices of one element. Nodes run x fastest; each node has the displacements x, y, z.
pub struct HexahedronMatrices {
    nodes: usize,
    /// `nodes² ` blocks of 3 × 3, by rows.
    stiffness: Vec<[f64; 9]>,
    /// `nodes²` columns of 3: force at the first node per degree at the second.
    thermal: Vec<[f64; 3]>,
}

impl HexahedronMatrices {
    pub fn new(order: usize, size: [f64; 3], law: &Thermoelastic) -> Self {
        let edges = size.map(|length| Edge::new(order, length));
        let n = order + 1;
        let nodes = n * n * n;
        // The quadratic element takes its volume stress from the projection alone.
        let (lambda, thermal_modulus) = match order {
            1 => (law.lame_first(), law.thermal_modulus()),
            _ => (0.0, 2.0 * law.shear_modulus() * law.expansion),
        };
        let mut stiffness = Vec::with_capacity(nodes * nodes);
        let mut thermal = Vec::with_capacity(nodes * nodes);
        for a in 0..nodes {
            for b in 0..nodes {
                let (a, b) = (split(a, n), split(b, n));
                stiffness.push(stiffness_block(&edges, a, b, lambda, law.shear_modulus()));
                thermal.push(thermal_block(&edges, a, b, thermal_modulus));
            }
        }
        let mut element = Self { nodes, stiffness, thermal };
        match order {
            1 => element.enhance(size, law),
            _ => element.add_dilatation(&DilatationProjection::new(order, size), law),
        }
        element
    }

    /// Force at node `a` along i per displacement of node `b` along j at `3 i + j` [N/m].
    pub fn stiffness(&self, a: usize, b: usize) -> &[f64; 9] {
        &self.stiffness[a * self.nodes + b]
    }

    /// Thermal force at node `a` per degree at node `b` [N/K].
    pub fn thermal(&self, a: usize, b: usize) -> &[f64; 3] {
        &self.thermal[a * self.nodes + b]
    }

    /// Adds `λ ∫ P(tr ε − 3 α ΔT) P(δ tr ε) dV` with the projection P.
    fn add_dilatation(&mut self, projection: &DilatationProjection, law: &Thermoelastic) {
        let lambda = law.lame_first();
        let overlap = |a: &[f64; POLYNOMIALS], b: &[f64; POLYNOMIALS]| -> f64 {
            (0..POLYNOMIALS).map(|m| a[m] * b[m] / projection.norm[m]).sum()
        };
        for a in 0..self.nodes {
            for b in 0..self.nodes {
                for i in 0..3 {
                    let from = &projection.gradient[a][i];
                    for j in 0..3 {
                        self.stiffness[a * self.nodes + b][3 * i + j] +=
                            lambda * overlap(from, &projection.gradient[b][j]);
                    }
                    self.thermal[a * self.nodes + b][i] +=
                        3.0 * law.expansion * lambda * overlap(from, &projection.value[b]);
                }
            }
        }
    }

    /// Condenses the enhanced strain modes of the linear element.
    fn enhance(&mut self, size: [f64; 3], law: &Thermoelastic) {
        let modes = EnhancedModes::new(size, law);
        let reduced = modes.inverse * modes.displacement;
        let stiffness = modes.displacement.transpose() * reduced;
        let thermal = modes.displacement.transpose() * (modes.inverse * modes.thermal);
        for a in 0..8 {
            for b in 0..8 {
                for i in 0..3 {
                    self.thermal[8 * a + b][i] -= thermal[(3 * a + i, b)];
                    for j in 0..3 {
                        self.stiffness[8 * a + b][3 * i + j] -= stiffness[(3 * a + i, 3 * b + j)];
                    }
                }
            }
        }
    }
}

/// Position of a local node along the three edges.
fn split(node: usize, n: usize) -> [usize; 3] {
    [node % n, node / n % n, node / (n * n)]
}

/// `∫ ∂_i N_a ∂_j N_b dV`.
fn derivative_product(edges: &[Edge; 3], a: [usize; 3], b: [usize; 3], i: usize, j: usize) -> f64 {
    (0..3)
        .map(|k| match (k == i, k == j) {
            (true, true) => edges[k].stiffness[a[k]][b[k]],
            (true, false) => edges[k].mixed[a[k]][b[k]],
            (false, true) => edges[k].mixed[b[k]][a[k]],
            (false, false) => edges[k].mass[a[k]][b[k]],
        })
        .product()
}

/// `λ ∫∂_i N_a ∂_j N_b + G ∫∂_j N_a ∂_i N_b + δ_ij G ∫∇N_a·∇N_b`.
fn stiffness_block(
    edges: &[Edge; 3],
    a: [usize; 3],
    b: [usize; 3],
    lambda: f64,
    shear: f64,
) -> [f64; 9] {
    let mut g = [[0.0; 3]; 3];
    for (i, row) in g.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = derivative_product(edges, a, b, i, j);
        }
    }
    let trace = g[0][0] + g[1][1] + g[2][2];
    let mut block = [0.0; 9];
    for i in 0..3 {
        for j in 0..3 {
            block[3 * i + j] = lambda * g[i][j] + shear * g[j][i];
        }
        block[4 * i] += shear * trace;
    }
    block
}

/// `β ∫ ∂_i N_a N_b dV`.
fn thermal_block(
    edges: &[Edge; 3],
    a: [usize; 3],
    b: [usize; 3],
    thermal_modulus: f64,
) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        thermal_modulus
            * (0..3)
                .map(|k| {
                    let edge = &edges[k];
                    if k == i { edge.mixed[a[k]][b[k]] } else { edge.mass[a[k]][b[k]] }
                })
                .product::<f64>()
    })
}

const MODES: usize = 15;

/// Strain component (xx, yy, zz, xy, yz, xz) and local polynomial.
pub type Mode = (usize, fn([f64; 3]) -> f64);

/// The enhanced modes.
pub const ENHANCED: [Mode; MODES] = [
    (0, |p| p[0]),
    (0, |p| p[0] * p[1]),
    (0, |p| p[0] * p[2]),
    (1, |p| p[1]),
    (1, |p| p[0] * p[1]),
    (1, |p| p[1] * p[2]),
    (2, |p| p[2]),
    (2, |p| p[0] * p[2]),
    (2, |p| p[1] * p[2]),
    (3, |p| p[0]),
    (3, |p| p[1]),
    (4, |p| p[1]),
    (4, |p| p[2]),
    (5, |p| p[0]),
    (5, |p| p[2]),
];

/// Couplings of the enhanced modes: `K_aa⁻¹`, `K_au` and the thermal load of the modes.
struct EnhancedModes {
    inverse: SMatrix<f64, MODES, MODES>,
    displacement: SMatrix<f64, MODES, 24>,
    thermal: SMatrix<f64, MODES, 8>,
}

impl EnhancedModes {
    fn new(size: [f64; 3], law: &Thermoelastic) -> Self {
        let volume: f64 = size.iter().product();
        let elastic = elasticity(law);
        let mut own = SMatrix::<f64, MODES, MODES>::zeros();
        let mut displacement = SMatrix::<f64, MODES, 24>::zeros();
        let mut thermal = SMatrix::<f64, MODES, 8>::zeros();
        let points = gauss_legendre(2);
        for &(zeta, wz) in &points {
            for &(eta, wy) in &points {
                for &(xi, wx) in &points {
                    let place = [xi, eta, zeta];
                    let w = wx * wy * wz * volume / 8.0;
                    let modes = ENHANCED.map(|(component, f)| (component, f(place)));
                    let (n, gradient) = shapes_at(place, size);
                    for (m, &(component, value)) in modes.iter().enumerate() {
                        for (o, &(other, factor)) in modes.iter().enumerate() {
                            own[(m, o)] += w * value * elastic[component][other] * factor;
                        }
                        for a in 0..8 {
                            let stress = stress_of_node(&gradient[a], &elastic[component]);
                            for i in 0..3 {
                                displacement[(m, 3 * a + i)] += w * value * stress[i];
                            }
                            if component < 3 {
                                thermal[(m, a)] += w * value * law.thermal_modulus() * n[a];
                            }
                        }
                    }
                }
            }
        }
        let inverse = own.cholesky().expect("enhanced modes are independent").inverse();
        Self { inverse, displacement, thermal }
    }
}

/// Isotropic elasticity matrix for strains xx, yy, zz, xy, yz, xz with engineering shears.
pub fn elasticity(law: &Thermoelastic) -> [[f64; 6]; 6] {
    let (lambda, shear) = (law.lame_first(), law.shear_modulus());
    let mut d = [[0.0; 6]; 6];
    for i in 0..3 {
        d[i][..3].fill(lambda);
        d[i][i] += 2.0 * shear;
        d[i + 3][i + 3] = shear;
    }
    d
}

/// Values and gradients of the eight linear shape functions.
fn shapes_at(place: [f64; 3], size: [f64; 3]) -> ([f64; 8], [[f64; 3]; 8]) {
    let n = place.map(|xi| shape(1, xi));
    let d = [0, 1, 2].map(|k| slope(1, place[k]).map(|s| 2.0 * s / size[k]));
    let mut values = [0.0; 8];
    let mut gradients = [[0.0; 3]; 8];
    for a in 0..8 {
        let [i, j, k] = split(a, 2);
        values[a] = n[0][i] * n[1][j] * n[2][k];
        gradients[a] =
            [d[0][i] * n[1][j] * n[2][k], n[0][i] * d[1][j] * n[2][k], n[0][i] * n[1][j] * d[2][k]];
    }
    (values, gradients)
}

/// One stress component per displacement of a node along x, y and z: a row of `D B`.
fn stress_of_node([x, y, z]: &[f64; 3], row: &[f64; 6]) -> [f64; 3] {
    [
        row[0] * x + row[3] * y + row[5] * z,
        row[1] * y + row[3] * x + row[4] * z,
        row[2] * z + row[4] * y + row[5] * x,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Thermoelastic {
        Thermoelastic { young: 200.0, poisson: 0.3, expansion: 1e-3 }
    }

    /// Displacement of a node under a linear field.
    fn linear_field(order: usize, size: [f64; 3], gradient: [[f64; 3]; 3]) -> Vec<[f64; 3]> {
        let n = order + 1;
        (0..n * n * n)
            .map(|a| {
                let place = split(a, n);
                let x = [0, 1, 2].map(|k| place[k] as f64 / order as f64 * size[k]);
                gradient.map(|row| (0..3).map(|k| row[k] * x[k]).sum())
            })
            .collect()
    }

    fn forces(element: &HexahedronMatrices, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        (0..u.len())
            .map(|a| {
                let mut f = [0.0; 3];
                for (b, u) in u.iter().enumerate() {
                    let k = element.stiffness(a, b);
                    for i in 0..3 {
                        f[i] += (0..3).map(|j| k[3 * i + j] * u[j]).sum::<f64>();
                    }
                }
                f
            })
            .collect()
    }

    #[test]
    fn rigid_motion_costs_no_force() {
        let spin = [[0.0, -0.2, 0.4], [0.2, 0.0, -0.1], [-0.4, 0.1, 0.0]];
        for order in [1, 2] {
            let size = [1.0, 0.5, 0.2];
            let element = HexahedronMatrices::new(order, size, &law());
            for f in forces(&element, &linear_field(order, size, spin)) {
                assert!(f.iter().all(|v| v.abs() < 1e-11), "{f:?}");
            }
        }
    }

    #[test]
    fn uniform_strain_stores_the_exact_energy() {
        let gradient = [[1e-2, 2e-3, 0.0], [1e-3, -5e-3, 4e-3], [3e-3, 0.0, 7e-3]];
        let size = [1.0, 0.5, 0.2];
        let e = [
            gradient[0][0],
            gradient[1][1],
            gradient[2][2],
            gradient[0][1] + gradient[1][0],
            gradient[1][2] + gradient[2][1],
            gradient[0][2] + gradient[2][0],
        ];
        let d = elasticity(&law());
        let exact: f64 = (0..6)
            .flat_map(|i| (0..6).map(move |j| (i, j)))
            .map(|(i, j)| e[i] * d[i][j] * e[j])
            .sum::<f64>()
            * 0.1;
        for order in [1, 2] {
            let element = HexahedronMatrices::new(order, size, &law());
            let u = linear_field(order, size, gradient);
            let energy: f64 = forces(&element, &u)
                .iter()
                .zip(&u)
                .map(|(f, u)| (0..3).map(|i| f[i] * u[i]).sum::<f64>())
                .sum();
            assert!((energy / exact - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn free_expansion_needs_no_other_force() {
        let size = [0.3, 0.5, 0.2];
        let a = law().expansion;
        let u = [[a, 0.0, 0.0], [0.0, a, 0.0], [0.0, 0.0, a]];
        for order in [1, 2] {
            let element = HexahedronMatrices::new(order, size, &law());
            let internal = forces(&element, &linear_field(order, size, u));
            for (node, f) in internal.iter().enumerate() {
                for (i, f) in f.iter().enumerate() {
                    let thermal: f64 =
                        (0..internal.len()).map(|b| element.thermal(node, b)[i]).sum();
                    assert!((f - thermal).abs() < 1e-12, "{f} {thermal}");
                }
            }
        }
    }
}

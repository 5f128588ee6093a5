//! Small linear problems on rows of functions: what checks a discretisation, not what the library computes with.

use std::collections::HashMap;

use faer::Mat;
use faer::prelude::Solve;
use impinge::space::{Form, Mesh, Samples, Side, Space, Value};

/// Dense symmetric system.
pub struct System {
    pub matrix: Mat<f64>,
    pub right: Vec<f64>,
}

/// How a boundary value is imposed; forces of Nitsche's method and the penalty are per length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Essential {
    Nitsche(f64),
    Penalty(f64),
}

impl System {
    pub fn of(unknowns: usize) -> Self {
        Self { matrix: Mat::zeros(unknowns, unknowns), right: vec![0.0; unknowns] }
    }

    pub fn solve(&self) -> Vec<f64> {
        let n = self.right.len();
        let right = Mat::from_fn(n, 1, |i, _| self.right[i]);
        let solution = self.matrix.partial_piv_lu().solve(&right);
        (0..n).map(|i| solution[(i, 0)]).collect()
    }

    /// Adds `weight` Σ a_i b_j with the columns of sparse vectors of `L` components.
    pub fn add<const L: usize>(
        &mut self,
        weight: f64,
        test: &[(usize, [f64; L])],
        trial: &[(usize, [f64; L])],
    ) {
        for &(j, b) in trial {
            for &(i, a) in test {
                let product: f64 = (0..L).map(|k| a[k] * b[k]).sum();
                self.matrix[(i, j)] += weight * product;
            }
        }
    }

    /// Adds `weight` Σ a_i · value.
    pub fn load<const L: usize>(
        &mut self,
        weight: f64,
        test: &[(usize, [f64; L])],
        value: [f64; L],
    ) {
        for &(i, a) in test {
            self.right[i] += weight * (0..L).map(|k| a[k] * value[k]).sum::<f64>();
        }
    }

    /// Solves for nodal values u = Λ d, some of which are fixed, and returns d: Λ⁻ᵀ K Λ⁻¹ u = Λ⁻ᵀ f. `rows` are those
    /// of Λ.
    pub fn solve_transformed(
        &self,
        rows: &[Vec<(usize, f64)>],
        fixed: impl Fn(usize) -> Option<f64>,
    ) -> Vec<f64> {
        let n = self.right.len();
        let mut lambda = Mat::<f64>::zeros(n, n);
        for (i, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(j, value)| lambda[(i, j)] = value);
        }
        let transposed = lambda.transpose().to_owned().partial_piv_lu();
        let half = transposed.solve(&self.matrix);
        let matrix = transposed.solve(half.transpose().to_owned()).transpose().to_owned();
        let right = transposed.solve(&Mat::from_fn(n, 1, |i, _| self.right[i]));
        let mut system = Self { matrix, right: (0..n).map(|i| right[(i, 0)]).collect() };
        system.fix(fixed);
        let u = system.solve();
        let d = lambda.partial_piv_lu().solve(&Mat::from_fn(n, 1, |i, _| u[i]));
        (0..n).map(|i| d[(i, 0)]).collect()
    }

    /// The system with more unknowns, such as multipliers.
    pub fn bordered(self, count: usize) -> Self {
        let n = self.right.len();
        let mut larger = Self::of(n + count);
        for j in 0..n {
            (0..n).for_each(|i| larger.matrix[(i, j)] = self.matrix[(i, j)]);
        }
        larger.right[..n].copy_from_slice(&self.right);
        larger
    }

    /// Fixes unknowns. Their equations keep the scale of the others, which elimination needs.
    pub fn fix(&mut self, fixed: impl Fn(usize) -> Option<f64>) {
        let n = self.right.len();
        for i in 0..n {
            let Some(value) = fixed(i) else { continue };
            for j in 0..n {
                self.right[j] -= self.matrix[(j, i)] * value;
                if j != i {
                    self.matrix[(i, j)] = 0.0;
                    self.matrix[(j, i)] = 0.0;
                }
            }
            self.right[i] = self.matrix[(i, i)] * value;
        }
    }
}

/// Isotropic stiffness: Lamé's constants.
#[derive(Debug, Clone, Copy)]
pub struct Elastic {
    pub lambda: f64,
    pub mu: f64,
}

impl Elastic {
    pub fn strain(young: f64, poisson: f64) -> Self {
        Self {
            lambda: young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            mu: young / (2.0 * (1.0 + poisson)),
        }
    }

    /// Constants for which plane strain is plane stress.
    pub fn plane_stress(young: f64, poisson: f64) -> Self {
        let mu = young / (2.0 * (1.0 + poisson));
        Self { lambda: young * poisson / (1.0 - poisson * poisson), mu }
    }

    /// Stress of strains xx, yy, zz, yz, zx, xy (shears doubled).
    pub fn stress(&self, e: [f64; 6]) -> [f64; 6] {
        let trace = self.lambda * (e[0] + e[1] + e[2]);
        let direct = |a: usize| trace + 2.0 * self.mu * e[a];
        [direct(0), direct(1), direct(2), self.mu * e[3], self.mu * e[4], self.mu * e[5]]
    }

    /// Stress tensor of a displacement gradient.
    pub fn stress_of(&self, h: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let shear = |a: usize, b: usize| h[a][b] + h[b][a];
        let direct = [h[0][0], h[1][1], h[2][2]];
        let e = [direct[0], direct[1], direct[2], shear(1, 2), shear(2, 0), shear(0, 1)];
        let [xx, yy, zz, yz, zx, xy] = self.stress(e);
        [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]
    }
}

/// Strains of unit coefficients: unknown and xx, yy, zz, yz, zx, xy.
pub fn strains(form: Form, at: [f64; 3], row: &[Value]) -> Vec<(usize, [f64; 6])> {
    let axes = form.axes();
    let mut strains = Vec::new();
    for value in row {
        let [x, y, z] = value.gradient;
        for (n, &a) in axes.iter().enumerate() {
            let mut e = match a {
                0 => [x, 0.0, 0.0, 0.0, z, y],
                1 => [0.0, y, 0.0, z, 0.0, x],
                _ => [0.0, 0.0, z, y, x, 0.0],
            };
            if form == Form::Axisymmetric && a == 0 {
                e[1] = value.value / at[0];
            }
            strains.push((axes.len() * value.node as usize + n, e));
        }
    }
    strains
}

pub fn displacements(form: Form, row: &[Value]) -> Vec<(usize, [f64; 3])> {
    let axes = form.axes();
    let of = |value: &Value| {
        let (node, psi) = (value.node as usize, value.value);
        axes.iter()
            .enumerate()
            .map(move |(n, &a)| {
                let mut u = [0.0; 3];
                u[a] = psi;
                (axes.len() * node + n, u)
            })
            .collect::<Vec<_>>()
    };
    row.iter().flat_map(of).collect()
}

fn tractions(
    c: Elastic,
    normal: [f64; 3],
    strains: &[(usize, [f64; 6])],
) -> Vec<(usize, [f64; 3])> {
    let [n, m, l] = normal;
    let of = |&(unknown, e): &(usize, [f64; 6])| {
        let [xx, yy, zz, yz, zx, xy] = c.stress(e);
        let t = [xx * n + xy * m + zx * l, xy * n + yy * m + yz * l, zx * n + yz * m + zz * l];
        (unknown, t)
    };
    strains.iter().map(of).collect()
}

/// Stiffness of a body.
pub fn elasticity(space: &Space, c: Elastic) -> System {
    let mut system = System::of(space.form.axes().len() * space.nodes.len());
    for point in 0..space.volume.len() {
        let e = strains(space.form, space.volume.at[point], space.volume.row(point));
        let s: Vec<(usize, [f64; 6])> = e.iter().map(|&(n, e)| (n, c.stress(e))).collect();
        system.add(space.volume.weights[point], &e, &s);
    }
    system
}

/// Displacements `g` prescribed on sides.
pub fn prescribe(
    system: &mut System,
    space: &Space,
    c: Elastic,
    how: Essential,
    on: impl Fn(Side) -> bool,
    g: impl Fn([f64; 3]) -> [f64; 3],
) {
    let samples = &space.boundary.samples;
    for point in (0..samples.len()).filter(|&n| on(space.boundary.sides[n])) {
        let (at, weight) = (samples.at[point], samples.weights[point]);
        let u = displacements(space.form, samples.row(point));
        let value = g(at);
        let penalty = match how {
            Essential::Penalty(penalty) => penalty,
            Essential::Nitsche(penalty) => {
                let e = strains(space.form, at, samples.row(point));
                let t = tractions(c, space.boundary.normals[point], &e);
                system.add(-weight, &u, &t);
                system.add(-weight, &t, &u);
                system.load(-weight, &t, value);
                penalty
            }
        };
        system.add(weight * penalty, &u, &u);
        system.load(weight * penalty, &u, value);
    }
}

/// Tractions on sides.
pub fn pull(
    system: &mut System,
    space: &Space,
    on: impl Fn(Side) -> bool,
    t: impl Fn([f64; 3], [f64; 3]) -> [f64; 3],
) {
    let samples = &space.boundary.samples;
    for point in (0..samples.len()).filter(|&n| on(space.boundary.sides[n])) {
        let u = displacements(space.form, samples.row(point));
        system.load(
            samples.weights[point],
            &u,
            t(samples.at[point], space.boundary.normals[point]),
        );
    }
}

pub fn body_force(system: &mut System, space: &Space, b: impl Fn([f64; 3]) -> [f64; 3]) {
    for point in 0..space.volume.len() {
        let u = displacements(space.form, space.volume.row(point));
        system.load(space.volume.weights[point], &u, b(space.volume.at[point]));
    }
}

/// L2 and H1 seminorm errors of a vector field, relative; `samples` are fine.
pub fn errors(
    form: Form,
    samples: &Samples,
    d: &[f64],
    exact: impl Fn([f64; 3]) -> [f64; 3],
    gradient: impl Fn([f64; 3]) -> [[f64; 3]; 3],
) -> [f64; 2] {
    let mut sums = [[0.0; 2]; 2];
    let axes = form.axes();
    for point in 0..samples.len() {
        let (mut u, mut h) = ([0.0; 3], [[0.0; 3]; 3]);
        for value in samples.row(point) {
            for (n, &a) in axes.iter().enumerate() {
                let coefficient = d[axes.len() * value.node as usize + n];
                u[a] += coefficient * value.value;
                (0..3).for_each(|b| h[a][b] += coefficient * value.gradient[b]);
            }
        }
        let (at, w) = (samples.at[point], samples.weights[point]);
        let (u0, h0) = (exact(at), gradient(at));
        for a in 0..3 {
            sums[0][0] += w * (u[a] - u0[a]).powi(2);
            sums[0][1] += w * u0[a].powi(2);
            for b in 0..3 {
                sums[1][0] += w * (h[a][b] - h0[a][b]).powi(2);
                sums[1][1] += w * h0[a][b].powi(2);
            }
        }
    }
    sums.map(|[error, size]| (error / size).sqrt())
}

/// Lehmer's generator x ← 48271 x mod (2³¹ − 1) from x = 1.
pub struct Random(u64);

impl Random {
    pub fn new() -> Self {
        Self(1)
    }

    /// A number between −1 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0 * 48271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0 * 2.0 - 1.0
    }
}

/// Moves the nodes inside a mesh by up to `part` of the distance to their nearest neighbours along each coordinate.
pub fn perturb(mesh: &mut Mesh, part: f64) {
    let mut uses: HashMap<Vec<u32>, usize> = HashMap::new();
    let patterns: &[&[usize]] = match mesh.form {
        Form::Solid => &[
            &[0, 2, 4, 6],
            &[1, 3, 5, 7],
            &[0, 1, 4, 5],
            &[2, 3, 6, 7],
            &[0, 1, 2, 3],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 2], &[1, 3], &[0, 1], &[2, 3]],
    };
    let mut near = vec![f64::INFINITY; mesh.nodes.len()];
    for cell in &mesh.cells {
        for pattern in patterns {
            let mut key: Vec<u32> = pattern.iter().map(|&n| cell[n]).collect();
            key.sort_unstable();
            *uses.entry(key).or_default() += 1;
        }
        for &a in cell {
            for &b in cell.iter().filter(|&&b| b != a) {
                let (x, y) = (mesh.nodes[a as usize], mesh.nodes[b as usize]);
                let distance = (0..3).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt();
                near[a as usize] = near[a as usize].min(distance);
            }
        }
    }
    let mut outside = vec![false; mesh.nodes.len()];
    for (key, count) in &uses {
        if *count == 1 {
            key.iter().for_each(|&node| outside[node as usize] = true);
        }
    }
    let mut random = Random::new();
    let axes = mesh.form.axes();
    for n in 0..mesh.nodes.len() {
        for &a in axes {
            let step = random.next();
            if !outside[n] {
                mesh.nodes[n][a] += part * near[n] * step;
            }
        }
    }
}

/// Ascending eigenvalues of K v = λ M v.
pub fn generalised(k: &Mat<f64>, m: &Mat<f64>) -> Vec<f64> {
    let factor = m.llt(faer::Side::Lower).expect("a positive definite matrix");
    let lower = factor.L().to_owned();
    let mut left = k.clone();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        lower.as_ref(),
        left.as_mut(),
        faer::Par::Seq,
    );
    let mut both = left.transpose().to_owned();
    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        lower.as_ref(),
        both.as_mut(),
        faer::Par::Seq,
    );
    both.self_adjoint_eigenvalues(faer::Side::Lower).expect("a symmetric matrix")
}

pub fn scalars(row: &[Value]) -> Vec<(usize, [f64; 1])> {
    row.iter().map(|value| (value.node as usize, [value.value])).collect()
}

/// Σ w ∇Ψ·∇Ψ with the load Σ w Ψ s.
pub fn poisson(space: &Space, source: impl Fn([f64; 3]) -> f64) -> System {
    let mut system = System::of(space.nodes.len());
    for point in 0..space.volume.len() {
        let row = space.volume.row(point);
        let slopes: Vec<(usize, [f64; 3])> =
            row.iter().map(|value| (value.node as usize, value.gradient)).collect();
        let weight = space.volume.weights[point];
        system.add(weight, &slopes, &slopes);
        system.load(weight, &scalars(row), [source(space.volume.at[point])]);
    }
    system
}

/// Values `g` prescribed on the whole boundary.
pub fn prescribe_scalar(
    system: &mut System,
    space: &Space,
    how: Essential,
    g: impl Fn([f64; 3]) -> f64,
) {
    let samples = &space.boundary.samples;
    for point in 0..samples.len() {
        let (at, weight) = (samples.at[point], samples.weights[point]);
        let normal = space.boundary.normals[point];
        let u = scalars(samples.row(point));
        let penalty = match how {
            Essential::Penalty(penalty) => penalty,
            Essential::Nitsche(penalty) => {
                let flux = |value: &Value| {
                    let along: f64 = (0..3).map(|a| value.gradient[a] * normal[a]).sum();
                    (value.node as usize, [along])
                };
                let flux: Vec<(usize, [f64; 1])> = samples.row(point).iter().map(flux).collect();
                system.add(-weight, &u, &flux);
                system.add(-weight, &flux, &u);
                system.load(-weight, &flux, [g(at)]);
                penalty
            }
        };
        system.add(weight * penalty, &u, &u);
        system.load(weight * penalty, &u, [g(at)]);
    }
}

/// Error of a scalar field in L2.
pub fn scalar_error(samples: &Samples, d: &[f64], exact: impl Fn([f64; 3]) -> f64) -> f64 {
    let square = |p: usize| {
        let u: f64 = samples.row(p).iter().map(|v| v.value * d[v.node as usize]).sum();
        samples.weights[p] * (u - exact(samples.at[p])).powi(2)
    };
    (0..samples.len()).map(square).sum::<f64>().sqrt()
}

//! Quasi-static thermo-elasticity on a structured mesh: one solver serves all times.

mod influence;
mod strain_row;
mod thermal_row;

use std::convert::Infallible;
use std::ops::Range;
use std::sync::Arc;

use super::assembly::{Part, assemble, lower_triangle};
use super::axisymmetric::{QuadrilateralMatrices, Rectangle};
use super::brick_solver::{self, BrickSolver};
use super::dilatation::{DilatationProjection, POLYNOMIALS, evaluate};
use super::recovery::sampling_places;
use super::solver_choice::{solver_memory, suits_conjugate_gradients};
use crate::laws::Thermoelastic;
use crate::math::cholesky::{SolverError, SparseCholesky};
use crate::math::nested_dissection::nested_dissection;
use crate::math::stencil_matrix::StencilMatrix;
use crate::method::mesh::ShapeAt;
use crate::method::mesh::{Geometry, Mesh, MeshFace, Parity};
use crate::runtime::address_space::{self, PRODUCTS};
use crate::runtime::fork_lock::ForkLock;
use crate::runtime::made_once::MadeOnce;
use crate::runtime::parallel;
use crate::runtime::shared_values::SharedValues;
use crate::runtime::thread::{STACK, aside};
use influence::KeptRows;
pub use influence::{
    Component, FaceRows, Functional, Gradient, NodalRow, Term, memory_of_row, most_memory_of_rows,
};
pub use strain_row::StrainWeights;

/// Mechanical condition on an end of an axis; ends without one are free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// No displacement.
    Clamped,
    /// No displacement along the normal.
    Roller,
}

/// Data that determine an elastic problem.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticSetup {
    pub mesh: Mesh,
    /// Laws of the layers, from the lowest on.
    pub laws: Vec<Thermoelastic>,
    pub supports: Vec<(MeshFace, Support)>,
    pub threads: usize,
}

/// Bodies of one process that differ only in thermal data share their elastic problem.
static PROBLEMS: SharedValues<ElasticSetup, ElasticProblem> = SharedValues::new();

/// Drops all problems that are no longer held.
pub fn forget_unused_stiffness() {
    PROBLEMS.forget_unused();
}

/// Elastic problem of a body: everything known before time starts.
///
/// The solver of a symmetry class is made when that class is first loaded.
pub struct ElasticProblem {
    mesh: Mesh,
    /// Laws of the layers, from the lowest on.
    laws: Vec<Thermoelastic>,
    threads: usize,
    supports: Vec<(MeshFace, Support)>,
    /// Nodal force per nodal degree of each layer, made when first needed.
    thermal: MadeOnce<Vec<StencilMatrix>>,
    classes: Vec<(Parity, MadeOnce<Result<Solver, SolverError>>)>,
    rows: ForkLock<KeptRows>,
}

/// Solver for the displacements of one symmetry class.
enum Solver {
    Factor(Box<Factor>),
    Bricks(Box<BrickSolver>),
}

/// Factorised stiffness.
struct Factor {
    /// Free degrees of freedom, ascending.
    free: Vec<usize>,
    cholesky: SparseCholesky,
}

/// Largest memory per node of a solution and the stress from it [B].
const SOLUTION: usize = 1 << 10;

impl Factor {
    /// Replaces forces by displacements, which are zero where held.
    fn solve_in_place(&self, load: &mut [f64]) {
        let mut solution: Vec<f64> = self.free.iter().map(|&i| load[i]).collect();
        self.cholesky.solve_in_place(&mut solution);
        load.fill(0.0);
        for (&i, value) in self.free.iter().zip(solution) {
            load[i] = value;
        }
    }
}

/// Result of [`ElasticProblem::strains`] for one class: 6 values per point in a box, 4 (rr, tt, zz, rz) in axisymmetry.
pub type Strains = Vec<f64>;

impl ElasticProblem {
    /// Returns the problem of a setup, which is made unless another body of this process has it.
    pub fn shared(setup: &ElasticSetup) -> Arc<Self> {
        let make = || Ok::<_, Infallible>(Self::new(setup.clone()));
        let Ok(problem) = PROBLEMS.get_or_make(setup, make);
        problem
    }

    pub fn new(ElasticSetup { mesh, laws, supports, threads }: ElasticSetup) -> Self {
        let thermal = MadeOnce::new();
        let classes = mesh.parities().into_iter().map(|p| (p, MadeOnce::new())).collect();
        Self {
            mesh,
            laws,
            threads,
            supports,
            thermal,
            classes,
            rows: ForkLock::new(KeptRows::default()),
        }
    }

    /// Returns the law of a layer, counted from the lowest.
    pub fn law(&self, layer: usize) -> &Thermoelastic {
        &self.laws[layer]
    }

    fn thermal(&self) -> &[StencilMatrix] {
        let of_layer = |(layer, law): (usize, &Thermoelastic)| {
            let (mesh, law) = (self.mesh.layer_mesh(layer), std::slice::from_ref(law));
            assemble(&mesh, law, [self.degrees(), 1], Part::Thermal, self.threads)
        };
        self.thermal.get_or_make(|| self.laws.iter().enumerate().map(of_layer).collect())
    }

    /// Adds the thermal forces at constant strain. Each layer has temperatures of its own on interfaces.
    fn add_thermal_forces(&self, temperature: &[f64], load: &mut [f64]) {
        let [nx, ny, _] = self.mesh.node_counts();
        let mut rest = temperature;
        for (layer, matrix) in self.thermal().iter().enumerate() {
            let (own, above) = rest.split_at(matrix.nodes());
            rest = above;
            let first = self.mesh.layer_elements(layer).start * self.mesh.order() * nx * ny;
            let degrees = self.degrees();
            matrix.add_product(own, &mut load[degrees * first..][..degrees * own.len()]);
        }
    }

    /// Number of displacement components per node: 3 in a box, 2 (r, z) in axisymmetry.
    pub fn degrees(&self) -> usize {
        self.mesh.geometry.degrees()
    }

    /// Creates the solver of the even class, so that the first step takes no longer than the others.
    pub fn prepare(&self) -> Result<(), SolverError> {
        if let Solver::Factor(_) = self.solver(0)? {
            self.thermal();
        }
        Ok(())
    }

    /// Number of stored entries of all solvers made so far.
    pub fn factor_entries(&self) -> usize {
        let made = self.classes.iter().filter_map(|(_, lock)| lock.get()?.as_ref().ok());
        let entries = |solver: &Solver| match solver {
            Solver::Factor(factor) => factor.cholesky.entries(),
            Solver::Bricks(solver) => solver.entries(),
        };
        made.map(entries).sum()
    }

    /// Returns the nodal displacements of a class [m]; empty if nothing drives it.
    ///
    /// `temperature` is the nodal temperature above the stress-free one [K], with values of both layers on interfaces.
    /// `forces` has the nodal forces on the bottom and the top of the mesh [N], a list for each displacement component.
    pub fn displacement(
        &self,
        class: usize,
        temperature: &[f64],
        forces: &[Vec<Vec<f64>>; 2],
    ) -> Result<Vec<f64>, SolverError> {
        let degrees = self.degrees();
        address_space::expect(SOLUTION * self.mesh.nodes())?;
        let mut load = vec![0.0; self.mesh.nodes() * degrees];
        let plane = self.mesh.axes[0].len() * self.mesh.axes[1].len();
        for (lists, first) in forces.iter().zip([0, self.mesh.nodes() - plane]) {
            for (component, list) in lists.iter().enumerate() {
                for (node, force) in list.iter().enumerate() {
                    load[(first + node) * degrees + component] += force;
                }
            }
        }
        if temperature.iter().chain(&load).all(|&v| v == 0.0) {
            return Ok(Vec::new());
        }
        match self.solver(class)? {
            Solver::Factor(factor) => {
                if !temperature.is_empty() {
                    self.add_thermal_forces(temperature, &mut load);
                }
                factor.solve_in_place(&mut load);
            }
            Solver::Bricks(solver) => {
                solver.solve_in_place(&mut load, temperature, brick_solver::TOLERANCE)?;
            }
        }
        Ok(load)
    }

    /// Returns the strains of a class at the sampling points, ordered like nodes, x fastest. The strain along z
    /// excludes that of a free heated layer ([`Thermoelastic::layer_strain`]), so that all strains vary slowly through
    /// the depth.
    pub fn strains(&self, displacement: &[f64], temperature: &[f64]) -> Strains {
        match self.mesh.geometry {
            Geometry::Box => self.box_strains(displacement, temperature),
            Geometry::Axisymmetric => self.ring_strains(displacement, temperature),
        }
    }

    fn solver(&self, class: usize) -> Result<&Solver, SolverError> {
        let (parity, lock) = &self.classes[class];
        if lock.get().is_none() {
            let memory = solver_memory(&self.mesh, &self.laws);
            address_space::expect(memory as usize + PRODUCTS + STACK)?;
        }
        lock.get_or_make(|| aside(|| self.make_solver(*parity))).as_ref().map_err(Clone::clone)
    }

    fn make_solver(&self, parity: Parity) -> Result<Solver, SolverError> {
        let suits = suits_conjugate_gradients(&self.mesh, &self.laws);
        match self.free_nodes(parity).filter(|_| suits) {
            Some(free) => {
                let solver = BrickSolver::new(&self.mesh, &self.laws, free, self.threads);
                Ok(Solver::Bricks(Box::new(solver)))
            }
            None => self.make_factor(parity).map(|factor| Solver::Factor(Box::new(factor))),
        }
    }

    /// Returns the free nodes of a box along each axis for each displacement component; `None` if one component is held
    /// nowhere, so that the body can move.
    pub fn free_nodes(&self, parity: Parity) -> Option<[[Range<usize>; 3]; 3]> {
        let mut free = [(); 3].map(|()| self.mesh.node_counts().map(|count| 0..count));
        let mut hold = |component: usize, MeshFace { axis, high }: MeshFace| {
            let Range { start, end } = &mut free[component][axis];
            let count = self.mesh.axes[axis].len();
            if high {
                *end = count - 1;
            } else {
                *start = 1;
            }
        };
        for &(face, support) in &self.supports {
            let held = |&c: &usize| support == Support::Clamped || c == face.axis;
            (0..3).filter(held).for_each(|c| hold(c, face));
        }
        for axis in (0..2).filter(|&a| self.mesh.mirrored[a]) {
            let held = |&c: &usize| (c == axis) != parity.odd[axis];
            (0..3).filter(held).for_each(|c| hold(c, MeshFace { axis, high: false }));
        }
        let counts = self.mesh.node_counts();
        let is_held = |free: &[Range<usize>; 3]| (0..3).any(|a| free[a].len() < counts[a]);
        free.iter().all(is_held).then_some(free)
    }

    fn make_factor(&self, parity: Parity) -> Result<Factor, SolverError> {
        let degrees = self.degrees();
        let stiffness =
            assemble(&self.mesh, &self.laws, [degrees; 2], Part::Stiffness, self.threads);
        let held = self.held(parity);
        let free: Vec<usize> = (0..held.len()).filter(|&i| !held[i]).collect();
        let mut number = vec![usize::MAX; held.len()];
        for (k, &i) in free.iter().enumerate() {
            number[i] = k;
        }
        let order: Vec<usize> = nested_dissection(self.mesh.element_counts(), self.mesh.order())
            .into_iter()
            .flat_map(|node| (0..degrees).map(move |c| node * degrees + c))
            .filter_map(|i| (number[i] != usize::MAX).then_some(number[i]))
            .collect();
        let triangle = lower_triangle(&stiffness, degrees, &number);
        drop(stiffness);
        let cholesky = SparseCholesky::factor(&triangle, &order, self.threads)?;
        Ok(Factor { free, cholesky })
    }

    /// Returns which degrees of freedom are held by supports and symmetry planes.
    pub fn held(&self, parity: Parity) -> Vec<bool> {
        let degrees = self.degrees();
        let mut held = vec![false; self.mesh.nodes() * degrees];
        let component_of_axis = |axis: usize| match self.mesh.geometry {
            Geometry::Box => axis,
            Geometry::Axisymmetric => axis / 2,
        };
        for &(face, support) in &self.supports {
            let normal = component_of_axis(face.axis);
            for node in self.face_nodes(face) {
                for c in 0..degrees {
                    held[node * degrees + c] |= support == Support::Clamped || c == normal;
                }
            }
        }
        for axis in (0..2).filter(|&a| self.mesh.mirrored[a]) {
            // On the plane an even field has no normal displacement, and an odd one no tangential displacement.
            for node in self.face_nodes(MeshFace { axis, high: false }) {
                for c in 0..degrees {
                    held[node * degrees + c] |= (c == axis) != parity.odd[axis];
                }
            }
        }
        if self.mesh.geometry == Geometry::Axisymmetric && self.mesh.axes[0].start() == 0.0 {
            for node in self.face_nodes(MeshFace { axis: 0, high: false }) {
                held[node * degrees] = true;
            }
        }
        held
    }

    fn face_nodes(&self, face: MeshFace) -> Vec<usize> {
        let counts = self.mesh.node_counts();
        let at = if face.high { counts[face.axis] - 1 } else { 0 };
        let strides = [1, counts[0], counts[0] * counts[1]];
        (0..self.mesh.nodes())
            .filter(|n| n / strides[face.axis] % counts[face.axis] == at)
            .collect()
    }

    fn box_strains(&self, displacement: &[f64], temperature: &[f64]) -> Strains {
        let places = self.mesh.axes.each_ref().map(sampling_places);
        let counts = self.mesh.node_counts();
        let dilatations =
            (self.mesh.order() > 1).then(|| self.projected_dilatations(displacement, temperature));
        let [nx, ny, _] = self.mesh.element_counts();
        let slabs = parallel::map(self.threads, places[2].len(), |k| {
            let (element_z, z) = places[2][k];
            let law = self.law_of(element_z);
            let (expansion, layer) = (3.0 * law.expansion, law.layer_strain());
            let mut slab = Vec::with_capacity(places[0].len() * places[1].len() * 6);
            for &y in &places[1] {
                for &x in &places[0] {
                    let place = [x, y, places[2][k]];
                    let shapes =
                        [0, 1, 2].map(|a| self.mesh.axes[a].shape_in(place[a].0, place[a].1));
                    let mut strain = strain_at(&shapes, counts, displacement);
                    let [along_x, along_y, _] = shapes;
                    let sided = [along_x, along_y, self.mesh.sided_shape_in(element_z, z)];
                    let rise = value_at(&sided, counts, temperature);
                    if let Some(dilatations) = &dilatations {
                        let element = place[0].0 + nx * (place[1].0 + ny * place[2].0);
                        let at = [0, 1, 2]
                            .map(|a| local(self.mesh.axes[a].bounds(place[a].0), place[a].1));
                        let wanted = evaluate(&dilatations[element], at) + expansion * rise;
                        let change = (wanted - strain[0] - strain[1] - strain[2]) / 3.0;
                        strain[..3].iter_mut().for_each(|e| *e += change);
                    }
                    strain[2] -= layer * rise;
                    slab.extend(strain);
                }
            }
            slab
        });
        slabs.concat()
    }

    /// Coefficients of the projected `tr ε − 3 α ΔT` of every element.
    fn projected_dilatations(
        &self,
        displacement: &[f64],
        temperature: &[f64],
    ) -> Vec<[f64; POLYNOMIALS]> {
        let [nx, ny, nz] = self.mesh.element_counts();
        let [columns, rows, _] = self.mesh.node_counts();
        let order = self.mesh.order();
        let n = order + 1;
        parallel::map(self.threads, nx * ny * nz, |e| {
            let element = [e % nx, e / nx % ny, e / (nx * ny)];
            let layer = self.mesh.layering.layer_of(element[2]);
            let size = [0, 1, 2].map(|a| {
                let [low, high] = self.mesh.axes[a].bounds(element[a]);
                high - low
            });
            let nodes = (0..n * n * n).map(|a| {
                let at = [a % n, a / n % n, a / (n * n)];
                let [i, j, k] = [0, 1, 2].map(|axis| element[axis] * order + at[axis]);
                let node = i + columns * (j + rows * k);
                let u = &displacement[3 * node..][..3];
                let sided = node + layer * columns * rows;
                let rise = temperature.get(sided).copied().unwrap_or(0.0);
                ([u[0], u[1], u[2]], 3.0 * self.laws[layer].expansion * rise)
            });
            DilatationProjection::new(order, size).coefficients(nodes)
        })
    }

    fn ring_strains(&self, displacement: &[f64], temperature: &[f64]) -> Strains {
        let [radii, _, heights] = &self.mesh.axes;
        let (places_r, places_z) = (sampling_places(radii), sampling_places(heights));
        let per_element = places_r.len() / radii.elements();
        let counts = self.mesh.node_counts();
        let mut out = vec![0.0; places_r.len() * places_z.len() * 4];
        for ez in 0..heights.elements() {
            let layer = self.law_of(ez).layer_strain();
            let planes_below = self.mesh.layering.layer_of(ez) * radii.len();
            for er in 0..radii.elements() {
                let element = self.ring(er, ez);
                let nodes = self.ring_nodes(er, ez);
                let u: Vec<f64> = nodes
                    .iter()
                    .flat_map(|&n| [displacement[2 * n], displacement[2 * n + 1]])
                    .collect();
                let value = |&n: &usize| temperature.get(n + planes_below).copied().unwrap_or(0.0);
                let t: Vec<f64> = nodes.iter().map(value).collect();
                for jz in per_element * ez..per_element * (ez + 1) {
                    for jr in per_element * er..per_element * (er + 1) {
                        let xi = local(radii.bounds(er), places_r[jr].1);
                        let eta = local(heights.bounds(ez), places_z[jz].1);
                        let shapes = [
                            radii.shape_in(er, places_r[jr].1),
                            self.mesh.axes[1].shape_at(0.0),
                            self.mesh.sided_shape_in(ez, places_z[jz].1),
                        ];
                        let mut strain = element.strain(xi, eta, &u, &t);
                        strain[2] -= layer * value_at(&shapes, counts, temperature);
                        out[4 * (jr + places_r.len() * jz)..][..4].copy_from_slice(&strain);
                    }
                }
            }
        }
        out
    }

    fn law_of(&self, element_z: usize) -> &Thermoelastic {
        self.law(self.mesh.layering.layer_of(element_z))
    }

    fn ring(&self, er: usize, ez: usize) -> QuadrilateralMatrices {
        let [radii, _, heights] = &self.mesh.axes;
        let rectangle = Rectangle { r: radii.bounds(er), z: heights.bounds(ez) };
        QuadrilateralMatrices::new(self.mesh.order(), rectangle, self.law_of(ez))
    }

    fn ring_nodes(&self, er: usize, ez: usize) -> Vec<usize> {
        let order = self.mesh.order();
        let columns = self.mesh.axes[0].len();
        (0..=order)
            .flat_map(|j| (0..=order).map(move |i| (er * order + i) + columns * (ez * order + j)))
            .collect()
    }
}

/// Strain xx, yy, zz, xy, yz, xz at a point with the given shape functions along the axes.
fn strain_at([x, y, z]: &[ShapeAt; 3], counts: [usize; 3], displacement: &[f64]) -> [f64; 6] {
    let mut g = [[0.0; 3]; 3];
    for c in 0..z.count {
        for b in 0..y.count {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c));
            for a in 0..x.count {
                let n = [
                    x.slopes[a] * y.values[b] * z.values[c],
                    x.values[a] * y.slopes[b] * z.values[c],
                    x.values[a] * y.values[b] * z.slopes[c],
                ];
                let u = &displacement[3 * (row + x.first + a)..][..3];
                for i in 0..3 {
                    for j in 0..3 {
                        g[i][j] += u[i] * n[j];
                    }
                }
            }
        }
    }
    [g[0][0], g[1][1], g[2][2], g[0][1] + g[1][0], g[1][2] + g[2][1], g[0][2] + g[2][0]]
}

/// A nodal scalar at a point; zero for an empty field.
fn value_at([x, y, z]: &[ShapeAt; 3], counts: [usize; 3], field: &[f64]) -> f64 {
    if field.is_empty() {
        return 0.0;
    }
    let mut sum = 0.0;
    for c in 0..z.count {
        for b in 0..y.count {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c)) + x.first;
            let weight = y.values[b] * z.values[c];
            sum += weight * (0..x.count).map(|a| x.values[a] * field[row + a]).sum::<f64>();
        }
    }
    sum
}

/// Local coordinate of `x` in `[a, b]`.
fn local([a, b]: [f64; 2], x: f64) -> f64 {
    (2.0 * x - a - b) / (b - a)
}

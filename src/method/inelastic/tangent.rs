//! Changes of displacement under changes of force: the linear systems of Newton's method.
//!
//! In a box, the tangent is the matrix-free elastic stiffness plus corrections of the elements that flow or whose
//! constants differ. Corrections of quadratic elements are computed from their points, those of linear ones, with
//! condensed enhanced strains, are matrices of 24 rows. Conjugate gradients are preconditioned by the fast inverse of
//! elasticity. In sections and in nearly incompressible bodies the tangent is factored, and also in a box where
//! conjugate gradients fail.

use super::element::Kit;
use super::grid::{Grid, Iterate};
use super::shapes::Scratch;
use crate::laws::{PointConstants, PointTangent, Thermoelastic};
use crate::math::cholesky::{SolverError, SparseCholesky};
use crate::math::conjugate_gradients::{self, Operator};
use crate::math::nested_dissection::nested_dissection;
use crate::math::stencil_matrix::{Reach, StencilMatrix};
use crate::method::fem::assembly::lower_triangle;
use crate::method::fem::brick_inverse::BrickInverse;
use crate::method::fem::brick_stiffness::BrickStiffness;
use crate::method::fem::elastic::{ElasticProblem, ElasticSetup, Support};
use crate::method::fem::{Mesh, MeshFace, Parity};
use crate::runtime::parallel::Team;

/// Poisson's ratio up to which conjugate gradients need few iterations.
const MOST_POISSON: f64 = 0.45;

/// Solver for changes of displacement.
pub struct TangentSolver {
    /// Matrix-free elasticity and its fast inverse, if they are suitable.
    bricks: Option<Bricks>,
    /// Flags of held displacements, node after node.
    held: Vec<bool>,
    /// Elimination order of the free displacements.
    order: Vec<usize>,
    reach: [Reach; 3],
}

struct Bricks {
    stiffness: BrickStiffness,
    inverse: BrickInverse,
    /// The elastic tangent of these.
    reference: PointTangent,
}

/// Elements of a layer whose tangent is not elastic, and the differences.
#[derive(Default)]
struct Corrections {
    elements: Vec<[usize; 3]>,
    /// For quadratic elements: differences at their points.
    points: Vec<PointTangent>,
    /// For linear elements: the lower triangles of their matrices, row after row.
    triangles: Vec<f64>,
}

struct Corrected<'a> {
    grid: &'a Grid,
    bricks: &'a Bricks,
    layers: &'a [Corrections],
    team: &'a Team,
}

impl TangentSolver {
    /// `reference` holds constants that represent the body.
    pub fn new(
        mesh: &Mesh,
        reference: &PointConstants,
        supports: &[(MeshFace, Support)],
        team: &Team,
    ) -> Self {
        let (bulk, shear) = (reference.bulk, reference.shear);
        let law = Thermoelastic {
            young: 9.0 * bulk * shear / (3.0 * bulk + shear),
            poisson: (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
            expansion: 0.0,
        };
        let laws = vec![law.clone(); mesh.layering.count()];
        let elastic = ElasticProblem::new(ElasticSetup {
            mesh: mesh.clone(),
            laws: laws.to_vec(),
            supports: supports.to_vec(),
            threads: 1,
        });
        let parity = Parity::default();
        let held = elastic.held(parity);
        let degrees = mesh.geometry.degrees();
        let order = nested_dissection(mesh.element_counts(), mesh.order())
            .into_iter()
            .flat_map(|node| (0..degrees).map(move |c| node * degrees + c))
            .filter(|&i| !held[i])
            .collect();
        let reach = mesh.axes.each_ref().map(|axis| match axis.elements() {
            0 => Reach { first: vec![0], last: vec![0] },
            n => Reach::of_elements(n, axis.order),
        });
        let suits = degrees == 3 && law.poisson <= MOST_POISSON;
        let bricks = elastic.free_nodes(parity).filter(|_| suits).map(|free| Bricks {
            inverse: BrickInverse::new(mesh, &laws, &free, team),
            stiffness: BrickStiffness::new(mesh, &laws, free),
            reference: reference.elastic_tangent(),
        });
        Self { bricks, held, order, reach }
    }

    /// Returns true if the tangent is factored.
    pub fn is_factored(&self) -> bool {
        self.bricks.is_none()
    }

    /// Sets held displacements to zero.
    pub fn hold(&self, grid: &Grid, x: &mut [f64]) {
        let degrees = grid.kit.shapes.degrees;
        for (c, component) in x.chunks_exact_mut(grid.nodes).enumerate() {
            for (node, value) in component.iter_mut().enumerate() {
                if self.held[node * degrees + c] {
                    *value = 0.0;
                }
            }
        }
    }

    /// Solves for changes of displacement under a change of force, to a relative accuracy; returns the number of
    /// iterations.
    pub fn solve(
        &self,
        grid: &Grid,
        iterate: &Iterate,
        load: &[f64],
        tolerance: f64,
        team: &Team,
    ) -> Result<(Vec<f64>, usize), SolverError> {
        if let Some(bricks) = &self.bricks {
            let layers = corrections(grid, bricks, iterate, team);
            let operator = Corrected { grid, bricks, layers: &layers, team };
            if let Ok(found) = conjugate_gradients::solve(&operator, load, tolerance, team) {
                return Ok(found);
            }
        }
        Ok((self.by_factor(grid, iterate, load, team)?, 0))
    }

    fn by_factor(
        &self,
        grid: &Grid,
        iterate: &Iterate,
        load: &[f64],
        team: &Team,
    ) -> Result<Vec<f64>, SolverError> {
        let degrees = grid.kit.shapes.degrees;
        let matrix = self.assemble(grid, iterate, team);
        let mut number = vec![usize::MAX; self.held.len()];
        let free = || (0..self.held.len()).filter(|&i| !self.held[i]);
        free().enumerate().for_each(|(k, i)| number[i] = k);
        let order: Vec<usize> = self.order.iter().map(|&i| number[i]).collect();
        let triangle = lower_triangle(&matrix, degrees, &number);
        drop(matrix);
        let cholesky = SparseCholesky::factor(&triangle, &order, team.threads())?;
        drop(triangle);
        let place = |i: usize| i % degrees * grid.nodes + i / degrees;
        let mut solution: Vec<f64> = free().map(|i| load[place(i)]).collect();
        cholesky.solve_in_place(&mut solution);
        let mut out = vec![0.0; load.len()];
        for (i, value) in free().zip(solution) {
            out[place(i)] = value;
        }
        Ok(out)
    }

    fn assemble(&self, grid: &Grid, iterate: &Iterate, team: &Team) -> StencilMatrix {
        let Kit { shapes, .. } = &grid.kit;
        let (degrees, nodes, points) = (shapes.degrees, shapes.nodes, shapes.points);
        let counts = self.reach.each_ref().map(Reach::len);
        let split =
            |n: usize| [n % counts[0], n / counts[0] % counts[1], n / (counts[0] * counts[1])];
        let mut matrix = StencilMatrix::zeros(self.reach.clone(), [degrees; 2]);
        for layer in 0..grid.layers() {
            // One layer of matrices at a time: computed on all threads, added in fixed order.
            let all = team.map(grid.per_layer(), |e| {
                let number = layer * grid.per_layer() + e;
                let tangents = &iterate.tangents[number * points..][..points];
                grid.kit.stiffness(grid.place(layer, e), tangents, &mut Scratch::default())
            });
            for (e, stiffness) in all.iter().enumerate() {
                let places: Vec<[usize; 3]> =
                    grid.nodes_of(grid.place(layer, e)).map(split).collect();
                for (a, from) in places.iter().enumerate() {
                    for (b, to) in places.iter().enumerate() {
                        let block = matrix.block_mut(*from, *to);
                        for i in 0..degrees {
                            for j in 0..degrees {
                                let column = (j * nodes + b) * degrees * nodes;
                                block[i * degrees + j] += stiffness[column + i * nodes + a];
                            }
                        }
                    }
                }
            }
        }
        matrix
    }
}

/// Finds where the tangent differs from that of elasticity.
fn corrections(grid: &Grid, bricks: &Bricks, iterate: &Iterate, team: &Team) -> Vec<Corrections> {
    let (points, reference) = (grid.kit.shapes.points, bricks.reference);
    let differs = |t: &PointTangent| {
        // Rounding of constants that are the same.
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b;
        !(same(t.bulk, reference.bulk) && same(t.all, reference.all) && t.along == 0.0)
    };
    team.map(grid.layers(), |layer| {
        let mut found = Corrections::default();
        let mut scratch = Scratch::default();
        // Neighbouring elements of equal size share one matrix of elasticity.
        let mut known: Option<([f64; 3], Vec<f64>)> = None;
        for e in 0..grid.per_layer() {
            let number = layer * grid.per_layer() + e;
            let tangents = &iterate.tangents[number * points..][..points];
            if !tangents.iter().any(differs) {
                continue;
            }
            let place = grid.place(layer, e);
            found.elements.push(place);
            if grid.kit.treatment.modes() == 0 {
                found.points.extend(tangents.iter().map(|t| PointTangent {
                    bulk: t.bulk - reference.bulk,
                    all: t.all - reference.all,
                    ..*t
                }));
                continue;
            }
            let size = grid.kit.shapes.size(place);
            let own = grid.kit.stiffness(place, tangents, &mut scratch);
            if known.as_ref().is_none_or(|(other, _)| *other != size) {
                let elastic = vec![reference; points];
                known = Some((size, grid.kit.stiffness(place, &elastic, &mut scratch)));
            }
            let elastic = &known.as_ref().expect("it is known by now").1;
            let unknowns = grid.kit.unknowns();
            for row in 0..unknowns {
                let entries = row * unknowns..row * unknowns + row + 1;
                let pairs = own[entries.clone()].iter().zip(&elastic[entries]);
                found.triangles.extend(pairs.map(|(own, elastic)| own - elastic));
            }
        }
        found
    })
}

impl Corrections {
    /// Number of elements processed at once.
    const BATCH: usize = 32;

    fn forces(
        &self,
        grid: &Grid,
        x: &[f64],
        scratch: &mut Scratch,
        mut add: impl FnMut(&[[usize; 3]], &[f64]),
    ) {
        let (points, unknowns) = (grid.kit.shapes.points, grid.kit.unknowns());
        let triangle = unknowns * (unknowns + 1) / 2;
        let (mut u, mut f, mut strains) = (Vec::new(), Vec::new(), Vec::new());
        for (batch, elements) in self.elements.chunks(Self::BATCH).enumerate() {
            grid.gather(elements, x, &mut u);
            f.clear();
            f.resize(u.len(), 0.0);
            let first = batch * Self::BATCH;
            if self.points.is_empty() {
                let triangles = self.triangles[first * triangle..].chunks_exact(triangle);
                for ((entries, u), f) in
                    triangles.zip(u.chunks_exact(unknowns)).zip(f.chunks_exact_mut(unknowns))
                {
                    add_symmetric(entries, u, f);
                }
            } else {
                strains.clear();
                strains.resize(elements.len() * points, [0.0; 6]);
                grid.kit.shapes.strains(elements, &u, &mut strains, scratch);
                for (e, strains) in strains.chunks_exact_mut(points).enumerate() {
                    let tangents = &self.points[(first + e) * points..][..points];
                    let prepared = grid.kit.prepare(elements[e], tangents);
                    grid.kit.relieved(&prepared, tangents, strains);
                }
                grid.kit.shapes.forces(elements, &strains, &mut f, scratch);
            }
            add(elements, &f);
        }
    }
}

/// `f += A u`, A by the rows of its lower triangle.
fn add_symmetric(triangle: &[f64], u: &[f64], f: &mut [f64]) {
    let mut rest = triangle;
    for i in 0..u.len() {
        let (row, next) = rest.split_at(i + 1);
        rest = next;
        let mut sum = row[i] * u[i];
        for (j, entry) in row[..i].iter().enumerate() {
            sum += entry * u[j];
            f[j] += entry * u[i];
        }
        f[i] += sum;
    }
}

impl Operator for Corrected<'_> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.bricks.stiffness.apply(x, out, self.team);
        if self.layers.iter().all(|layer| layer.elements.is_empty()) {
            return;
        }
        let items = self.layers.iter().collect();
        self.grid.add_layers(self.team, out, items, |layer, item: &mut &Corrections, scratch| {
            item.forces(self.grid, x, scratch, |elements, forces| {
                self.grid.scatter(elements, forces, layer);
            });
        });
        self.bricks.stiffness.hold(out, self.team);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        self.bricks.inverse.apply(residual, out, self.team);
    }
}

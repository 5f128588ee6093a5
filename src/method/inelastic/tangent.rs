//! Changes of displacement under changes of force: the linear systems of Newton's method.
//!
//! In a box, the tangent is the matrix-free elastic stiffness plus corrections of the elements that flow or whose
//! constants differ. Corrections of quadratic elements are computed from their points, those of linear ones, with
//! condensed enhanced strains, are matrices of 24 rows. Conjugate gradients are preconditioned by the fast inverse of
//! elasticity. In sections and in nearly incompressible bodies the tangent is factored, and also in a box where
//! conjugate gradients fail. Where moduli relax, elasticity is that of each layer over the step.

use std::ops::Range;
use std::sync::Arc;

use super::element::Kit;
use super::grid::{Grid, Iterate};
use super::kept::{Kept, representative, runs};
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
pub const MOST_POISSON: f64 = 0.45;

/// Number of kept factors, and of kept inverses of elasticity, where moduli relax: steps have two lengths, and none for
/// what is instantaneous.
pub const MOST_KEPT: usize = 4;

/// Solver for changes of displacement.
pub struct TangentSolver {
    mesh: Mesh,
    /// Free nodes of a box; `None` in a section and in a box that can move.
    free: Option<[[Range<usize>; 3]; 3]>,
    /// Matrix-free elasticity and its fast inverse, if they are suitable at all times.
    bricks: Option<Arc<Bricks>>,
    /// The same for tangents of the layers that relax; `None` if none does.
    relaxed: Option<Kept<Vec<PointTangent>, Bricks>>,
    factors: Kept<Vec<(PointTangent, usize)>, SparseCholesky>,
    /// True if the tangent may have to be factored.
    is_factored: bool,
    /// Flags of held displacements, node after node.
    held: Vec<bool>,
    /// Elimination order of the free displacements.
    order: Vec<usize>,
    reach: [Reach; 3],
}

struct Bricks {
    stiffness: BrickStiffness,
    inverse: BrickInverse,
    /// The elastic tangent of these in each layer of elements.
    references: Vec<PointTangent>,
}

impl Bricks {
    /// `tangents` are those of the layers of the body.
    fn new(
        mesh: &Mesh,
        tangents: &[PointTangent],
        free: &[[Range<usize>; 3]; 3],
        team: &Team,
    ) -> Self {
        let laws: Vec<Thermoelastic> = tangents.iter().map(elastic_law).collect();
        let elements = 0..mesh.axes[2].elements();
        Self {
            inverse: BrickInverse::new(mesh, &laws, free, team),
            stiffness: BrickStiffness::new(mesh, &laws, free.clone()),
            references: elements.map(|e| tangents[mesh.layering.layer_of(e)]).collect(),
        }
    }
}

/// Elasticity with a tangent.
fn elastic_law(&PointTangent { bulk, all, .. }: &PointTangent) -> Thermoelastic {
    let shear = 0.5 * all;
    Thermoelastic {
        young: 9.0 * bulk * shear / (3.0 * bulk + shear),
        poisson: (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
        expansion: 0.0,
    }
}

/// Returns true if conjugate gradients need few iterations.
fn suits(tangent: &PointTangent) -> bool {
    elastic_law(tangent).poisson <= MOST_POISSON
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
    /// `reference` holds constants that represent the body, `relaxed` the tangents of the layers of elements after
    /// everything has relaxed, if something does.
    pub fn new(
        mesh: &Mesh,
        (reference, relaxed): (&PointConstants, Option<&[PointTangent]>),
        supports: &[(MeshFace, Support)],
        team: &Team,
    ) -> Self {
        let reference = reference.elastic_tangent();
        let references = vec![reference; mesh.layering.count()];
        let elastic = ElasticProblem::new(ElasticSetup {
            mesh: mesh.clone(),
            laws: references.iter().map(elastic_law).collect(),
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
        let free = (degrees == 3).then(|| elastic.free_nodes(parity)).flatten();
        let fixed = free.as_ref().filter(|_| relaxed.is_none() && suits(&reference));
        let bricks = fixed.map(|free| Arc::new(Bricks::new(mesh, &references, free, team)));
        let is_factored = match relaxed {
            Some(relaxed) => free.is_none() || !relaxed.iter().all(suits),
            None => bricks.is_none(),
        };
        let most = if relaxed.is_some() { MOST_KEPT } else { 1 };
        Self {
            mesh: mesh.clone(),
            free,
            bricks,
            relaxed: relaxed.map(|_| Kept::new(MOST_KEPT)),
            factors: Kept::new(most),
            is_factored,
            held,
            order,
            reach,
        }
    }

    /// Returns the largest number of factors at a time; zero if the tangent is never factored.
    pub fn factors(&self) -> usize {
        if self.is_factored { self.factors.most() + 1 } else { 0 }
    }

    /// Returns matrix-free elasticity near the tangents of an iterate, if it is suitable.
    fn bricks(&self, grid: &Grid, iterate: &Iterate, team: &Team) -> Option<Arc<Bricks>> {
        let Some(kept) = &self.relaxed else { return self.bricks.clone() };
        let free = self.free.as_ref()?;
        let of_layer = grid.per_layer() * grid.kit.shapes.points;
        let layers = (0..self.mesh.layering.count()).map(|layer| self.mesh.layer_elements(layer));
        let tangents: Vec<PointTangent> = layers
            .map(|own| representative(&iterate.tangents[own.start * of_layer..own.end * of_layer]))
            .collect();
        if !tangents.iter().all(suits) {
            return None;
        }
        kept.get(&tangents).or_else(|| {
            let bricks = Arc::new(Bricks::new(&self.mesh, &tangents, free, team));
            kept.keep(tangents, bricks.clone());
            Some(bricks)
        })
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
        if let Some(bricks) = self.bricks(grid, iterate, team) {
            let layers = corrections(grid, &bricks, iterate, team);
            let operator = Corrected { grid, bricks: &bricks, layers: &layers, team };
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
        // Only tangents that are the same all over a layer recur.
        let key = runs(&iterate.tangents, grid.layers());
        let known = key.as_ref().and_then(|key| self.factors.get(key));
        let cholesky = match known {
            Some(cholesky) => cholesky,
            None => {
                let cholesky = Arc::new(self.factor(grid, iterate, team)?);
                key.into_iter().for_each(|key| self.factors.keep(key, cholesky.clone()));
                cholesky
            }
        };
        let degrees = grid.kit.shapes.degrees;
        let free = || (0..self.held.len()).filter(|&i| !self.held[i]);
        let place = |i: usize| i % degrees * grid.nodes + i / degrees;
        let mut solution: Vec<f64> = free().map(|i| load[place(i)]).collect();
        cholesky.solve_in_place(&mut solution);
        let mut out = vec![0.0; load.len()];
        for (i, value) in free().zip(solution) {
            out[place(i)] = value;
        }
        Ok(out)
    }

    fn factor(
        &self,
        grid: &Grid,
        iterate: &Iterate,
        team: &Team,
    ) -> Result<SparseCholesky, SolverError> {
        let matrix = self.assemble(grid, iterate, team);
        let mut number = vec![usize::MAX; self.held.len()];
        let free = (0..self.held.len()).filter(|&i| !self.held[i]);
        free.enumerate().for_each(|(k, i)| number[i] = k);
        let order: Vec<usize> = self.order.iter().map(|&i| number[i]).collect();
        let triangle = lower_triangle(&matrix, grid.kit.shapes.degrees, &number);
        drop(matrix);
        SparseCholesky::factor(&triangle, &order, team.threads())
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
    let points = grid.kit.shapes.points;
    team.map(grid.layers(), |layer| {
        let reference = bricks.references[layer];
        let differs = |t: &PointTangent| {
            // Rounding of constants that are the same.
            let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b;
            !(same(t.bulk, reference.bulk) && same(t.all, reference.all) && t.along == 0.0)
        };
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

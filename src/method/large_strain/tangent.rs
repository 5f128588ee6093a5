//! Tangent stiffness of a body, and its linear systems.

use std::ops::Range;
use std::sync::OnceLock;

use faer::MatMut;
use faer::prelude::Solve;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};

use super::element::Element;
use super::load::LoadStiffness;
use super::lower::{Lower, elimination_order};
use super::pattern::{Line, Pattern};
use super::{Course, Courses, Deformable};
use crate::laws::solid::large_strain::{Deformed, LargeStrainLaw, Tangent};
use crate::math::cholesky::SparseCholesky;
use crate::math::matrix3::{Matrix3, contraction};
use crate::runtime::parallel::Team;
use crate::space::Shared;

/// Stiffness of a body under fixed conditions: its pattern is known before time starts.
pub struct Stiffness {
    /// Number of the unknown of each node and axis; `None` where displacements are prescribed.
    unknowns: Vec<[Option<usize>; 3]>,
    count: usize,
    /// Of the blocks and of the further ones of loads.
    pattern: Pattern,
    lower: Lower,
    /// Another factor costs more than some tens of solutions with one.
    pub(super) has_costly_factors: bool,
    lu: OnceLock<SymbolicLu<usize>>,
    blocks: Vec<Block>,
}

/// Nodes of a block over those of a group in it, at most, and most groups of a block.
const ALIKE: f64 = 1.2;
const MOST_GROUPS: usize = 32;
/// Blocks that are in memory at a time, each with what it is made of.
const MOST_TOGETHER: usize = 256;
/// Entries of blocks that are in memory at a time.
pub const TOGETHER: usize = 4_000_000;

/// Multiplications for an entry of a factor above which some tens of solutions cost less than another factor.
const COSTLY: f64 = 150.0;

/// Terms of the matrix of a linear system.
pub struct Terms<'a> {
    /// Stiffness of each group of points.
    pub of_group: &'a (dyn Fn(usize) -> GroupTangent + Sync),
    /// Multiple of the masses of the nodes [1/s²].
    pub inertia: f64,
    /// Stiffness of the loads on faces, of which the matrix has a block each.
    pub loads: &'a [LoadStiffness],
    pub is_symmetric: bool,
}

/// Derivatives of the stresses of the points of a group.
pub struct GroupTangent {
    /// `∂P/∂F` of each point at constant pressure of the dilatation.
    pub points: Vec<Tangent>,
    /// Changes of that pressure.
    pub swellings: Vec<Swelling>,
    /// Factor of all.
    pub scale: f64,
}

/// Stiffness `k Σ V δF : A_p Σ V B_p : dF` of a pressure that the points of a group share.
pub struct Swelling {
    pub stiffness: f64,
    /// A and B of each point.
    pub forces: Vec<Matrix3>,
    pub changes: Vec<Matrix3>,
}

/// Groups of points that are assembled together, and the nodes of their rows.
pub(super) struct Block {
    pub groups: Range<usize>,
    pub nodes: Vec<u32>,
    /// Unknowns of the nodes, axis by axis, which are the columns of the block's matrix.
    pub columns: Vec<Column>,
    /// The same as rows and columns of the pattern.
    lines: Vec<Line>,
}

/// An unknown of a block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    /// Its place among the axes of the block's nodes, node by node.
    pub place: usize,
    unknown: usize,
}

/// A factored stiffness.
pub enum Factor {
    Positive(SparseCholesky),
    /// Of a symmetric matrix that is not positive definite.
    Indefinite(Box<Lu<usize, f64>>),
    General(Box<Lu<usize, f64>>),
}

/// The matrix could not be factored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Singular;

impl Stiffness {
    /// Creates the pattern; `held` marks prescribed displacements, and `couplings` are the nodes of the blocks of
    /// loads.
    pub fn new(
        body: &Deformable,
        held: &[[bool; 3]],
        couplings: &[Vec<u32>],
    ) -> Result<Self, Singular> {
        let mut count = 0;
        let mut number = |is_held: bool| {
            (!is_held).then(|| {
                count += 1;
                count - 1
            })
        };
        let unknowns: Vec<[Option<usize>; 3]> =
            held.iter().map(|held| held.map(&mut number)).collect();
        let block = |(groups, nodes): (Range<usize>, Vec<u32>)| {
            let mut columns = columns(&unknowns, &nodes);
            columns.sort_by_key(|column| (column.place % 3, column.place));
            Block { groups, nodes, lines: lines(&columns), columns }
        };
        let blocks: Vec<Block> = assembled(body).into_iter().map(block).collect();
        let nodes_of_blocks = blocks.iter().map(|block| &block.nodes).chain(couplings);
        let nodes_of_blocks: Vec<&[u32]> = nodes_of_blocks.map(Vec::as_slice).collect();
        let pattern = Pattern::new(&unknowns, &nodes_of_blocks).ok_or(Singular)?;
        let order = elimination_order(&body.space.nodes, &unknowns, &pattern.entries);
        let lower = Lower::of(&pattern.entries, &order).map_err(|_| Singular)?;
        let mean = lower.multiplications_per_entry();
        let has_costly_factors = mean.is_some_and(|mean| mean > COSTLY);
        let lu = OnceLock::new();
        Ok(Self { unknowns, count, pattern, lower, has_costly_factors, lu, blocks })
    }

    /// Assembles and factors a matrix.
    ///
    /// # Panics
    /// If `terms` have not the loads of the pattern.
    pub fn factor(
        &self,
        body: &Deformable,
        terms: &Terms,
        team: &Team,
    ) -> Result<Factor, Singular> {
        self.factor_values(&self.matrix(body, terms, team), terms.is_symmetric, team)
    }

    /// Factors a matrix that is assembled.
    pub(super) fn factor_values(
        &self,
        matrix: &[f64],
        is_symmetric: bool,
        team: &Team,
    ) -> Result<Factor, Singular> {
        if !is_symmetric {
            return Ok(Factor::General(self.factor_general(matrix)?));
        }
        match self.lower.factor(matrix, team.threads()) {
            Ok(factor) => Ok(Factor::Positive(factor)),
            Err(_) => Ok(Factor::Indefinite(self.factor_general(matrix)?)),
        }
    }

    /// Returns true unless a symmetric matrix is positive definite.
    pub(super) fn is_indefinite_matrix(&self, matrix: &[f64], team: &Team) -> bool {
        self.lower.factor(matrix, team.threads()).is_err()
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.count
    }

    /// Assembles the values of all entries of a matrix.
    pub(super) fn matrix(&self, body: &Deformable, terms: &Terms, team: &Team) -> Vec<f64> {
        let loads = self.pattern.blocks() - self.blocks.len();
        assert_eq!(terms.loads.len(), loads, "loads of another pattern");
        let mut values = self.pattern.zeros();
        // Some blocks at a time, as all of them together are much larger than the matrix.
        let widest = self.blocks.iter().map(|block| block.columns.len()).max().unwrap_or(0);
        let together = (TOGETHER / widest.max(1).pow(2)).clamp(1, MOST_TOGETHER);
        let mut elements: Vec<Element> = (0..together).map(|_| Element::default()).collect();
        for first in (0..self.blocks.len()).step_by(together) {
            let elements = &mut elements[..together.min(self.blocks.len() - first)];
            team.for_each(elements, |n, element| {
                element.compute(body, terms.of_group, &self.blocks[first + n]);
            });
            for (n, element) in elements.iter().enumerate() {
                let Block { nodes, lines, .. } = &self.blocks[first + n];
                self.pattern.add(&mut values, (first + n, nodes.len()), lines, element.values());
            }
        }
        for (n, load) in terms.loads.iter().enumerate() {
            let columns = columns(&self.unknowns, &load.nodes);
            let width = 3 * load.nodes.len();
            let row = |row: &Column| {
                let of_row = &load.matrix[row.place * width..(row.place + 1) * width];
                columns.iter().map(|column| of_row[column.place]).collect::<Vec<_>>()
            };
            let matrix: Vec<f64> = columns.iter().flat_map(row).collect();
            let block = (self.blocks.len() + n, load.nodes.len());
            self.pattern.add(&mut values, block, &lines(&columns), &matrix);
        }
        for (unknowns, mass) in self.unknowns.iter().zip(&body.mass) {
            for &unknown in unknowns.iter().flatten() {
                self.pattern.add_to_diagonal(&mut values, unknown, terms.inertia * mass);
            }
        }
        values
    }

    /// `matrix x` of a symmetric matrix.
    pub(super) fn product(&self, matrix: &[f64], x: &[f64], out: &mut [f64], team: &Team) {
        let starts = self.pattern.entries.col_ptr();
        let rows = self.pattern.entries.row_idx();
        team.for_each(out, |column, sum| {
            let entries = starts[column]..starts[column + 1];
            let terms = rows[entries.clone()].iter().zip(&matrix[entries]);
            *sum = terms.map(|(&row, value)| value * x[row]).sum();
        });
    }

    /// Returns true unless a matrix is positive definite, with the symmetric part of its loads; the rest of it is
    /// symmetric.
    pub fn is_indefinite(&self, body: &Deformable, terms: &Terms, team: &Team) -> bool {
        let loads: Vec<_> = terms.loads.iter().map(LoadStiffness::symmetric_part).collect();
        self.is_indefinite_matrix(
            &self.matrix(body, &Terms { loads: &loads, ..*terms }, team),
            team,
        )
    }

    fn factor_general(&self, matrix: &[f64]) -> Result<Box<Lu<usize, f64>>, Singular> {
        let symbolic = match self.lu.get() {
            Some(symbolic) => symbolic.clone(),
            None => SymbolicLu::try_new(self.pattern.entries.as_ref()).map_err(|_| Singular)?,
        };
        // Another thread may have been first with the same.
        let _ = self.lu.set(symbolic.clone());
        let matrix = SparseColMatRef::new(self.pattern.entries.as_ref(), matrix);
        let lu = Lu::try_new_with_symbolic(symbolic, matrix).map_err(|_| Singular)?;
        Ok(Box::new(lu))
    }

    /// Solves for the change of displacements under forces on the nodes.
    pub fn solve(&self, factor: &Factor, forces: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut values = self.of_unknowns(forces);
        match factor {
            Factor::Positive(cholesky) => cholesky.solve_in_place(&mut values),
            Factor::Indefinite(lu) | Factor::General(lu) => {
                lu.solve_in_place(MatMut::from_column_major_slice_mut(&mut values, self.count, 1));
            }
        }
        self.of_nodes(&values)
    }

    /// The values of unknowns among those of nodes.
    pub(super) fn of_unknowns(&self, of_nodes: &[[f64; 3]]) -> Vec<f64> {
        let mut values = vec![0.0; self.count];
        for (unknowns, of_node) in self.unknowns.iter().zip(of_nodes) {
            for (unknown, value) in unknowns.iter().zip(of_node) {
                if let Some(n) = unknown {
                    values[*n] = *value;
                }
            }
        }
        values
    }

    /// The values of nodes: those of unknowns, and zero where displacements are prescribed.
    pub(super) fn of_nodes(&self, values: &[f64]) -> Vec<[f64; 3]> {
        let place = |unknown: Option<usize>| unknown.map_or(0.0, |n| values[n]);
        self.unknowns.iter().map(|unknowns| unknowns.map(place)).collect()
    }
}

/// A state about which a body is linearised.
pub struct Linearised<'a> {
    pub deformations: Vec<Deformed>,
    /// Dilatation that each group shares.
    pub dilatations: Vec<Shared>,
    /// History at the beginning of the step.
    pub before: &'a [f64],
    pub over: &'a Courses,
}

/// Groups that are assembled together, with their nodes. Those that follow each other and have about the same nodes, as
/// the points of a node do, are one block: most of the time goes into adding blocks to the matrix.
fn assembled(body: &Deformable) -> Vec<(Range<usize>, Vec<u32>)> {
    let mut blocks: Vec<(Range<usize>, Vec<u32>)> = Vec::new();
    for (group, points) in body.space.groups.iter().enumerate() {
        let nodes = body.nodes_of(points);
        if let Some((groups, own)) = blocks.last_mut() {
            let mut both = [&own[..], &nodes].concat();
            both.sort_unstable();
            both.dedup();
            let is_alike = both.len() as f64 <= ALIKE * nodes.len() as f64;
            if is_alike && groups.len() < MOST_GROUPS {
                (groups.end, *own) = (group + 1, both);
                continue;
            }
        }
        blocks.push((group..group + 1, nodes));
    }
    blocks
}

/// Unknowns of nodes.
fn columns(unknowns: &[[Option<usize>; 3]], nodes: &[u32]) -> Vec<Column> {
    let all = nodes.iter().flat_map(|&node| unknowns[node as usize]).enumerate();
    all.filter_map(|(place, unknown)| Some(Column { place, unknown: unknown? })).collect()
}

/// Rows and columns of a block.
fn lines(columns: &[Column]) -> Vec<Line> {
    columns.iter().map(|column| (column.place / 3, column.unknown)).collect()
}

impl Linearised<'_> {
    /// Changes of the internal forces on the nodes [N] for a change of displacements without flow.
    pub fn forces(&self, body: &Deformable, change: &[[f64; 3]], team: &Team) -> Vec<[f64; 3]> {
        let groups = &body.space.groups;
        let of_group = |group: usize| {
            let strain = |point: usize| {
                let mut strain = body.gradient(&body.space.volume, point, change);
                (0..3).for_each(|a| strain[a][a] -= 1.0);
                strain
            };
            let weights = &body.space.volume.weights[groups[group].clone()];
            let strains: Vec<Matrix3> = groups[group].clone().map(strain).collect();
            self.group_without_flow(body, group).loads(weights, &strains)
        };
        body.forces_of(&team.map(groups.len(), of_group).concat(), team)
    }

    /// Derivatives of the stresses of a group's points.
    pub fn group(&self, body: &Deformable, group: usize) -> GroupTangent {
        self.of_law(body, group, body.law_of(group))
    }

    /// The same if none of them yields.
    pub fn group_without_flow(&self, body: &Deformable, group: usize) -> GroupTangent {
        self.of_law(body, group, &body.law_of(group).without_flow())
    }

    fn of_law(&self, body: &Deformable, group: usize, law: &LargeStrainLaw) -> GroupTangent {
        let Course { time, stretch, .. } = self.over.at(body, group);
        let history = &self.before[body.history_of(group)];
        let pressure = body.pressure(group, law, &self.dilatations[group]);
        let length = law.history();
        let points = body.space.groups[group].clone();
        let deformed = &self.deformations[points];
        let of_point = |(place, at): (usize, &Deformed)| {
            let before = &history[length * place..length * (place + 1)];
            match body.is_sheet {
                true => law.condensed_tangent(at, time, before),
                false => law.tangent(at, time, before, pressure.at(place)),
            }
        };
        let cofactor =
            |at: &Deformed| at.inverse_transposed.map(|row| row.map(|g| at.dilatation * g));
        let swellings = || {
            let forces: Vec<Matrix3> = deformed.iter().map(cofactor).collect();
            body.swellings(group, (&pressure, 1.0), forces.clone(), forces)
        };
        GroupTangent {
            points: deformed.iter().enumerate().map(of_point).collect(),
            swellings: if body.is_sheet { Vec::new() } else { swellings() },
            scale: stretch,
        }
    }
}

impl GroupTangent {
    /// Volume times the change of P of each point [N m], of volumes and changes of F.
    fn loads(&self, weights: &[f64], strains: &[Matrix3]) -> Vec<Matrix3> {
        let pressures: Vec<f64> = self
            .swellings
            .iter()
            .map(|Swelling { stiffness, changes, .. }| {
                let all = weights.iter().zip(changes).zip(strains);
                stiffness * all.map(|((w, b), f)| w * contraction(b, f)).sum::<f64>()
            })
            .collect();
        let of_point = |(place, strain): (usize, &Matrix3)| -> Matrix3 {
            let mut load = [[0.0; 3]; 3];
            for (m, value) in load.as_flattened_mut().iter_mut().enumerate() {
                let row = self.points[place][m].iter().zip(strain.as_flattened());
                let own: f64 = row.map(|(t, f)| t * f).sum();
                let swellings = self.swellings.iter().zip(&pressures);
                let shared = swellings.map(|(s, p)| p * s.forces[place][m / 3][m % 3]);
                *value = self.scale * weights[place] * (own + shared.sum::<f64>());
            }
            load
        };
        strains.iter().enumerate().map(of_point).collect()
    }
}

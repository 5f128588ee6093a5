//! Numeric Cholesky factorisation by supernodes, on the threads of a team.
//!
//! A supernode is a run of columns of L with the same rows below their diagonal block, stored as a
//! dense panel. A panel starts with the matrix's own entries. Then the products of earlier panels
//! are subtracted, and the panel is factored by itself. Panels far apart in the elimination tree
//! are independent: small subtrees go to one thread each, and all threads work on the panels above
//! them. Both use the same tiles, whose sizes do not depend on the number of threads, so the factor
//! is the same to the bit.
//!
//! Source: E. G. Ng, B. W. Peyton 1993, *Block sparse Cholesky algorithms on advanced uniprocessor
//! computers*, doi 10.1137/0914063.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltParams, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, Auto, MatMut, MatRef, Par};

use crate::runtime::parallel::Team;

/// Rows and columns of a tile: a multiple of the block size of the product kernels.
const TILE: usize = 192;

/// Largest share of all work, over the number of threads, of a subtree that goes to one thread.
const SHARE: f64 = 1.0 / 8.0;

/// Error: a pivot is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotPositive;

/// The lower triangle of the permuted matrix by columns, rows in any order.
pub struct Columns {
    pub start: Vec<usize>,
    pub rows: Vec<u32>,
    pub values: Vec<f64>,
}

/// Computes the panels of L in `values`, which holds zeros before, in the order of `symbolic`.
pub fn factor(
    symbolic: &SymbolicSupernodalCholesky<usize>,
    matrix: &Columns,
    values: &mut [f64],
    team: &Team,
) -> Result<(), NotPositive> {
    let tree = Tree::of(symbolic, matrix);
    let split = tree.split(team.threads());
    let mut subtrees = split.subtrees(tree.panels(values));
    let results = team.map_each(&mut subtrees, |subtree| {
        let alone = Team::new(1);
        let mut places = vec![0; symbolic.nrows()];
        for k in 0..subtree.members.len() {
            let (done, rest) = subtree.panels.split_at_mut(k);
            let done = |member: usize| &*done[split.place[member]];
            tree.factor_panel(subtree.members[k], done, &mut *rest[0], &mut places, &alone)?;
        }
        Ok(())
    });
    drop(subtrees);
    results.into_iter().collect::<Result<(), NotPositive>>()?;

    let mut panels = tree.panels(values);
    let mut places = vec![0; symbolic.nrows()];
    for &top in &split.top {
        let (done, rest) = panels.split_at_mut(top);
        let done = |member: usize| &*done[member];
        tree.factor_panel(top, done, &mut *rest[0], &mut places, team)?;
    }
    Ok(())
}

/// Number of multiplications of a factorisation, about.
pub(super) fn multiplications(symbolic: &SymbolicSupernodalCholesky<usize>) -> f64 {
    let of_panel = |s: usize| {
        let node = symbolic.supernode(s);
        let width = symbolic.supernode_end()[s] - node.start();
        of_columns(width, width + node.pattern().len())
    };
    (0..symbolic.n_supernodes()).map(of_panel).sum()
}

/// Number of multiplications with the entries of a panel, about.
fn of_columns(width: usize, height: usize) -> f64 {
    (0..width).map(|k| ((height - k) as f64).powi(2)).sum()
}

/// Supernode of each column.
pub(super) fn owners(symbolic: &SymbolicSupernodalCholesky<usize>) -> Vec<usize> {
    let mut owner = vec![0; symbolic.nrows()];
    for s in 0..symbolic.n_supernodes() {
        owner[symbolic.supernode_begin()[s]..symbolic.supernode_end()[s]].fill(s);
    }
    owner
}

/// Parent of each supernode in the elimination tree: that of the first row below its diagonal block.
pub(super) fn parents(
    symbolic: &SymbolicSupernodalCholesky<usize>,
    owner: &[usize],
) -> Vec<Option<usize>> {
    let first = |s: usize| symbolic.supernode(s).pattern().first().copied();
    (0..symbolic.n_supernodes()).map(|s| first(s).map(|row| owner[row])).collect()
}

/// The supernodes and their updates.
struct Tree<'a> {
    symbolic: &'a SymbolicSupernodalCholesky<usize>,
    matrix: &'a Columns,
    /// For each supernode the updates from earlier ones, ascending.
    updates: Vec<Vec<Update>>,
    parent: Vec<Option<usize>>,
}

/// Update from a finished supernode to another.
struct Update {
    from: usize,
    /// Rows of the finished one that are columns of the other; these and all later ones contribute.
    shared: Range<usize>,
}

/// One supernode: its columns, and its rows below these.
struct Node<'a> {
    start: usize,
    width: usize,
    pattern: &'a [usize],
}

impl Node<'_> {
    fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    /// Matrix row of a panel row; beyond the last one, a number larger than all rows.
    fn row(&self, k: usize) -> usize {
        match k.checked_sub(self.width) {
            None => self.start + k,
            Some(k) => self.pattern.get(k).copied().unwrap_or(usize::MAX),
        }
    }

    fn panel<'v>(&self, values: &'v [f64]) -> MatRef<'v, f64> {
        MatRef::from_column_major_slice(values, self.height(), self.width)
    }
}

/// Partition of the supernodes: subtrees for one thread each, and the supernodes above them.
struct Split {
    /// Ascending.
    top: Vec<usize>,
    /// Subtree of each supernode, and its place there.
    subtree: Vec<Option<usize>>,
    place: Vec<usize>,
    count: usize,
}

struct Subtree<'v> {
    /// Ascending, with their panels.
    members: Vec<usize>,
    panels: Vec<&'v mut [f64]>,
}

impl Split {
    fn subtrees<'v>(&self, panels: Vec<&'v mut [f64]>) -> Vec<Subtree<'v>> {
        let empty = |_| Subtree { members: Vec::new(), panels: Vec::new() };
        let mut subtrees: Vec<Subtree> = (0..self.count).map(empty).collect();
        for (s, panel) in panels.into_iter().enumerate() {
            if let Some(subtree) = self.subtree[s] {
                subtrees[subtree].members.push(s);
                subtrees[subtree].panels.push(panel);
            }
        }
        subtrees
    }
}

impl<'a> Tree<'a> {
    fn of(symbolic: &'a SymbolicSupernodalCholesky<usize>, matrix: &'a Columns) -> Self {
        let count = symbolic.n_supernodes();
        let owner = owners(symbolic);
        let parent = parents(symbolic, &owner);
        let mut updates: Vec<Vec<Update>> = (0..count).map(|_| Vec::new()).collect();
        for from in 0..count {
            let pattern = symbolic.supernode(from).pattern();
            let mut first = 0;
            for shared in pattern.chunk_by(|&a, &b| owner[a] == owner[b]) {
                let shared = (first..first + shared.len(), owner[shared[0]]);
                first = shared.0.end;
                updates[shared.1].push(Update { from, shared: shared.0 });
            }
        }
        Self { symbolic, matrix, updates, parent }
    }

    fn node(&self, s: usize) -> Node<'a> {
        let node = self.symbolic.supernode(s);
        let width = self.symbolic.supernode_end()[s] - node.start();
        Node { start: node.start(), width, pattern: node.pattern() }
    }

    fn panels<'v>(&self, mut values: &'v mut [f64]) -> Vec<&'v mut [f64]> {
        let sizes = self.symbolic.col_ptr_for_val().windows(2).map(|ends| ends[1] - ends[0]);
        sizes.map(|size| values.split_off_mut(..size).expect("room for all panels")).collect()
    }

    /// Partitions the supernodes by their operation counts.
    fn split(&self, threads: usize) -> Split {
        let count = self.parent.len();
        let mut work: Vec<f64> = (0..count)
            .map(|s| {
                let node = self.node(s);
                of_columns(node.width, node.height())
            })
            .collect();
        let all: f64 = work.iter().sum();
        for s in 0..count {
            if let Some(parent) = self.parent[s] {
                work[parent] += work[s];
            }
        }
        let most = if threads > 1 { all * SHARE / threads as f64 } else { 0.0 };
        let mut split =
            Split { top: Vec::new(), subtree: vec![None; count], place: vec![0; count], count: 0 };
        for s in (0..count).rev() {
            split.subtree[s] = match self.parent[s].and_then(|parent| split.subtree[parent]) {
                None if work[s] > most => continue,
                None => {
                    split.count += 1;
                    Some(split.count - 1)
                }
                subtree => subtree,
            };
        }
        let mut sizes = vec![0; split.count];
        for s in 0..count {
            match split.subtree[s] {
                None => split.top.push(s),
                Some(subtree) => {
                    split.place[s] = sizes[subtree];
                    sizes[subtree] += 1;
                }
            }
        }
        split
    }

    /// Computes one panel from the finished ones, which `done` returns. `places` is scratch: the
    /// positions of the matrix rows in this panel.
    fn factor_panel<'v>(
        &self,
        s: usize,
        done: impl Fn(usize) -> &'v [f64] + Sync,
        panel: &mut [f64],
        places: &mut [u32],
        team: &Team,
    ) -> Result<(), NotPositive> {
        let node = self.node(s);
        let (width, height) = (node.width, node.height());
        for k in 0..height {
            places[node.row(k)] = k as u32;
        }
        let places = &*places;
        for (k, column) in panel.chunks_exact_mut(height).enumerate() {
            let [first, last] = [0, 1].map(|c| self.matrix.start[node.start + k + c]);
            let entries = self.matrix.rows[first..last].iter().zip(&self.matrix.values[first..]);
            entries.for_each(|(&row, value)| column[places[row as usize] as usize] += value);
        }
        for first in (0..width).step_by(TILE) {
            let columns = first..width.min(first + TILE);
            let panel = MatMut::from_column_major_slice_mut(panel, height, width);
            let (left, right) = panel.split_at_col_mut(first);
            let left = left.as_ref();
            let mut block = right.subcols_mut(0, columns.len()).subrows_mut(first, height - first);
            team.for_each(&mut tiles(block.as_mut()), |t, tile| {
                let rows = first + t * TILE..first + t * TILE + tile.nrows();
                self.update(s, &done, [rows.clone(), columns.clone()], places, tile.as_mut());
                let (left_rows, left_columns) =
                    (left.subrows(rows.start, rows.len()), left.subrows(first, columns.len()));
                if first > 0 {
                    subtract(tile.as_mut(), left_rows, left_columns);
                }
            });
            let (mut diagonal, below) = block.split_at_row_mut(columns.len());
            factor_diagonal(diagonal.as_mut())?;
            let diagonal = diagonal.as_ref();
            team.for_each(&mut tiles(below), |_, tile| {
                solve_lower_triangular_in_place(diagonal, tile.as_mut().transpose_mut(), Par::Seq);
            });
        }
        Ok(())
    }

    /// Subtracts the contributions of the finished panels from one tile of the panel of `s`, with
    /// these rows and columns of it.
    fn update<'v>(
        &self,
        s: usize,
        done: impl Fn(usize) -> &'v [f64],
        [rows, columns]: [Range<usize>; 2],
        places: &[u32],
        mut tile: MatMut<'_, f64>,
    ) {
        let node = self.node(s);
        let [rows_from, rows_to] = [node.row(rows.start), node.row(rows.end)];
        let [columns_from, columns_to] = [columns.start, columns.end].map(|k| node.start + k);
        let mut room = Vec::new();
        for Update { from, shared } in &self.updates[s] {
            let source = self.node(*from);
            let pattern = source.pattern;
            let up_to = |row: usize, within: Range<usize>| {
                within.start + pattern[within].partition_point(|&r| r < row)
            };
            let columns_first = up_to(columns_from, shared.clone());
            let columns_last = up_to(columns_to, columns_first..shared.end);
            if columns_first == columns_last {
                continue;
            }
            let rows_first = up_to(rows_from, columns_first..pattern.len());
            let rows_last = up_to(rows_to, rows_first..pattern.len());
            let (m, n) = (rows_last - rows_first, columns_last - columns_first);
            if m == 0 {
                continue;
            }
            let panel = source.panel(done(*from));
            let left = panel.subrows(source.width + rows_first, m);
            let right = panel.subrows(source.width + columns_first, n);
            let place = |k: usize| places[pattern[k]] as usize;
            let [i, j] = [place(rows_first) - rows.start, place(columns_first) - columns.start];
            let is_contiguous =
                |first: usize, last: usize| place(last - 1) - place(first) == last - 1 - first;
            if is_contiguous(rows_first, rows_last) && is_contiguous(columns_first, columns_last) {
                subtract(tile.as_mut().submatrix_mut(i, j, m, n), left, right);
                continue;
            }
            room.resize(m * n, 0.0);
            let product = MatMut::from_column_major_slice_mut(&mut room, m, n);
            matmul(product, Accum::Replace, left, right.transpose(), 1.0, Par::Seq);
            for (k, product) in room.chunks_exact(m).enumerate() {
                let column = tile.as_mut().col_mut(place(columns_first + k) - columns.start);
                let column = column.try_as_col_major_mut().expect("panels are column-major");
                let column = column.as_slice_mut();
                for (row, value) in pattern[rows_first..rows_last].iter().zip(product) {
                    column[places[*row] as usize - rows.start] -= value;
                }
            }
        }
    }
}

/// Tiles of all columns and [`TILE`] rows each; the last one holds the rest.
fn tiles(mut block: MatMut<'_, f64>) -> Vec<MatMut<'_, f64>> {
    let mut tiles = Vec::with_capacity(block.nrows().div_ceil(TILE));
    while block.nrows() > 0 {
        let rows = block.nrows().min(TILE);
        let (tile, rest) = block.split_at_row_mut(rows);
        tiles.push(tile);
        block = rest;
    }
    tiles
}

/// `target −= left rightᵀ`.
fn subtract(target: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>) {
    matmul(target, Accum::Add, left, right.transpose(), -1.0, Par::Seq);
}

fn factor_diagonal(block: MatMut<'_, f64>) -> Result<(), NotPositive> {
    let parameters: LltParams = Auto::<f64>::auto();
    let scratch = cholesky_in_place_scratch::<f64>(block.nrows(), Par::Seq, parameters.into());
    let mut buffer = MemBuffer::new(scratch);
    let regularization = LltRegularization::default();
    let stack = MemStack::new(&mut buffer);
    let result = cholesky_in_place(block, regularization, Par::Seq, stack, parameters.into());
    result.map(|_| ()).map_err(|_| NotPositive)
}

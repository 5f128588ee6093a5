//! Sparse Cholesky factorisation of a symmetric positive definite matrix: its pattern
//! by faer, its numbers by supernodes.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::conjugate_gradients::NotConverged;
use super::panel_solve::Partition;
use super::supernodes::{self, Columns};
use crate::runtime::address_space::TooLittle;
use crate::runtime::parallel::Team;

/// Entries that a thread processes as one piece.
const PIECE: usize = 1 << 16;

/// Lower triangle of a symmetric matrix by columns, rows ascending, diagonal first.
#[derive(Debug, Clone, Default)]
pub struct LowerTriangle {
    pub column_start: Vec<usize>,
    pub rows: Vec<usize>,
    pub values: Vec<f64>,
}

/// The factorisation `P A Pᵀ = L Lᵀ`, reusable for any number of right-hand sides.
pub struct SparseCholesky {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
}

/// The pattern of the factors of all matrices with one pattern.
pub struct Elimination {
    symbolic: Arc<SymbolicCholesky<usize>>,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolverError {
    #[error("the matrix of {unknowns} unknowns is not positive definite")]
    NotPositiveDefinite { unknowns: usize },
    #[error("the factorisation of {unknowns} unknowns does not fit into memory")]
    OutOfMemory { unknowns: usize },
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
    #[error(transparent)]
    AddressSpace(#[from] TooLittle),
}

impl SparseCholesky {
    /// Factors `matrix`, eliminating unknowns in the given order (`order[k]` is eliminated k-th).
    ///
    /// The factor is the same to the bit on any number of threads.
    pub fn factor(
        matrix: &LowerTriangle,
        order: &[usize],
        threads: usize,
    ) -> Result<Self, SolverError> {
        Elimination::new(matrix, order)?.factor(matrix, threads)
    }

    /// Replaces `b` by the solution of `A x = b`; `b` may hold several columns, one after another.
    pub fn solve_in_place(&self, b: &mut [f64]) {
        let unknowns = self.symbolic.nrows();
        if unknowns == 0 {
            return;
        }
        let columns = b.len() / unknowns;
        let need = self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut buffer = MemBuffer::new(need);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(b, unknowns, columns),
            Par::Seq,
            MemStack::new(&mut buffer),
        );
    }

    /// Returns the factor in single precision, which is enough for a preconditioner and needs half of the memory.
    pub fn rounded(&self, team: &Team) -> RoundedCholesky {
        let pieces: Vec<&[f64]> = self.values.chunks(PIECE).collect();
        let largest = team.map(pieces.len(), |piece| largest(pieces[piece]));
        let scale = largest.into_iter().fold(0.0, f64::max);
        let values = team.map(self.values.len(), |entry| (self.values[entry] / scale) as f32);
        let partition = match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(panels) => Some(Partition::of(panels)),
            SymbolicCholeskyRaw::Simplicial(_) => None,
        };
        RoundedCholesky { symbolic: Arc::clone(&self.symbolic), partition, scale, values }
    }

    /// Number of stored entries of L.
    pub fn entries(&self) -> usize {
        self.values.len()
    }
}

/// Largest size of some numbers.
fn largest(numbers: &[f64]) -> f64 {
    let larger = |most: f64, size: f64| if size > most { size } else { most };
    let (blocks, rest) = numbers.as_chunks::<8>();
    let mut most = [0.0; 8];
    for block in blocks {
        for (most, number) in most.iter_mut().zip(block) {
            *most = larger(*most, number.abs());
        }
    }
    most.into_iter().chain(rest.iter().map(|number| number.abs())).fold(0.0, larger)
}

/// A factorisation in single precision, for preconditioners.
pub struct RoundedCholesky {
    symbolic: Arc<SymbolicCholesky<usize>>,
    /// Of the panels, if there are any.
    partition: Option<Partition>,
    /// Largest entry of L, relative to which the others are stored.
    scale: f64,
    values: Vec<f32>,
}

impl RoundedCholesky {
    /// Replaces `b` by the solution of `A x = b` in single precision, of one right-hand side of any size.
    ///
    /// The solution is the same to the bit on any number of threads.
    pub fn solve_in_place(&self, b: &mut [f64], team: &Team) {
        let size = b.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        if size == 0.0 {
            return;
        }
        let back = size / self.scale / self.scale;
        match (self.symbolic.raw(), &self.partition) {
            (SymbolicCholeskyRaw::Supernodal(panels), Some(partition)) => {
                let order = self.symbolic.perm().map(|order| order.arrays());
                let mut ordered = vec![0.0; b.len()];
                let right = &*b;
                team.for_each(&mut ordered, |k, value| {
                    *value = (right[order.map_or(k, |(order, _)| order[k])] / size) as f32;
                });
                partition.solve(panels, &self.values, &mut ordered, team);
                team.for_each(b, |i, value| {
                    *value = back * f64::from(ordered[order.map_or(i, |(_, place)| place[i])]);
                });
            }
            _ => {
                let mut rounded: Vec<f32> = b.iter().map(|value| (value / size) as f32).collect();
                let need = self.symbolic.solve_in_place_scratch::<f32>(1, Par::Seq);
                let mut buffer = MemBuffer::new(need);
                LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    MatMut::from_column_major_slice_mut(&mut rounded, b.len(), 1),
                    Par::Seq,
                    MemStack::new(&mut buffer),
                );
                b.iter_mut().zip(rounded).for_each(|(x, own)| *x = back * f64::from(own));
            }
        }
    }
}

impl Elimination {
    /// Finds the pattern of the factor of `matrix`, eliminating unknowns in the given order.
    pub fn new(matrix: &LowerTriangle, order: &[usize]) -> Result<Self, SolverError> {
        let unknowns = order.len();
        let mut place = vec![0; unknowns];
        for (k, &i) in order.iter().enumerate() {
            place[i] = k;
        }
        let permutation = PermRef::new_checked(order, &place, unknowns);
        let symbolic = factorize_symbolic_cholesky(
            matrix.pattern(),
            Side::Lower,
            SymmetricOrdering::Custom(permutation),
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| SolverError::OutOfMemory { unknowns })?;
        Ok(Self { symbolic: Arc::new(symbolic) })
    }

    /// Number of entries of the factors.
    pub fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Mean number of multiplications for an entry of the factors; `None` if these have no panels of useful size.
    pub fn multiplications_per_entry(&self) -> Option<f64> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(panels) => {
                Some(supernodes::multiplications(panels) / self.entries() as f64)
            }
            SymbolicCholeskyRaw::Simplicial(_) => None,
        }
    }

    /// Factors a matrix of the same pattern.
    pub fn factor(
        &self,
        matrix: &LowerTriangle,
        threads: usize,
    ) -> Result<SparseCholesky, SolverError> {
        let symbolic = &self.symbolic;
        let unknowns = symbolic.nrows();
        let too_large = SolverError::OutOfMemory { unknowns };
        let mut values = Vec::new();
        values.try_reserve_exact(symbolic.len_val()).map_err(|_| too_large.clone())?;
        values.resize(symbolic.len_val(), 0.0);
        let is_definite = match symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(panels) => {
                let columns = permuted(matrix, symbolic);
                supernodes::factor(panels, &columns, &mut values, &Team::new(threads)).is_ok()
            }
            // So sparse a factor has no panels of useful size.
            SymbolicCholeskyRaw::Simplicial(_) => {
                let matrix = SparseColMatRef::new(matrix.pattern(), &matrix.values);
                let need =
                    symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
                let mut buffer = MemBuffer::try_new(need).map_err(|_| too_large)?;
                let stack = MemStack::new(&mut buffer);
                symbolic
                    .factorize_numeric_llt(
                        &mut values,
                        matrix,
                        Side::Lower,
                        Default::default(),
                        Par::Seq,
                        stack,
                        Default::default(),
                    )
                    .is_ok()
            }
        };
        if !is_definite {
            return Err(SolverError::NotPositiveDefinite { unknowns });
        }
        Ok(SparseCholesky { symbolic: Arc::clone(symbolic), values })
    }
}

impl LowerTriangle {
    fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let unknowns = self.column_start.len().saturating_sub(1);
        SymbolicSparseColMatRef::new_checked(
            unknowns,
            unknowns,
            &self.column_start,
            None,
            &self.rows,
        )
    }
}

/// The lower triangle of `P A Pᵀ`.
fn permuted(matrix: &LowerTriangle, symbolic: &SymbolicCholesky<usize>) -> Columns {
    let unknowns = symbolic.nrows();
    let place = symbolic.perm().map(|order| order.arrays().1);
    let place = |i: usize| place.map_or(i, |place| place[i]);
    let mut start = vec![0; unknowns + 1];
    let for_each_entry = |visit: &mut dyn FnMut(usize, usize, f64)| {
        for (j, ends) in matrix.column_start.windows(2).enumerate() {
            for k in ends[0]..ends[1] {
                let (row, column) = (place(matrix.rows[k]), place(j));
                visit(row.max(column), row.min(column), matrix.values[k]);
            }
        }
    };
    for_each_entry(&mut |_, column, _| start[column + 1] += 1);
    for column in 0..unknowns {
        start[column + 1] += start[column];
    }
    let (mut rows, mut values) = (vec![0; matrix.rows.len()], vec![0.0; matrix.rows.len()]);
    let mut next = start.clone();
    for_each_entry(&mut |row, column, value| {
        (rows[next[column]], values[next[column]]) = (row as u32, value);
        next[column] += 1;
    });
    Columns { start, rows, values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_the_second_difference_in_any_order() {
        let n = 7;
        let mut matrix = LowerTriangle::default();
        for j in 0..n {
            matrix.column_start.push(matrix.rows.len());
            matrix.rows.push(j);
            matrix.values.push(2.0);
            if j + 1 < n {
                matrix.rows.push(j + 1);
                matrix.values.push(-1.0);
            }
        }
        matrix.column_start.push(matrix.rows.len());
        let factor = SparseCholesky::factor(&matrix, &[0, 2, 4, 6, 1, 5, 3], 1).unwrap();
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let at = |i: isize| exact.get(i as usize).copied().unwrap_or(0.0);
        let mut b: Vec<f64> =
            (0..n as isize).map(|i| 2.0 * at(i) - at(i - 1) - at(i + 1)).collect();
        factor.solve_in_place(&mut b);
        for (x, e) in b.iter().zip(&exact) {
            assert!((x - e).abs() < 1e-14);
        }
    }

    /// Second differences on a cube of nodes that all couple within a cell.
    fn cube(n: usize) -> LowerTriangle {
        let mut matrix = LowerTriangle { column_start: vec![0], ..Default::default() };
        let around = |i: usize| i.saturating_sub(1)..(i + 2).min(n);
        for node in 0..n * n * n {
            let (i, j, k) = (node % n, node / n % n, node / (n * n));
            for c in around(k) {
                for b in around(j) {
                    for a in around(i) {
                        let other = a + n * (b + n * c);
                        if other >= node {
                            matrix.rows.push(other);
                            matrix.values.push(if other == node { 27.0 } else { -1.0 });
                        }
                    }
                }
            }
            matrix.column_start.push(matrix.rows.len());
        }
        matrix
    }

    #[test]
    fn solution_is_bit_identical_for_any_number_of_threads() {
        let n = 24;
        let matrix = cube(n);
        let order = crate::math::nested_dissection::nested_dissection([n - 1; 3], 1);
        let solve = |threads| {
            let mut b: Vec<f64> = (0..n * n * n).map(|i| (i as f64).sin()).collect();
            SparseCholesky::factor(&matrix, &order, threads).unwrap().solve_in_place(&mut b);
            b
        };
        let sequential = solve(1);
        for threads in [2, 3, 7] {
            assert!(sequential == solve(threads), "{threads} threads");
        }
    }

    #[test]
    fn rounded_factor_solves_to_single_precision() {
        let n = 24;
        let matrix = cube(n);
        let order = crate::math::nested_dissection::nested_dissection([n - 1; 3], 1);
        let factor = SparseCholesky::factor(&matrix, &order, 1).unwrap();
        assert!(matches!(factor.symbolic.raw(), SymbolicCholeskyRaw::Supernodal(_)));
        let load: Vec<f64> = (0..n * n * n).map(|i| 1e9 * (i as f64).sin()).collect();
        let (mut exact, mut rounded) = (load.clone(), load);
        factor.solve_in_place(&mut exact);
        factor.rounded(&Team::new(1)).solve_in_place(&mut rounded, &Team::new(1));
        let size = exact.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (rounded, exact) in rounded.iter().zip(&exact) {
            assert!((rounded - exact).abs() < 1e-5 * size, "{rounded} {exact}");
        }
    }

    #[test]
    fn rounded_solution_is_bit_identical_for_any_number_of_threads() {
        for n in [2, 9, 24] {
            let order = crate::math::nested_dissection::nested_dissection([n - 1; 3], 1);
            let factor = SparseCholesky::factor(&cube(n), &order, 1).unwrap();
            let factor = factor.rounded(&Team::new(1));
            let solve = |threads| {
                let mut b: Vec<f64> = (0..n * n * n).map(|i| (i as f64).sin()).collect();
                factor.solve_in_place(&mut b, &Team::new(threads));
                b
            };
            let sequential = solve(1);
            for threads in [2, 5] {
                assert!(sequential == solve(threads), "{n}, {threads} threads");
            }
        }
    }

    #[test]
    fn refuses_an_indefinite_matrix() {
        let matrix = LowerTriangle { column_start: vec![0, 1], rows: vec![0], values: vec![-1.0] };
        assert!(SparseCholesky::factor(&matrix, &[0], 1).is_err());
    }
}

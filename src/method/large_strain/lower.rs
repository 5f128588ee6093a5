//! Factors of symmetric stiffness, of its lower triangle.

use faer::sparse::SymbolicSparseColMat;

use crate::math::cholesky::{Elimination, LowerTriangle, SolverError, SparseCholesky};
use crate::math::geometric_dissection::geometric_dissection;

/// The lower triangle of a pattern, of which symmetric matrices are factored.
pub struct Lower {
    /// Without values.
    triangle: LowerTriangle,
    /// Places of its entries among those of the pattern.
    entries: Vec<usize>,
    elimination: Elimination,
}

impl Lower {
    /// The pattern of a matrix that is symmetric, and the order in which its unknowns are eliminated.
    pub fn of(pattern: &SymbolicSparseColMat<usize>, order: &[usize]) -> Result<Self, SolverError> {
        let (mut triangle, mut entries) = (LowerTriangle::default(), Vec::new());
        for column in 0..pattern.ncols() {
            triangle.column_start.push(entries.len());
            let of_column = pattern.col_range(column).filter(|&n| pattern.row_idx()[n] >= column);
            entries.extend(of_column);
        }
        triangle.column_start.push(entries.len());
        triangle.rows = entries.iter().map(|&n| pattern.row_idx()[n]).collect();
        let elimination = Elimination::new(&triangle, order)?;
        Ok(Self { triangle, entries, elimination })
    }

    /// Mean number of multiplications for an entry of a factor; `None` if that has no panels.
    pub fn multiplications_per_entry(&self) -> Option<f64> {
        self.elimination.multiplications_per_entry()
    }

    /// Factors a matrix of that pattern, of which all entries have values; fails if it is not positive definite.
    pub fn factor(&self, values: &[f64], threads: usize) -> Result<SparseCholesky, SolverError> {
        let values = self.entries.iter().map(|&n| values[n]).collect();
        self.elimination.factor(&LowerTriangle { values, ..self.triangle.clone() }, threads)
    }
}

/// Order in which unknowns are eliminated: those of a node together, the nodes by dissection in space.
pub fn elimination_order(
    places: &[[f64; 3]],
    unknowns: &[[Option<usize>; 3]],
    pattern: &SymbolicSparseColMat<usize>,
) -> Vec<usize> {
    let of_nodes = places.iter().zip(unknowns).filter(|(_, own)| own.iter().any(Option::is_some));
    let (places, unknowns): (Vec<[f64; 3]>, Vec<_>) =
        of_nodes.map(|(at, own)| (*at, own.iter().flatten().copied().collect::<Vec<_>>())).unzip();
    let mut node_of = vec![0; pattern.ncols()];
    for (node, own) in unknowns.iter().enumerate() {
        own.iter().for_each(|&n| node_of[n] = node as u32);
    }
    // All unknowns of a node have entries with the same nodes, whose unknowns are consecutive.
    let neighbours = |own: &Vec<usize>| {
        let rows = &pattern.row_idx()[pattern.col_range(own[0])];
        let mut nodes: Vec<u32> = rows.iter().map(|&row| node_of[row]).collect();
        nodes.dedup();
        nodes
    };
    let neighbours: Vec<Vec<u32>> = unknowns.iter().map(neighbours).collect();
    let order = geometric_dissection(&places, &neighbours);
    order.into_iter().flat_map(|node| unknowns[node].iter().copied()).collect()
}

//! Sparse matrices by compressed rows.

use super::parallel;

/// A square matrix by rows; columns ascend in every row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SparseRows {
    /// Start of each row's entries, and their end.
    start: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl SparseRows {
    /// A matrix from the entries `(column, value)` of each row; entries of one column add up.
    pub fn from_rows(rows: Vec<Vec<(usize, f64)>>) -> Self {
        let mut out = Self { start: vec![0], ..Default::default() };
        for mut row in rows {
            row.sort_by_key(|&(column, _)| column);
            for (column, value) in row {
                let own = out.columns.len() > out.start[out.start.len() - 1];
                match (own, out.columns.last(), out.values.last_mut()) {
                    (true, Some(&last), Some(sum)) if last as usize == column => *sum += value,
                    _ => {
                        out.columns.push(column as u32);
                        out.values.push(value);
                    }
                }
            }
            out.start.push(out.columns.len());
        }
        out
    }

    pub fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// `(A x)_row`.
    pub fn row_product(&self, row: usize, x: &[f64]) -> f64 {
        let range = self.start[row]..self.start[row + 1];
        let entries = self.columns[range.clone()].iter().zip(&self.values[range]);
        entries.map(|(&column, value)| value * x[column as usize]).sum()
    }

    /// `A x`, in equal shares on at most `threads` threads.
    pub fn multiply(&self, threads: usize, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.rows()];
        parallel::for_each(threads, &mut out, |row, value| *value = self.row_product(row, x));
        out
    }

    /// `max_i Σ_j |a_ij|`, within which all eigenvalues lie.
    ///
    /// Source: S. Gerschgorin (1931), Izv. Akad. Nauk SSSR 6, 749–754.
    pub fn spectral_bound(&self) -> f64 {
        let sum = |row: &[usize]| self.values[row[0]..row[1]].iter().map(|v| v.abs()).sum();
        self.start.windows(2).map(sum).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_multiply_and_repeated_columns_add_up() {
        let rows = vec![vec![(2, 1.5), (0, 2.0), (2, 0.5)], vec![], vec![(1, -3.0)]];
        let matrix = SparseRows::from_rows(rows);
        assert_eq!((matrix.rows(), matrix.entries()), (3, 3));
        for threads in [1, 2, 7] {
            assert_eq!(matrix.multiply(threads, &[1.0, 10.0, 100.0]), [202.0, 0.0, -30.0]);
        }
        assert_eq!(matrix.spectral_bound(), 4.0);
    }
}

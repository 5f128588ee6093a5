//! Sparse matrices in compressed rows.

/// A square matrix by rows; columns ascend in every row.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseRows {
    /// Start of each row's entries, and their end.
    start: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Default for SparseRows {
    fn default() -> Self {
        Self { start: vec![0], columns: Vec::new(), values: Vec::new() }
    }
}

impl SparseRows {
    /// Adds a row of entries `(column, value)`; entries of one column add up.
    pub fn push(&mut self, mut entries: Vec<(usize, f64)>) {
        let first = self.columns.len();
        entries.sort_by_key(|&(column, _)| column);
        for (column, value) in entries {
            match self.columns[first..].last() {
                Some(&last) if last as usize == column => {
                    *self.values.last_mut().expect("as many values as columns") += value;
                }
                _ => {
                    self.columns.push(column as u32);
                    self.values.push(value);
                }
            }
        }
        self.start.push(self.columns.len());
    }

    /// Adds to an entry that is already stored.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let range = self.start[row]..self.start[row + 1];
        let place = self.columns[range.clone()].binary_search(&(column as u32));
        self.values[range.start + place.expect("the entry is stored")] += value;
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
        let mut matrix = SparseRows::default();
        for row in [vec![(2, 1.5), (0, 2.0), (2, 0.5)], vec![], vec![(0, 7.0), (1, -3.0)]] {
            matrix.push(row);
        }
        matrix.add(2, 0, -6.0);
        assert_eq!((matrix.rows(), matrix.entries()), (3, 4));
        let product = [0, 1, 2].map(|row| matrix.row_product(row, &[1.0, 10.0, 100.0]));
        assert_eq!(product, [202.0, 0.0, -29.0]);
        assert_eq!(matrix.spectral_bound(), 4.0);
    }
}

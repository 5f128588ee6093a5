//! Entries of a sparse matrix that is the sum of dense blocks.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};

/// The entries of a matrix with a full diagonal, and the place of each entry of its blocks among them.
pub struct Pattern {
    pub entries: SymbolicSparseColMat<usize>,
    /// Places of the entries of each block, row by row.
    of_blocks: Vec<Vec<u32>>,
    diagonal: Vec<u32>,
}

impl Pattern {
    /// `blocks` are the unknowns of each block; `None` if there are too many entries.
    pub fn new(count: usize, blocks: &[Vec<usize>]) -> Option<Self> {
        let mut blocks_of = vec![Vec::new(); count];
        for (n, unknowns) in blocks.iter().enumerate() {
            for (place, &column) in unknowns.iter().enumerate() {
                blocks_of[column].push((n, place));
            }
        }
        let mut of_blocks: Vec<Vec<u32>> =
            blocks.iter().map(|unknowns| vec![0; unknowns.len().pow(2)]).collect();
        let (mut starts, mut rows, mut diagonal) = (vec![0], Vec::new(), Vec::new());
        // The column that has last met a row, and the place of that entry.
        let mut met = vec![usize::MAX; count];
        let mut places = vec![0_u32; count];
        for (column, own) in blocks_of.iter().enumerate() {
            let first = rows.len();
            let of_own = own.iter().flat_map(|&(n, _)| blocks[n].iter().copied());
            for row in std::iter::once(column).chain(of_own) {
                if met[row] != column {
                    met[row] = column;
                    rows.push(row);
                }
            }
            rows[first..].sort_unstable();
            for (place, &row) in rows.iter().enumerate().skip(first) {
                places[row] = u32::try_from(place).ok()?;
            }
            diagonal.push(places[column]);
            for &(n, place) in own {
                let unknowns = &blocks[n];
                for (row, unknown) in unknowns.iter().enumerate() {
                    of_blocks[n][row * unknowns.len() + place] = places[*unknown];
                }
            }
            starts.push(rows.len());
        }
        let entries = SymbolicSparseColMat::new_checked(count, count, starts, None, rows);
        Some(Self { entries, of_blocks, diagonal })
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.of_blocks.len()
    }

    /// Values of all entries, none of which has been added.
    pub fn zeros(&self) -> Vec<f64> {
        vec![0.0; self.entries.row_idx().len()]
    }

    /// Adds the entries of a block, row by row.
    pub fn add(&self, values: &mut [f64], block: usize, matrix: &[f64]) {
        for (place, entry) in self.of_blocks[block].iter().zip(matrix) {
            values[*place as usize] += entry;
        }
    }

    pub fn add_to_diagonal(&self, values: &mut [f64], unknown: usize, value: f64) {
        values[self.diagonal[unknown] as usize] += value;
    }

    pub fn with(&self, values: Vec<f64>) -> SparseColMat<usize, f64> {
        SparseColMat::new(self.entries.clone(), values)
    }
}

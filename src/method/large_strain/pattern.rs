//! Entries of a sparse matrix that is the sum of dense blocks of nodes.
//!
//! Unknowns of a node follow each other, and all have the same rows. So the place of an entry is that of the first row
//! of its node in the column, the same for all columns of a node, and the number of the unknown within its node: a block
//! keeps a number for each pair of its nodes, not for each entry.

use faer::sparse::SymbolicSparseColMat;

/// Numbers of the unknowns of nodes, ascending along the nodes and their axes; `None` where displacements are prescribed.
pub type Unknowns = [[Option<usize>; 3]];

/// The entries of a matrix with a full diagonal, and the places of its blocks among them.
pub struct Pattern {
    pub entries: SymbolicSparseColMat<usize>,
    /// For each block, pair by pair of its nodes, the place of the first row of one in a column of the other.
    of_blocks: Vec<Vec<u32>>,
    /// Number of each unknown within its node.
    ranks: Vec<u8>,
    diagonal: Vec<u32>,
}

/// Row or column of the matrix of a block: the place of its node among those of the block, and its unknown.
pub type Line = (usize, usize);

impl Pattern {
    /// `blocks` are the nodes of each block; `None` if there are too many entries.
    pub fn new(unknowns: &Unknowns, blocks: &[&[u32]]) -> Option<Self> {
        let free = |node: usize| unknowns[node].iter().flatten().count() as u32;
        let mut blocks_of = vec![Vec::new(); unknowns.len()];
        for (n, nodes) in blocks.iter().enumerate() {
            for (place, &node) in nodes.iter().enumerate() {
                blocks_of[node as usize].push((n, place));
            }
        }
        let mut of_blocks: Vec<Vec<u32>> =
            blocks.iter().map(|nodes| vec![0; nodes.len().pow(2)]).collect();
        let (mut starts, mut rows, mut diagonal) = (vec![0], Vec::new(), Vec::new());
        let mut ranks = Vec::new();
        // The node that has last met another one, and the place of that one's first row in its columns.
        let mut met = vec![usize::MAX; unknowns.len()];
        let mut places = vec![0_u32; unknowns.len()];
        for (node, own) in blocks_of.iter().enumerate() {
            let mut neighbours = Vec::new();
            let of_own =
                own.iter().flat_map(|&(n, _)| blocks[n].iter().map(|&other| other as usize));
            for other in std::iter::once(node).chain(of_own) {
                if met[other] != node {
                    met[other] = node;
                    neighbours.push(other);
                }
            }
            neighbours.sort_unstable();
            let mut place = 0;
            for &other in &neighbours {
                places[other] = place;
                place += free(other);
            }
            for &(n, column) in own {
                for (row, &other) in blocks[n].iter().enumerate() {
                    of_blocks[n][row * blocks[n].len() + column] = places[other as usize];
                }
            }
            for (rank, _) in unknowns[node].iter().flatten().enumerate() {
                let first = rows.len();
                rows.extend(neighbours.iter().flat_map(|&other| unknowns[other]).flatten());
                diagonal.push(u32::try_from(first + places[node] as usize + rank).ok()?);
                ranks.push(rank as u8);
                starts.push(rows.len());
            }
        }
        u32::try_from(rows.len()).ok()?;
        let count = ranks.len();
        let entries = SymbolicSparseColMat::new_checked(count, count, starts, None, rows);
        Some(Self { entries, of_blocks, ranks, diagonal })
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.of_blocks.len()
    }

    /// Values of all entries, none of which has been added.
    pub fn zeros(&self) -> Vec<f64> {
        vec![0.0; self.entries.row_idx().len()]
    }

    /// Adds the entries of a block of some nodes, row by row; rows and columns are the same `lines`.
    pub fn add(
        &self,
        values: &mut [f64],
        (block, nodes): (usize, usize),
        lines: &[Line],
        matrix: &[f64],
    ) {
        if lines.is_empty() {
            return;
        }
        let starts = self.entries.col_ptr();
        let places = &self.of_blocks[block];
        for (&(node, unknown), row) in lines.iter().zip(matrix.chunks_exact(lines.len())) {
            let (places, rank) = (&places[node * nodes..][..nodes], self.ranks[unknown] as usize);
            for (&(other, column), entry) in lines.iter().zip(row) {
                values[starts[column] + places[other] as usize + rank] += entry;
            }
        }
    }

    pub fn add_to_diagonal(&self, values: &mut [f64], unknown: usize, value: f64) {
        values[self.diagonal[unknown] as usize] += value;
    }
}

#[cfg(test)]
mod tests {
    use faer::sparse::SparseColMat;

    use super::*;

    /// Blocks of nodes with prescribed displacements add up as dense matrices do.
    #[test]
    fn blocks_add_up() {
        let unknowns = [
            [Some(0), None, Some(1)],
            [None; 3],
            [Some(2), Some(3), Some(4)],
            [None, None, Some(5)],
        ];
        let blocks: [&[u32]; 3] = [&[0, 1, 2], &[2, 3], &[3]];
        let pattern = Pattern::new(&unknowns, &blocks).unwrap();
        let (mut values, mut dense) = (pattern.zeros(), [[0.0; 6]; 6]);
        for (n, nodes) in blocks.iter().enumerate() {
            let of_node = |(place, &node): (usize, &u32)| {
                unknowns[node as usize].into_iter().flatten().map(move |unknown| (place, unknown))
            };
            let lines: Vec<Line> = nodes.iter().enumerate().flat_map(of_node).collect();
            let entry = |row: usize, column: usize| (100 * n + 10 * row + column) as f64;
            let rows = lines.iter().flat_map(|&(_, row)| lines.iter().map(move |&(_, c)| (row, c)));
            let matrix: Vec<f64> = rows.clone().map(|(row, column)| entry(row, column)).collect();
            rows.for_each(|(row, column)| dense[row][column] += entry(row, column));
            pattern.add(&mut values, (n, nodes.len()), &lines, &matrix);
        }
        pattern.add_to_diagonal(&mut values, 3, 0.5);
        dense[3][3] += 0.5;
        let matrix = SparseColMat::new(pattern.entries.clone(), values);
        for (row, entries) in dense.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                assert_eq!(matrix.get(row, column).copied().unwrap_or(0.0), *entry);
            }
        }
    }
}

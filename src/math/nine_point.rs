//! Symmetric matrices of bilinear elements on a structured grid of quadrilaterals: each node couples with the eight
//! around it, so that no column indices need to be stored.

use super::cholesky::LowerTriangle;
use crate::runtime::parallel::Team;

/// Number of nodes that a node couples with, itself included.
const STENCIL: usize = 9;
/// Rows of nodes that a thread processes as one piece.
const ROWS: usize = 8;

/// Nodes of a grid, those along the first axis fastest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    pub counts: [usize; 2],
}

impl Grid {
    pub fn nodes(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// Numbers of elements along both axes.
    pub fn elements(&self) -> [usize; 2] {
        self.counts.map(|count| count - 1)
    }

    /// Nodes of an element, those along the first axis fastest.
    pub fn corners(&self, [i, j]: [usize; 2]) -> [usize; 4] {
        let first = i + self.counts[0] * j;
        [first, first + 1, first + self.counts[0], first + self.counts[0] + 1]
    }

    /// Nodes before the first one and behind the last one that the stencil reaches.
    fn margin(&self) -> usize {
        self.counts[0] + 1
    }
}

/// A matrix of `B × B` blocks.
pub struct NinePoint<const B: usize> {
    grid: Grid,
    /// Blocks of each node's row, by ascending node.
    values: Vec<f64>,
}

impl<const B: usize> NinePoint<B> {
    pub fn zeros(grid: Grid) -> Self {
        Self { grid, values: vec![0.0; grid.nodes() * STENCIL * B * B] }
    }

    pub fn grid(&self) -> Grid {
        self.grid
    }

    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Takes the values of a matrix of the same grid.
    pub fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// Takes the row of a node of a matrix of the same grid.
    pub fn copy_row_from(&mut self, node: usize, other: &Self) {
        let row = node * STENCIL * B * B..(node + 1) * STENCIL * B * B;
        self.values[row.clone()].copy_from_slice(&other.values[row]);
    }

    /// Adds the matrix of an element, row by row, with the `B` unknowns of a corner together.
    pub fn add_element(&mut self, element: [usize; 2], matrix: &[f64]) {
        let size = STENCIL * B * B;
        for (a, node) in self.grid.corners(element).into_iter().enumerate() {
            let row = &mut self.values[node * size..][..size];
            for b in 0..4 {
                // Offsets of a corner from another are −1, 0 or 1 along both axes.
                let place = 4 + b % 2 + 3 * (b / 2) - a % 2 - 3 * (a / 2);
                for i in 0..B {
                    for j in 0..B {
                        row[(place * B + i) * B + j] += matrix[(a * B + i) * 4 * B + b * B + j];
                    }
                }
            }
        }
    }

    /// Places of the nine columns of a node's row relative to the node, counted in nodes.
    fn offsets(&self) -> [isize; STENCIL] {
        let along = self.grid.counts[0] as isize;
        std::array::from_fn(|k| (k % 3) as isize - 1 + along * ((k / 3) as isize - 1))
    }

    /// Calls back for each block of a node's row inside the grid, with the column's node.
    fn each_block(&self, node: usize, mut visit: impl FnMut(usize, &[f64])) {
        let [columns, rows] = self.grid.counts;
        let (i, j) = (node % columns, node / columns);
        let size = B * B;
        for k in 0..STENCIL {
            let (a, b) = (i + k % 3, j + k / 3);
            if a == 0 || b == 0 || a > columns || b > rows {
                continue;
            }
            let block = &self.values[(node * STENCIL + k) * size..][..size];
            visit(a - 1 + columns * (b - 1), block);
        }
    }

    /// `out = A x`; rows of unknowns that are `held` are zero, and so is `x` there.
    pub fn product(&self, x: &Padded<B>, held: &[bool], out: &mut [f64], team: &Team) {
        let offsets = self.offsets();
        let width = self.grid.counts[0] * B * ROWS;
        let mut pieces: Vec<_> = out.chunks_mut(width).zip(held.chunks(width)).collect();
        team.for_each(&mut pieces, |piece, (out, held)| {
            let first = piece * self.grid.counts[0] * ROWS;
            for (n, (out, held)) in out.chunks_exact_mut(B).zip(held.chunks_exact(B)).enumerate() {
                let sum = self.row(first + n, x, &offsets);
                for i in 0..B {
                    out[i] = if held[i] { 0.0 } else { sum[i] };
                }
            }
        });
    }

    /// Rows of a node in the product with a vector.
    fn row(&self, node: usize, x: &Padded<B>, offsets: &[isize; STENCIL]) -> [f64; B] {
        let blocks = &self.values[node * STENCIL * B * B..][..STENCIL * B * B];
        let mut sum = [0.0; B];
        for (block, offset) in blocks.chunks_exact(B * B).zip(offsets) {
            let x = x.at(node, *offset);
            for i in 0..B {
                for j in 0..B {
                    sum[i] += block[i * B + j] * x[j];
                }
            }
        }
        sum
    }

    /// The rows of some nodes in the product with a vector.
    pub fn product_of(&self, nodes: &[u32], x: &Padded<B>, out: &mut [f64], team: &Team) {
        let offsets = self.offsets();
        const PIECE: usize = 1 << 11;
        let mut pieces: Vec<_> = out.chunks_mut(PIECE * B).zip(nodes.chunks(PIECE)).collect();
        team.for_each(&mut pieces, |_, (out, nodes)| {
            for (out, &node) in out.chunks_exact_mut(B).zip(*nodes) {
                out.copy_from_slice(&self.row(node as usize, x, &offsets));
            }
        });
    }

    /// Diagonal of a node's own block.
    pub fn diagonal(&self, node: usize) -> [f64; B] {
        let block = &self.values[(node * STENCIL + 4) * B * B..][..B * B];
        std::array::from_fn(|i| block[i * B + i])
    }

    /// Lower triangle of the unknowns that are not held, whose numbers are `number`; held ones have `usize::MAX`.
    pub fn lower_triangle(&self, number: &[usize]) -> LowerTriangle {
        let mut lower = LowerTriangle { column_start: vec![0], ..LowerTriangle::default() };
        for unknown in 0..number.len() {
            let column = number[unknown];
            if column == usize::MAX {
                continue;
            }
            // By symmetry a column is a row.
            let (node, own) = (unknown / B, unknown % B);
            self.each_block(node, |other, block| {
                for j in 0..B {
                    let row = number[other * B + j];
                    if row != usize::MAX && row >= column {
                        lower.rows.push(row);
                        lower.values.push(block[own * B + j]);
                    }
                }
            });
            lower.column_start.push(lower.rows.len());
        }
        lower
    }
}

/// A vector of `B` values per node, with zeros around it that the stencil of nodes at edges reaches.
#[derive(Debug, Clone)]
pub struct Padded<const B: usize> {
    margin: usize,
    nodes: usize,
    values: Vec<f64>,
}

impl<const B: usize> Padded<B> {
    pub fn zeros(grid: Grid) -> Self {
        let (margin, nodes) = (grid.margin(), grid.nodes());
        Self { margin, nodes, values: vec![0.0; (nodes + 2 * margin) * B] }
    }

    pub fn inner(&self) -> &[f64] {
        &self.values[self.margin * B..][..self.nodes * B]
    }

    pub fn inner_mut(&mut self) -> &mut [f64] {
        &mut self.values[self.margin * B..][..self.nodes * B]
    }

    fn at(&self, node: usize, offset: isize) -> &[f64] {
        let place = (node + self.margin).wrapping_add_signed(offset);
        &self.values[place * B..][..B]
    }
}

//! Symmetric matrices of multilinear elements on a structured grid of quadrilaterals or hexahedra: each node couples with
//! those around it, so that no column indices need to be stored.

use super::cholesky::LowerTriangle;
use crate::runtime::parallel::Team;

/// Largest number of nodes that a node couples with, itself included.
const LARGEST_STENCIL: usize = 27;
/// Rows of nodes that a thread processes as one piece.
const ROWS: usize = 8;

/// Number of nodes that a node of a grid couples with, itself included.
const fn stencil(dimension: usize) -> usize {
    3_usize.pow(dimension as u32)
}

/// Nodes of a grid of `D` axes, those along the first axis fastest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid<const D: usize> {
    pub counts: [usize; D],
}

impl<const D: usize> Grid<D> {
    pub fn nodes(&self) -> usize {
        self.counts.iter().product()
    }

    /// Numbers of elements along all axes.
    pub fn elements(&self) -> [usize; D] {
        self.counts.map(|count| count - 1)
    }

    /// Number of rows of elements along the first axis.
    pub fn rows(&self) -> usize {
        self.elements()[1..].iter().product()
    }

    /// Element of a row.
    pub fn element(&self, column: usize, row: usize) -> [usize; D] {
        let elements = self.elements();
        let mut rest = row;
        std::array::from_fn(|axis| match axis {
            0 => column,
            _ => {
                let own = rest % elements[axis];
                rest /= elements[axis];
                own
            }
        })
    }

    /// Position of a node along all axes.
    pub fn position(&self, node: usize) -> [usize; D] {
        let mut rest = node;
        self.counts.map(|count| {
            let own = rest % count;
            rest /= count;
            own
        })
    }

    /// Difference between the numbers of neighbours along an axis.
    pub fn stride(&self, axis: usize) -> usize {
        self.counts[..axis].iter().product()
    }

    /// The `C = 2^D` nodes of an element, those along the first axis fastest.
    pub fn corners<const C: usize>(&self, element: [usize; D]) -> [usize; C] {
        const { assert!(C == 1 << D) };
        let first: usize = (0..D).map(|axis| element[axis] * self.stride(axis)).sum();
        std::array::from_fn(|corner| {
            first + (0..D).map(|axis| (corner >> axis & 1) * self.stride(axis)).sum::<usize>()
        })
    }

    /// Nodes with which a node couples, itself included, in ascending order.
    pub fn around(&self, node: usize) -> impl Iterator<Item = usize> + use<D> {
        let (counts, position) = (self.counts, self.position(node));
        (0..stencil(D)).filter_map(move |k| {
            let (mut digits, mut stride, mut other) = (k, 1, 0);
            for (count, place) in counts.into_iter().zip(position) {
                let along = (place + digits % 3).checked_sub(1).filter(|along| *along < count)?;
                other += stride * along;
                stride *= count;
                digits /= 3;
            }
            Some(other)
        })
    }

    /// Nodes within one layer of others, these included.
    pub fn dilated(&self, inside: &[bool]) -> Vec<bool> {
        let mut wider = vec![false; inside.len()];
        for node in (0..inside.len()).filter(|&node| inside[node]) {
            self.around(node).for_each(|other| wider[other] = true);
        }
        wider
    }

    /// Nodes before the first one and behind the last one that the stencil reaches.
    fn margin(&self) -> usize {
        (0..D).map(|axis| self.stride(axis)).sum()
    }
}

/// A matrix of `B × B` blocks.
pub struct GridMatrix<const D: usize, const B: usize> {
    grid: Grid<D>,
    /// Blocks of each node's row, by ascending node.
    values: Vec<f64>,
}

impl<const D: usize, const B: usize> GridMatrix<D, B> {
    const STENCIL: usize = stencil(D);

    pub fn zeros(grid: Grid<D>) -> Self {
        Self { grid, values: vec![0.0; grid.nodes() * Self::STENCIL * B * B] }
    }

    pub fn grid(&self) -> Grid<D> {
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
        let row = node * Self::STENCIL * B * B..(node + 1) * Self::STENCIL * B * B;
        self.values[row.clone()].copy_from_slice(&other.values[row]);
    }

    /// Adds the matrix of an element of `C` corners, row by row, with the `B` unknowns of a corner together.
    pub fn add_element<const C: usize>(&mut self, element: [usize; D], matrix: &[f64]) {
        let size = Self::STENCIL * B * B;
        for (a, node) in self.grid.corners::<C>(element).into_iter().enumerate() {
            let row = &mut self.values[node * size..][..size];
            for b in 0..C {
                let place = Self::between(a, b);
                for i in 0..B {
                    for j in 0..B {
                        row[(place * B + i) * B + j] += matrix[(a * B + i) * C * B + b * B + j];
                    }
                }
            }
        }
    }

    /// Place of a corner in the row of another: offsets are −1, 0 or 1 along each axis.
    fn between(from: usize, to: usize) -> usize {
        let (mut place, mut weight) = (0, 1);
        for axis in 0..D {
            place += weight * (1 + (to >> axis & 1) - (from >> axis & 1));
            weight *= 3;
        }
        place
    }

    /// Places of the columns of a node's row relative to the node, counted in nodes.
    fn offsets(&self) -> [isize; LARGEST_STENCIL] {
        std::array::from_fn(|k| {
            let mut digits = k;
            (0..D)
                .map(|axis| {
                    let own = (digits % 3) as isize - 1;
                    digits /= 3;
                    own * self.grid.stride(axis) as isize
                })
                .sum()
        })
    }

    /// Calls back for each block of a node's row inside the grid, with the column's node.
    fn each_block(
        &self,
        node: usize,
        offsets: &[isize; LARGEST_STENCIL],
        mut visit: impl FnMut(usize, &[f64]),
    ) {
        let position = self.grid.position(node);
        let size = B * B;
        for (k, offset) in offsets[..Self::STENCIL].iter().enumerate() {
            let mut digits = k;
            let is_inside = position.iter().zip(self.grid.counts).all(|(place, count)| {
                let along = place + digits % 3;
                digits /= 3;
                (1..=count).contains(&along)
            });
            if is_inside {
                let block = &self.values[(node * Self::STENCIL + k) * size..][..size];
                visit(node.wrapping_add_signed(*offset), block);
            }
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
    fn row(&self, node: usize, x: &Padded<B>, offsets: &[isize; LARGEST_STENCIL]) -> [f64; B] {
        let blocks = &self.values[node * Self::STENCIL * B * B..][..Self::STENCIL * B * B];
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
        let block = &self.values[(node * Self::STENCIL + Self::STENCIL / 2) * B * B..][..B * B];
        std::array::from_fn(|i| block[i * B + i])
    }

    /// Lower triangle of the unknowns that are not held, whose numbers are `number`; held ones have `usize::MAX`.
    pub fn lower_triangle(&self, number: &[usize]) -> LowerTriangle {
        let mut lower = LowerTriangle { column_start: vec![0], ..LowerTriangle::default() };
        let offsets = self.offsets();
        for unknown in 0..number.len() {
            let column = number[unknown];
            if column == usize::MAX {
                continue;
            }
            // By symmetry a column is a row.
            let (node, own) = (unknown / B, unknown % B);
            self.each_block(node, &offsets, |other, block| {
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
    pub fn zeros<const D: usize>(grid: Grid<D>) -> Self {
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

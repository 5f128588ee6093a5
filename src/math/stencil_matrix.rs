//! Sparse matrices on structured grids: each node couples with a box of neighbours, so that no
//! column indices need to be stored.

/// Neighbours of the nodes of one axis: node `i` couples with `first[i] ..= last[i]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    pub first: Vec<usize>,
    pub last: Vec<usize>,
}

impl Reach {
    /// Neighbours through shared elements of `order + 1` nodes each.
    pub fn of_elements(elements: usize, order: usize) -> Self {
        let nodes = elements * order + 1;
        let first = (0..nodes).map(|i| i.saturating_sub(1) / order * order).collect();
        let last = (0..nodes).map(|i| ((i / order + 1) * order).min(nodes - 1)).collect();
        Self { first, last }
    }

    pub fn len(&self) -> usize {
        self.first.len()
    }

    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    pub fn count(&self, i: usize) -> usize {
        self.last[i] - self.first[i] + 1
    }
}

/// A matrix of `rows × columns` blocks between the nodes of a three-dimensional grid.
#[derive(Debug, Clone)]
pub struct StencilMatrix {
    reach: [Reach; 3],
    block: [usize; 2],
    /// Start of each node's blocks in `values`.
    start: Vec<usize>,
    values: Vec<f64>,
}

impl StencilMatrix {
    /// A zero matrix with blocks of `block[0]` rows and `block[1]` columns.
    pub fn zeros(reach: [Reach; 3], block: [usize; 2]) -> Self {
        let [rx, ry, rz] = &reach;
        let mut start = Vec::with_capacity(rx.len() * ry.len() * rz.len() + 1);
        let mut next = 0;
        for k in 0..rz.len() {
            for j in 0..ry.len() {
                for i in 0..rx.len() {
                    start.push(next);
                    next += rx.count(i) * ry.count(j) * rz.count(k) * block[0] * block[1];
                }
            }
        }
        start.push(next);
        Self { reach, block, start, values: vec![0.0; next] }
    }

    pub fn nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// The block that couples node `row` with node `column`, row by row.
    pub fn block_mut(&mut self, row: [usize; 3], column: [usize; 3]) -> &mut [f64] {
        let [rx, ry, rz] = &self.reach;
        let node = row[0] + rx.len() * (row[1] + ry.len() * row[2]);
        let place = column[0] - rx.first[row[0]]
            + rx.count(row[0])
                * (column[1] - ry.first[row[1]]
                    + ry.count(row[1]) * (column[2] - rz.first[row[2]]));
        let size = self.block[0] * self.block[1];
        &mut self.values[self.start[node] + place * size..][..size]
    }

    /// Visits the blocks of a node's row: `visit(column node, block)`.
    pub fn for_each_block(&self, node: usize, mut visit: impl FnMut(usize, &[f64])) {
        let [rx, ry, rz] = &self.reach;
        let (i, j, k) = (node % rx.len(), node / rx.len() % ry.len(), node / (rx.len() * ry.len()));
        let size = self.block[0] * self.block[1];
        let mut at = self.start[node];
        for c in rz.first[k]..=rz.last[k] {
            for b in ry.first[j]..=ry.last[j] {
                for a in rx.first[i]..=rx.last[i] {
                    visit(a + rx.len() * (b + ry.len() * c), &self.values[at..at + size]);
                    at += size;
                }
            }
        }
    }

    /// `out += A x`; `x` holds `block[1]` values per node, `out` holds `block[0]`.
    pub fn add_product(&self, x: &[f64], out: &mut [f64]) {
        let [rows, columns] = self.block;
        for (node, result) in out.chunks_exact_mut(rows).enumerate() {
            self.for_each_block(node, |column, block| {
                let x = &x[column * columns..][..columns];
                for (r, row) in result.iter_mut().zip(block.chunks_exact(columns)) {
                    for (b, v) in row.iter().zip(x) {
                        *r += b * v;
                    }
                }
            });
        }
    }

    /// `out += Aᵀ x`; `x` holds `block[0]` values per node, `out` holds `block[1]`.
    pub fn add_transposed_product(&self, x: &[f64], out: &mut [f64]) {
        let [rows, columns] = self.block;
        for (node, x) in x.chunks_exact(rows).enumerate() {
            self.for_each_block(node, |column, block| {
                let out = &mut out[column * columns..][..columns];
                for (v, row) in x.iter().zip(block.chunks_exact(columns)) {
                    for (o, b) in out.iter_mut().zip(row) {
                        *o += b * v;
                    }
                }
            });
        }
    }

    /// Number of stored values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reach_spans_shared_elements() {
        let linear = Reach::of_elements(3, 1);
        assert_eq!((linear.first, linear.last), (vec![0, 0, 1, 2], vec![1, 2, 3, 3]));
        let quadratic = Reach::of_elements(2, 2);
        assert_eq!((quadratic.first, quadratic.last), (vec![0, 0, 0, 2, 2], vec![2, 2, 4, 4, 4]));
    }

    #[test]
    fn product_uses_stored_blocks() {
        let reach = [1, 2, 1].map(|n| Reach::of_elements(n, 1));
        let mut matrix = StencilMatrix::zeros(reach, [2, 1]);
        matrix.block_mut([0, 0, 0], [1, 1, 1])[1] = 3.0;
        let mut x = vec![0.0; 12];
        x[1 + 2 * (1 + 3)] = 2.0;
        let mut out = vec![0.0; 24];
        matrix.add_product(&x, &mut out);
        assert_eq!(out[1], 6.0);
        assert_eq!(out.iter().filter(|v| **v != 0.0).count(), 1);
    }
}

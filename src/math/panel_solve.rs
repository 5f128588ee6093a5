//! Solution with a Cholesky factor that is stored in supernodal panels, in single precision.
//!
//! Each panel is read once forwards and once backwards, in the order of memory. Sums are formed in a fixed order.

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Columns that are processed together, and interleaved partial sums of a dot product.
const COLUMNS: usize = 4;
const SUMS: usize = 16;

/// A panel: its first unknown, the rows below its diagonal block, and its columns.
struct Panel<'a> {
    start: usize,
    width: usize,
    pattern: &'a [usize],
    values: &'a [f32],
}

/// Replaces `x` by the solution of `L Lᵀ x = b`, in the order of the factor.
pub fn solve(symbolic: &SymbolicSupernodalCholesky<usize>, values: &[f32], x: &mut [f32]) {
    let panel = |s: usize| {
        let node = symbolic.supernode(s);
        let [first, last] = [0, 1].map(|k| symbolic.col_ptr_for_val()[s + k]);
        Panel {
            start: node.start(),
            width: symbolic.supernode_end()[s] - node.start(),
            pattern: node.pattern(),
            values: &values[first..last],
        }
    };
    let mut room = Vec::new();
    for s in 0..symbolic.n_supernodes() {
        panel(s).forward(x, &mut room);
    }
    for s in (0..symbolic.n_supernodes()).rev() {
        panel(s).backward(x, &mut room);
    }
}

impl Panel<'_> {
    fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    fn column(&self, k: usize) -> &[f32] {
        &self.values[k * self.height()..][..self.height()]
    }

    /// Solves for the panel's own unknowns and subtracts their part from those of its pattern.
    fn forward(&self, x: &mut [f32], room: &mut Vec<f32>) {
        let own = self.start..self.start + self.width;
        room.clear();
        room.extend_from_slice(&x[own.clone()]);
        room.resize(self.height(), 0.0);
        let whole = self.width - self.width % COLUMNS;
        for first in (0..whole).step_by(COLUMNS) {
            self.eliminate_together(first, room);
        }
        for k in whole..self.width {
            let column = self.column(k);
            let value = room[k] / column[k];
            room[k] = value;
            for (sum, entry) in room[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *sum -= value * entry;
            }
        }
        x[own].copy_from_slice(&room[..self.width]);
        for (&row, sum) in self.pattern.iter().zip(&room[self.width..]) {
            x[row] += sum;
        }
    }

    /// Eliminates some successive unknowns from the rows below them.
    fn eliminate_together(&self, first: usize, room: &mut [f32]) {
        let columns: [&[f32]; COLUMNS] = std::array::from_fn(|k| &self.column(first + k)[first..]);
        let (values, below) = room[first..].split_at_mut(COLUMNS);
        for k in 0..COLUMNS {
            values[k] /= columns[k][k];
            for row in k + 1..COLUMNS {
                values[row] -= values[k] * columns[k][row];
            }
        }
        let [a, b, c, d] = columns.map(|column| &column[COLUMNS..][..below.len()]);
        let [p, q, r, s] = std::array::from_fn(|k| values[k]);
        for (i, sum) in below.iter_mut().enumerate() {
            *sum -= (p * a[i] + q * b[i]) + (r * c[i] + s * d[i]);
        }
    }

    /// Solves for the panel's own unknowns from those of its pattern.
    fn backward(&self, x: &mut [f32], room: &mut Vec<f32>) {
        let own = self.start..self.start + self.width;
        room.clear();
        room.extend_from_slice(&x[own.clone()]);
        room.extend(self.pattern.iter().map(|&row| x[row]));
        for k in (0..self.width).rev() {
            let column = self.column(k);
            room[k] = (room[k] - dot(&column[k + 1..], &room[k + 1..])) / column[k];
        }
        x[own].copy_from_slice(&room[..self.width]);
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0; SUMS];
    let (a_blocks, a_rest) = a.as_chunks::<SUMS>();
    let (b_blocks, b_rest) = b.as_chunks::<SUMS>();
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for i in 0..SUMS {
            sums[i] += x[i] * y[i];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f32>() + rest
}

//! Solution with a Cholesky factor that is stored in supernodal panels, in single precision.
//!
//! Each panel is read once forwards and once backwards, in the order of memory. Subtrees of the elimination tree are
//! processed on the threads of a team; the partition and the order of sums are fixed.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

use super::supernodes::{owners, parents};
use crate::runtime::parallel::Team;

/// Columns that are processed together, and interleaved partial sums of a dot product.
const COLUMNS: usize = 4;
const SUMS: usize = 16;

/// Largest share of all entries in a subtree that one thread processes.
const SHARE: f64 = 1.0 / 8.0;

/// Partition of the panels of a factor: subtrees of the elimination tree, which are independent of each other, and the
/// panels above them. It is the same for any number of threads, and so are sums.
pub struct Partition {
    /// Ascending; panels and unknowns of each follow on each other.
    subtrees: Vec<Subtree>,
    /// Panels above the subtrees, ascending.
    top: Vec<usize>,
    /// Place of each unknown among those of the panels above, and their number.
    place: Vec<u32>,
    count: usize,
}

struct Subtree {
    panels: Range<usize>,
    unknowns: Range<usize>,
}

/// A panel: its first unknown, the rows below its diagonal block, and its columns.
struct Panel<'a> {
    start: usize,
    width: usize,
    pattern: &'a [usize],
    values: &'a [f32],
}

/// The panels of a factor.
#[derive(Clone, Copy)]
struct Panels<'a> {
    symbolic: &'a SymbolicSupernodalCholesky<usize>,
    values: &'a [f32],
}

impl<'a> Panels<'a> {
    fn at(&self, s: usize) -> Panel<'a> {
        let node = self.symbolic.supernode(s);
        let [first, last] = [0, 1].map(|k| self.symbolic.col_ptr_for_val()[s + k]);
        Panel {
            start: node.start(),
            width: self.symbolic.supernode_end()[s] - node.start(),
            pattern: node.pattern(),
            values: &self.values[first..last],
        }
    }
}

impl Partition {
    pub fn of(symbolic: &SymbolicSupernodalCholesky<usize>) -> Self {
        let [begin, end] = [symbolic.supernode_begin(), symbolic.supernode_end()];
        let firsts = first_of_subtrees(symbolic);
        let (mut subtrees, mut top) = (Vec::new(), Vec::new());
        let mut next = symbolic.n_supernodes();
        while let Some(s) = next.checked_sub(1) {
            next = firsts[s].unwrap_or(s);
            match firsts[s] {
                Some(first) => {
                    let unknowns = begin[first]..end[s];
                    subtrees.push(Subtree { panels: first..s + 1, unknowns });
                }
                None => top.push(s),
            }
        }
        subtrees.reverse();
        top.reverse();
        let mut place = vec![u32::MAX; symbolic.nrows()];
        let mut count = 0;
        for unknown in top.iter().flat_map(|&s| begin[s]..end[s]) {
            place[unknown] = count as u32;
            count += 1;
        }
        Self { subtrees, top, place, count }
    }

    /// Replaces `x` by the solution of `L Lᵀ x = b`, in the order of the factor.
    pub fn solve(
        &self,
        symbolic: &SymbolicSupernodalCholesky<usize>,
        values: &[f32],
        x: &mut [f32],
        team: &Team,
    ) {
        let panels = Panels { symbolic, values };
        let mut subtrees = self.split(x);
        let sums = team.map_each(&mut subtrees, |(subtree, x)| self.forward(subtree, x, panels));
        for sums in &sums {
            let above = self.top.iter().flat_map(|&s| panels.at(s).unknowns());
            above.zip(sums).for_each(|(unknown, sum)| x[unknown] += sum);
        }
        let mut room = Vec::new();
        for &s in &self.top {
            panels.at(s).forward(x, |x, row, sum| x[row] += sum, &mut room);
        }
        for &s in self.top.iter().rev() {
            panels.at(s).backward(x, |x, row| x[row], &mut room);
        }
        let above = self.top.iter().flat_map(|&s| panels.at(s).unknowns());
        let above: Vec<f32> = above.map(|unknown| x[unknown]).collect();
        team.for_each(&mut self.split(x), |_, (subtree, x)| {
            self.backward(subtree, x, &above, panels);
        });
    }

    /// Parts of a vector by subtree.
    fn split<'x>(&self, mut x: &'x mut [f32]) -> Vec<(&Subtree, &'x mut [f32])> {
        let mut parts = Vec::with_capacity(self.subtrees.len());
        let mut done = 0;
        for subtree in &self.subtrees {
            let Range { start, end } = subtree.unknowns;
            let rest = x.split_at_mut(start - done).1;
            let (own, rest) = rest.split_at_mut(end - start);
            parts.push((subtree, own));
            (x, done) = (rest, end);
        }
        parts
    }

    /// Eliminates the unknowns of a subtree, of which `x` holds those alone; returns what they add above.
    fn forward(&self, subtree: &Subtree, x: &mut [f32], panels: Panels) -> Vec<f32> {
        let Range { start, end } = subtree.unknowns;
        let mut sums = vec![0.0; self.count];
        let mut room = Vec::new();
        for s in subtree.panels.clone() {
            let add = |x: &mut [f32], row: usize, sum: f32| match row < end {
                true => x[row - start] += sum,
                false => sums[self.place[row] as usize] += sum,
            };
            panels.at(s).from(start).forward(x, add, &mut room);
        }
        sums
    }

    /// Solves for the unknowns of a subtree, of which `x` holds those alone, from those above.
    fn backward(&self, subtree: &Subtree, x: &mut [f32], above: &[f32], panels: Panels) {
        let Range { start, end } = subtree.unknowns;
        let value = |x: &[f32], row: usize| match row < end {
            true => x[row - start],
            false => above[self.place[row] as usize],
        };
        let mut room = Vec::new();
        for s in subtree.panels.clone().rev() {
            panels.at(s).from(start).backward(x, value, &mut room);
        }
    }
}

/// First panel of the subtree of each, if its panels follow on each other and are few enough for one thread.
fn first_of_subtrees(symbolic: &SymbolicSupernodalCholesky<usize>) -> Vec<Option<usize>> {
    let count = symbolic.n_supernodes();
    let sizes = symbolic.col_ptr_for_val();
    let mut entries: Vec<usize> = sizes.windows(2).map(|ends| ends[1] - ends[0]).collect();
    let mut members = vec![1; count];
    let mut first: Vec<usize> = (0..count).collect();
    for (s, parent) in parents(symbolic, &owners(symbolic)).into_iter().enumerate() {
        if let Some(parent) = parent {
            entries[parent] += entries[s];
            members[parent] += members[s];
            first[parent] = first[parent].min(first[s]);
        }
    }
    let most = SHARE * sizes[count] as f64;
    let is_subtree = |&s: &usize| members[s] == s + 1 - first[s] && entries[s] as f64 <= most;
    (0..count).map(|s| Some(s).filter(is_subtree).map(|s| first[s])).collect()
}

impl Panel<'_> {
    /// The same panel among unknowns that are counted from another one on.
    fn from(self, first: usize) -> Self {
        Self { start: self.start - first, ..self }
    }

    fn unknowns(&self) -> Range<usize> {
        self.start..self.start + self.width
    }

    fn height(&self) -> usize {
        self.width + self.pattern.len()
    }

    fn column(&self, k: usize) -> &[f32] {
        &self.values[k * self.height()..][..self.height()]
    }

    /// Solves for the panel's own unknowns and adds what they take from those of its pattern, negative.
    fn forward(
        &self,
        x: &mut [f32],
        mut add: impl FnMut(&mut [f32], usize, f32),
        room: &mut Vec<f32>,
    ) {
        let own = self.unknowns();
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
            add(x, row, *sum);
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
    fn backward(&self, x: &mut [f32], value: impl Fn(&[f32], usize) -> f32, room: &mut Vec<f32>) {
        let own = self.unknowns();
        room.clear();
        room.extend_from_slice(&x[own.clone()]);
        room.extend(self.pattern.iter().map(|&row| value(x, row)));
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

//! Search for the nodes whose functions reach a place.

/// Boxes of a lattice, each with the nodes whose supports overlap it in ascending order, so that a place looks up one.
#[derive(Debug)]
pub struct Bins {
    low: [f64; 3],
    inverse_width: [f64; 3],
    count: [usize; 3],
    starts: Vec<usize>,
    nodes: Vec<u32>,
}

/// Most boxes per node, which bounds the memory of long thin lattices around sparse nodes.
const BOXES_PER_NODE: f64 = 4.0;

impl Bins {
    /// Sorts supports, given by their lowest and highest coordinates, into boxes of about `width` along each of `axes`.
    pub fn new(axes: &[usize], supports: &[[[f64; 3]; 2]], width: [f64; 3]) -> Self {
        let mut low = [0.0; 3];
        let mut count = [1; 3];
        let mut inverse_width = [0.0; 3];
        let extent = |a: usize| {
            let least = supports.iter().map(|s| s[0][a]).fold(f64::INFINITY, f64::min);
            let most = supports.iter().map(|s| s[1][a]).fold(f64::NEG_INFINITY, f64::max);
            (least, most - least)
        };
        let wanted: f64 = axes.iter().map(|&a| (extent(a).1 / width[a]).ceil().max(1.0)).product();
        let excess = wanted / (BOXES_PER_NODE * supports.len() as f64);
        let wider = excess.max(1.0).powf(1.0 / axes.len() as f64);
        for &a in axes {
            let (least, length) = extent(a);
            low[a] = least;
            count[a] = (length / (wider * width[a])).ceil().max(1.0) as usize;
            inverse_width[a] = count[a] as f64 / length;
        }
        let bins = Self { low, inverse_width, count, starts: Vec::new(), nodes: Vec::new() };
        let mut starts = vec![0; count.iter().product::<usize>() + 1];
        for support in supports {
            bins.each_box(support, |number| starts[number + 1] += 1);
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut next = starts.clone();
        let mut nodes = vec![0; starts[starts.len() - 1]];
        for (node, support) in supports.iter().enumerate() {
            bins.each_box(support, |number| {
                nodes[next[number]] = node as u32;
                next[number] += 1;
            });
        }
        Self { starts, nodes, ..bins }
    }

    /// Nodes that may reach a place.
    pub fn near(&self, at: [f64; 3]) -> &[u32] {
        let [i, j, k] = [0, 1, 2].map(|a| self.index(at[a], a));
        let number = i + self.count[0] * (j + self.count[1] * k);
        &self.nodes[self.starts[number]..self.starts[number + 1]]
    }

    fn index(&self, at: f64, axis: usize) -> usize {
        (((at - self.low[axis]) * self.inverse_width[axis]) as usize).min(self.count[axis] - 1)
    }

    fn each_box(&self, support: &[[f64; 3]; 2], mut visit: impl FnMut(usize)) {
        let [first, last] = [0, 1].map(|end| [0, 1, 2].map(|a| self.index(support[end][a], a)));
        for k in first[2]..=last[2] {
            for j in first[1]..=last[1] {
                for i in first[0]..=last[0] {
                    visit(i + self.count[0] * (j + self.count[1] * k));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_all_supports_that_reach_a_place() {
        // A lattice with supports of different widths.
        let number = |n: usize| (n * 7919 % 101) as f64 / 101.0;
        let supports: Vec<[[f64; 3]; 2]> = (0..300)
            .map(|n| {
                let at = [number(n), 3.0 * number(n + 40), 0.2 * number(n + 77)];
                let half = 0.05 + 0.2 * number(n + 13);
                [at.map(|x| x - half), at.map(|x| x + half)]
            })
            .collect();
        let bins = Bins::new(&[0, 1, 2], &supports, [0.1, 0.1, 0.1]);
        for n in 0..200 {
            let at = [number(n + 5), 3.0 * number(n + 60), 0.2 * number(n + 9)];
            let near = bins.near(at);
            assert!(near.is_sorted());
            let reaches = |s: &[[f64; 3]; 2]| (0..3).all(|a| s[0][a] < at[a] && at[a] < s[1][a]);
            for (node, support) in supports.iter().enumerate() {
                assert!(!reaches(support) || near.contains(&(node as u32)), "{at:?} {node}");
            }
            assert!(near.len() < 200);
        }
    }
}

//! Fill-reducing order of the nodes of any mesh by nested dissection in space.

/// Orders nodes for elimination: recursively both parts of each cut, then the nodes that separate them.
///
/// Cuts are across the longest extent of a part, at the median of its nodes. The separator consists of the nodes of one
/// part with a neighbour in the other, those of the part with fewer of them. Planes of nodes are not cut. The order of
/// a structured grid is that of A. George 1973, *Nested dissection of a regular finite element mesh*, doi
/// 10.1137/0710032.
///
/// `neighbours` must be symmetric.
pub fn geometric_dissection(places: &[[f64; 3]], neighbours: &[Vec<u32>]) -> Vec<usize> {
    let mut all: Vec<u32> = (0..places.len() as u32).collect();
    let part = vec![0; places.len()];
    let mut dissection =
        Dissection { places, neighbours, part, parts: 0, order: Vec::with_capacity(places.len()) };
    dissection.order(&mut all);
    dissection.order
}

struct Dissection<'a> {
    places: &'a [[f64; 3]],
    neighbours: &'a [Vec<u32>],
    /// Number of the latest part of each node.
    part: Vec<usize>,
    parts: usize,
    order: Vec<usize>,
}

/// Number of nodes up to which a part is not cut.
const LEAF: usize = 24;
/// Distance below which nodes are in one plane, over the extent of a part.
const PLANE: f64 = 1e-6;

impl Dissection<'_> {
    fn order(&mut self, nodes: &mut [u32]) {
        let cut = if nodes.len() > LEAF { self.cut(nodes) } else { None };
        let Some(cut) = cut else {
            self.order.extend(nodes.iter().map(|&node| node as usize));
            return;
        };
        let (low, high) = nodes.split_at_mut(cut);
        let numbers = [self.parts + 1, self.parts + 2];
        self.parts += 2;
        for (part, number) in [&*low, &*high].into_iter().zip(numbers) {
            part.iter().for_each(|&node| self.part[node as usize] = number);
        }
        let touches = |node: u32, other: usize| {
            let mut around = self.neighbours[node as usize].iter();
            around.any(|&neighbour| self.part[neighbour as usize] == other)
        };
        let inner = |part: &mut [u32], other: usize| {
            part.sort_by_cached_key(|&node| touches(node, other));
            part.partition_point(|&node| !touches(node, other))
        };
        let [of_low, of_high] = [inner(low, numbers[1]), inner(high, numbers[0])];
        let is_low = low.len() - of_low <= high.len() - of_high;
        let (one, other, inner) = if is_low { (low, high, of_low) } else { (high, low, of_high) };
        let (rest, separator) = one.split_at_mut(inner);
        self.order(rest);
        self.order(other);
        self.order.extend(separator.iter().map(|&node| node as usize));
    }

    /// Sorts nodes along their longest extent; returns the number of those below a cut near their median.
    fn cut(&self, nodes: &mut [u32]) -> Option<usize> {
        let range = |axis: usize| {
            let along = nodes.iter().map(|&node| self.places[node as usize][axis]);
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let extents = [0, 1, 2].map(range).map(|[low, high]| high - low);
        let axis = (0..3).max_by(|&a, &b| extents[a].total_cmp(&extents[b]))?;
        let along = |node: &u32| self.places[*node as usize][axis];
        nodes.sort_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
        let (same, middle) = (PLANE * extents[axis], along(&nodes[nodes.len() / 2]));
        let below = nodes.partition_point(|node| along(node) < middle - same);
        let above = nodes.partition_point(|node| along(node) <= middle + same);
        [below, above].into_iter().find(|&cut| cut > 0 && cut < nodes.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes of a grid that all couple within a cell.
    fn grid(count: [usize; 3]) -> (Vec<[f64; 3]>, Vec<Vec<u32>>) {
        let [nx, ny, nz] = count;
        let index = |n: usize| [n % nx, n / nx % ny, n / (nx * ny)];
        let around = |i: usize, end: usize| i.saturating_sub(1)..(i + 2).min(end);
        let neighbours = |n: usize| {
            let [i, j, k] = index(n);
            let mut all = Vec::new();
            for c in around(k, nz) {
                for b in around(j, ny) {
                    all.extend(around(i, nx).map(|a| (a + nx * (b + ny * c)) as u32));
                }
            }
            all
        };
        let nodes = 0..nx * ny * nz;
        (
            nodes.clone().map(|n| index(n).map(|i| i as f64)).collect(),
            nodes.map(neighbours).collect(),
        )
    }

    #[test]
    fn order_is_a_permutation() {
        for count in [[6, 5, 4], [1, 1, 40], [9, 1, 7], [2, 2, 2], [1, 1, 1]] {
            let (places, neighbours) = grid(count);
            let mut order = geometric_dissection(&places, &neighbours);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..places.len()), "{count:?}");
        }
        assert!(geometric_dissection(&[], &[]).is_empty());
        // Nodes at one place cannot be cut.
        let all: Vec<u32> = (0..30).collect();
        assert_eq!(geometric_dissection(&[[1.0; 3]; 30], &vec![all; 30]).len(), 30);
    }

    /// The last nodes of a cube are a plane of it, and what is before them falls into two parts.
    #[test]
    fn cube_is_cut_along_a_plane() {
        let n = 9;
        let (places, neighbours) = grid([n; 3]);
        let order = geometric_dissection(&places, &neighbours);
        let (rest, plane) = order.split_at(n * n * (n - 1));
        let cut = (0..3).find(|&a| plane.iter().all(|&p| places[p][a] == places[plane[0]][a]));
        let cut = cut.expect("the separator is a plane");
        let side = |node: usize| places[node][cut] < places[plane[0]][cut];
        let crossings =
            rest.iter().flat_map(|&a| neighbours[a].iter().map(move |&b| (a, b as usize)));
        let mut crossings = crossings.filter(|(_, b)| !plane.contains(b));
        assert!(crossings.all(|(a, b)| side(a) == side(b)));
    }
}

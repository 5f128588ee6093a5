//! Fill-reducing order of the nodes of a structured grid by nested dissection.

/// Orders the nodes of a grid (x fastest) for elimination: first both halves, last the separating
/// plane of nodes; recursively for each half.
///
/// `elements` is the number of elements along each axis and `order` the order of their shape
/// functions; planes between elements part the grid whatever the order. Source: A. George 1973,
/// *Nested dissection of a regular finite element mesh*, doi 10.1137/0710032.
pub fn nested_dissection(elements: [usize; 3], order: usize) -> Vec<usize> {
    let nodes = elements.map(|n| if n == 0 { 1 } else { n * order + 1 });
    let mut out = Vec::with_capacity(nodes.iter().product());
    let whole = Part { first: [0; 3], end: nodes };
    whole.order_into(order, nodes, &mut out);
    out
}

/// A box of nodes, `first .. end` along each axis.
#[derive(Clone, Copy)]
struct Part {
    first: [usize; 3],
    end: [usize; 3],
}

/// Number of nodes below which a part is not divided further.
const LEAF: usize = 24;

impl Part {
    fn size(&self, axis: usize) -> usize {
        self.end[axis] - self.first[axis]
    }

    fn order_into(&self, order: usize, nodes: [usize; 3], out: &mut Vec<usize>) {
        let total: usize = (0..3).map(|a| self.size(a)).product();
        match self.separator(order) {
            Some((axis, plane)) if total > LEAF => {
                let (mut low, mut high, mut middle) = (*self, *self, *self);
                low.end[axis] = plane;
                (middle.first[axis], middle.end[axis]) = (plane, plane + 1);
                high.first[axis] = plane + 1;
                low.order_into(order, nodes, out);
                high.order_into(order, nodes, out);
                middle.order_into(order, nodes, out);
            }
            _ => self.list_into(nodes, out),
        }
    }

    /// The plane between elements nearest to the middle of the longest axis that has one inside.
    fn separator(&self, order: usize) -> Option<(usize, usize)> {
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&a| std::cmp::Reverse(self.size(a)));
        axes.into_iter().find_map(|axis| {
            let middle = self.first[axis] + self.size(axis) / 2;
            let below = middle / order * order;
            let above = below + order;
            let inside = |plane: usize| plane > self.first[axis] && plane + 1 < self.end[axis];
            [below, above].into_iter().find(|&plane| inside(plane)).map(|plane| (axis, plane))
        })
    }

    fn list_into(&self, nodes: [usize; 3], out: &mut Vec<usize>) {
        for k in self.first[2]..self.end[2] {
            for j in self.first[1]..self.end[1] {
                for i in self.first[0]..self.end[0] {
                    out.push(i + nodes[0] * (j + nodes[1] * k));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_a_permutation() {
        for (elements, order) in [([5, 4, 3], 1), ([3, 3, 2], 2), ([9, 0, 7], 2), ([1, 1, 1], 1)] {
            let mut list = nested_dissection(elements, order);
            list.sort_unstable();
            assert!(list.iter().enumerate().all(|(i, &node)| i == node));
        }
    }
}

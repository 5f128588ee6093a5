//! Parts of a graph.

/// Parts into which so many vertices fall, joined pair by pair.
pub struct Parts {
    parent: Vec<usize>,
    count: usize,
}

impl Parts {
    /// Each vertex is a part of its own.
    pub fn new(vertices: usize) -> Self {
        Self { parent: (0..vertices).collect(), count: vertices }
    }

    /// Joins the parts of two vertices.
    pub fn join(&mut self, [a, b]: [usize; 2]) {
        let (a, b) = (self.first(a), self.first(b));
        if a != b {
            self.parent[a.max(b)] = a.min(b);
            self.count -= 1;
        }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// First vertex of the part that a vertex is in; halves the way there.
    pub fn first(&mut self, mut at: usize) -> usize {
        while self.parent[at] != at {
            self.parent[at] = self.parent[self.parent[at]];
            at = self.parent[at];
        }
        at
    }
}

//! The wall below droplets, cut into cells that exchange heat and momentum with the fluid.

/// How the wall is cut. Weights of one place sum to 1, so that what the fluid gives arrives whole.
#[derive(Debug, Clone, PartialEq)]
pub enum WallCells {
    /// Concentric rings of equal width out to `radius` [m] about the origin.
    Rings { count: usize, radius: f64 },
    /// Rectangles over `size` [m], centred on the origin; cell `[i, j]` has index `i · count[1] + j`.
    Tiles { count: [usize; 2], size: [f64; 2] },
    /// Bilinear functions between the nodes of a grid [m], both lists ascending; node `[i, j]` has
    /// index `i + j · x.len()`.
    Nodes { x: Vec<f64>, y: Vec<f64> },
    /// Functions linear in the radius between its nodes r [m], ascending from 0.
    RadialNodes { r: Vec<f64> },
}

/// The cells that share what happens at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallShare {
    /// Index and weight; unused ones have weight 0.
    pub cells: [(usize, f64); 4],
    /// Whether the place lies beyond the outermost cells, to the nearest of which it then belongs.
    pub outside: bool,
}

/// What the fluid gave to the cells of the wall during one step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WallExchange {
    /// Length of the step [s].
    pub duration: f64,
    /// [J] for each cell.
    pub heat: Vec<f64>,
    /// Momentum along x, y, z [N s] for each cell; along z it points into the wall when negative.
    /// For rings and radial nodes, x holds the radial part and y nothing.
    pub impulse: Vec<[f64; 3]>,
    /// Parts that were given beyond the outermost cells.
    pub heat_outside: f64,
    pub impulse_outside: [f64; 3],
}

impl WallCells {
    pub fn len(&self) -> usize {
        match self {
            WallCells::Rings { count, .. } => *count,
            WallCells::Tiles { count, .. } => count[0] * count[1],
            WallCells::Nodes { x, y } => x.len() * y.len(),
            WallCells::RadialNodes { r } => r.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether which cells share depends on the distance from the origin alone.
    pub fn are_radial(&self) -> bool {
        matches!(self, WallCells::Rings { .. } | WallCells::RadialNodes { .. })
    }

    /// Which cells share what happens at a place [m].
    pub fn share(&self, x: f64, y: f64) -> WallShare {
        match self {
            WallCells::Rings { count, radius } => {
                let place = x.hypot(y) / radius * *count as f64;
                let (cell, outside) = nearest(place, *count);
                one(cell, outside)
            }
            WallCells::Tiles { count, size } => {
                let place = |at: f64, a: usize| (at / size[a] + 0.5) * count[a] as f64;
                let (i, beyond_x) = nearest(place(x, 0), count[0]);
                let (j, beyond_y) = nearest(place(y, 1), count[1]);
                one(i * count[1] + j, beyond_x || beyond_y)
            }
            WallCells::Nodes { x: along_x, y: along_y } => {
                let (i, u, beyond_x) = between(along_x, x);
                let (j, v, beyond_y) = between(along_y, y);
                let [right, up] = [(along_x, i), (along_y, j)]
                    .map(|(nodes, place)| usize::from(place + 1 < nodes.len()));
                let at = |i: usize, j: usize| i + j * along_x.len();
                let cells = [
                    (at(i, j), (1.0 - u) * (1.0 - v)),
                    (at(i + right, j), u * (1.0 - v)),
                    (at(i, j + up), (1.0 - u) * v),
                    (at(i + right, j + up), u * v),
                ];
                WallShare { cells, outside: beyond_x || beyond_y }
            }
            WallCells::RadialNodes { r } => {
                let (node, above, outside) = between(r, x.hypot(y));
                let next = (node + 1).min(r.len() - 1);
                let cells = [(node, 1.0 - above), (next, above), (node, 0.0), (node, 0.0)];
                WallShare { cells, outside }
            }
        }
    }
}

impl WallExchange {
    pub fn none(cells: usize) -> Self {
        let heat = vec![0.0; cells];
        Self { heat, impulse: vec![[0.0; 3]; cells], ..Self::default() }
    }
}

/// The one cell that has everything.
fn one(cell: usize, outside: bool) -> WallShare {
    WallShare { cells: [(cell, 1.0), (cell, 0.0), (cell, 0.0), (cell, 0.0)], outside }
}

/// The cell at a place counted in cells, and whether the place lies outside.
fn nearest(place: f64, count: usize) -> (usize, bool) {
    let cell = (place.floor().max(0.0) as usize).min(count - 1);
    (cell, place < 0.0 || place > count as f64)
}

/// The node below a coordinate, the share of the node above, and whether it lies outside.
fn between(nodes: &[f64], at: f64) -> (usize, f64, bool) {
    let last = nodes.len() - 1;
    let outside = at < nodes[0] || at > nodes[last];
    if last == 0 {
        return (0, 0.0, false);
    }
    let below = nodes.partition_point(|&node| node <= at).clamp(1, last) - 1;
    let share = (at - nodes[below]) / (nodes[below + 1] - nodes[below]);
    (below, share.clamp(0.0, 1.0), outside)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grids() -> [WallCells; 4] {
        [
            WallCells::Rings { count: 5, radius: 2.0 },
            WallCells::Tiles { count: [4, 3], size: [4.0, 2.0] },
            WallCells::Nodes { x: vec![-2.0, -0.5, 0.25, 2.0], y: vec![-1.0, 0.5, 1.0] },
            WallCells::RadialNodes { r: vec![0.0, 0.25, 1.0, 2.0] },
        ]
    }

    #[test]
    fn the_shares_of_a_place_sum_to_one() {
        for cells in grids() {
            for (x, y) in [(0.0, 0.0), (1.3, -0.7), (-2.0, 1.0), (9.0, 0.1), (-0.1, -8.0)] {
                let share = cells.share(x, y);
                let sum: f64 = share.cells.iter().map(|cell| cell.1).sum();
                assert!((sum - 1.0).abs() < 1e-15, "{cells:?} {x} {y}");
                assert!(share.cells.iter().all(|c| c.0 < cells.len() && c.1 >= 0.0));
                let beyond = x.abs() > 2.0 || y.abs() > 2.0;
                let corner = x == -2.0 && y == 1.0; // Inside the rectangles, outside the circles.
                assert!(share.outside == beyond || corner, "{cells:?} {x} {y}");
            }
        }
    }

    #[test]
    fn bilinear_shares_reproduce_a_plane() {
        let [_, _, cells, _] = grids();
        let WallCells::Nodes { x, .. } = &cells else { unreachable!() };
        let y = [-1.0, 0.5, 1.0];
        let plane = |x: f64, y: f64| 3.0 - 2.0 * x + 0.5 * y;
        for place in [(-1.7, 0.9), (0.1, 0.2), (2.0, 1.0)] {
            let share = cells.share(place.0, place.1);
            let value: f64 =
                share.cells.iter().map(|&(c, w)| w * plane(x[c % x.len()], y[c / x.len()])).sum();
            assert!((value - plane(place.0, place.1)).abs() < 1e-14);
        }
    }

    #[test]
    fn cells_are_counted_as_their_variables_are() {
        let [rings, tiles, ..] = grids();
        assert_eq!(rings.share(0.0, 0.5).cells[0].0, 1);
        assert_eq!(tiles.share(-1.5, 0.0).cells[0].0, 1);
        assert_eq!(tiles.share(1.5, -0.9).cells[0].0, 9);
    }
}

//! Weights of a wall's cells in a small rectangle of it.

use super::cells::WallCells;
use crate::math::disc_rectangle::{area_within, length_within};
use crate::math::gauss::gauss_on;

/// Fractions of a rectangle, line or point on the wall that belong to its cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cover {
    /// Index and weight of each cell; they sum, with `outside`, to 1.
    pub cells: Vec<(usize, f64)>,
    /// Fraction beyond the outermost cells.
    pub outside: f64,
    /// The cell nearest to the middle.
    pub nearest: usize,
}

impl Cover {
    /// Mean of a value per cell; beyond the outermost cells the nearest one counts.
    pub fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        let inside: f64 = self.cells.iter().map(|&(cell, weight)| weight * value(cell)).sum();
        inside + self.outside * value(self.nearest)
    }
}

impl WallCells {
    /// Weights of the cells in a rectangle [m]; nodal functions count by their means over it. So a
    /// contribution arrives where it occurs, even next to wide cells.
    pub fn cover(&self, rectangle: [[f64; 2]; 2]) -> Cover {
        match self {
            WallCells::Rings { count, radius } => {
                let within = |r: f64| part_within(r, rectangle);
                rings(*count, *radius, distances(rectangle), within)
            }
            WallCells::Tiles { count, size } => {
                let parts = [0, 1].map(|a| {
                    let width = size[a] / count[a] as f64;
                    let tile = |at: f64| at / width + 0.5 * count[a] as f64;
                    intervals(rectangle[a].map(tile), count[a])
                });
                product(parts, |i, j| i * count[1] + j)
            }
            WallCells::Nodes { x, y } => {
                let parts = [hats(x, rectangle[0]), hats(y, rectangle[1])];
                product(parts, |i, j| i + j * x.len())
            }
            WallCells::RadialNodes { r } => {
                let within = |r: f64| part_within(r, rectangle);
                radial_hats(r, distances(rectangle), &bends(rectangle), within)
            }
        }
    }
}

impl WallCells {
    /// Weights of round cells in a ring between two radii [m].
    pub fn cover_ring(&self, [inner, outer]: [f64; 2]) -> Cover {
        let square = |r: f64| r.clamp(inner, outer).powi(2);
        let within = |r: f64| (square(r) - inner * inner) / (outer * outer - inner * inner);
        let middle = 0.5 * (inner + outer);
        let distances = [middle, inner, outer];
        match self {
            WallCells::Rings { count, radius } => rings(*count, *radius, distances, within),
            WallCells::RadialNodes { r } => radial_hats(r, distances, &[inner, outer], within),
            WallCells::Tiles { .. } | WallCells::Nodes { .. } => {
                panic!("rings lie above round cells alone")
            }
        }
    }
}

/// Fractions of an interval in the cells between 0, 1, … count.
fn intervals([low, high]: [f64; 2], count: usize) -> Cover {
    let cell = |at: f64| (at.floor().max(0.0) as usize).min(count - 1);
    let nearest = cell(0.5 * (low + high));
    if high <= low {
        let outside = low < 0.0 || low > count as f64;
        let cells = if outside { Vec::new() } else { vec![(nearest, 1.0)] };
        return Cover { cells, outside: f64::from(u8::from(outside)), nearest };
    }
    let part = |n: usize| {
        let length = high.min((n + 1) as f64) - low.max(n as f64);
        (n, length.max(0.0) / (high - low))
    };
    complete((cell(low)..=cell(high)).map(part).collect(), nearest)
}

/// Means over an interval of the functions linear between nodes.
fn hats(nodes: &[f64], [low, high]: [f64; 2]) -> Cover {
    let last = nodes.len() - 1;
    let middle = 0.5 * (low + high);
    let below = |at: f64| nodes.partition_point(|&node| node <= at).clamp(1, last.max(1)) - 1;
    let nearest = |below: usize| {
        let next = (below + 1).min(last);
        if middle - nodes[below] <= nodes[next] - middle { below } else { next }
    };
    let nearest = nearest(below(middle).min(last));
    if last == 0 {
        return Cover { cells: vec![(0, 1.0)], outside: 0.0, nearest: 0 };
    }
    if high <= low {
        let outside = low < nodes[0] || low > nodes[last];
        let n = below(low);
        let share = (low - nodes[n]) / (nodes[n + 1] - nodes[n]);
        let cells = match outside {
            true => Vec::new(),
            false => vec![(n, 1.0 - share), (n + 1, share)],
        };
        return Cover { cells, outside: f64::from(u8::from(outside)), nearest };
    }
    let mut cells: Vec<(usize, f64)> = Vec::new();
    for n in below(low)..=below(high) {
        let [a, b] = [nodes[n].max(low), nodes[n + 1].min(high)];
        if b <= a {
            continue;
        }
        let share = (0.5 * (a + b) - nodes[n]) / (nodes[n + 1] - nodes[n]);
        let part = (b - a) / (high - low);
        add(&mut cells, n, part * (1.0 - share));
        add(&mut cells, n + 1, part * share);
    }
    complete(cells, nearest)
}

/// Combines the cells of two axes.
fn product([x, y]: [Cover; 2], index: impl Fn(usize, usize) -> usize) -> Cover {
    let of_row = |&(j, b): &(usize, f64)| {
        let column = |&(i, a): &(usize, f64)| (index(i, j), a * b);
        x.cells.iter().map(column).collect::<Vec<_>>()
    };
    let cells = y.cells.iter().flat_map(of_row).collect();
    complete(cells, index(x.nearest, y.nearest))
}

/// Weights of rings in a region, from the distances of its middle, nearest and farthest point and
/// its fraction within a radius.
fn rings(
    count: usize,
    radius: f64,
    distances: [f64; 3],
    part_within: impl Fn(f64) -> f64,
) -> Cover {
    let width = radius / count as f64;
    let ring = |at: f64| ((at / width) as usize).min(count - 1);
    let [nearest, first, last] = distances.map(ring);
    let within = |ring: usize| part_within(width * ring as f64);
    let part = |ring: usize| (ring, within(ring + 1) - within(ring));
    complete((first..=last).map(part).collect(), nearest)
}

/// Means of functions linear in the radius: between two nodes `∫ (r − r₁)/(r₂ − r₁) dA`, with the
/// area A(r) within r, is `A(r₂) − ∫ A dr/(r₂ − r₁)`. A is smooth except at a few kinks.
fn radial_hats(
    nodes: &[f64],
    [middle, least, most]: [f64; 3],
    bends: &[f64],
    within: impl Fn(f64) -> f64,
) -> Cover {
    const POINTS: usize = 4;
    let last = nodes.len() - 1;
    let below = |at: f64| nodes.partition_point(|&node| node <= at).clamp(1, last) - 1;
    if least == most {
        return hats(nodes, [middle; 2]);
    }
    let mut cells = Vec::new();
    for n in below(least)..=below(most) {
        let [a, b] = [nodes[n], nodes[n + 1]];
        let mut ends = vec![a, b];
        ends.extend(bends.iter().map(|bend| bend.clamp(a, b)));
        ends.sort_by(f64::total_cmp);
        let pieces = ends.windows(2).filter(|ends| ends[1] > ends[0]);
        let points = pieces.flat_map(|ends| gauss_on(POINTS, ends[0], ends[1]));
        let mean = points.map(|(r, w)| w * within(r)).sum::<f64>() / (b - a);
        add(&mut cells, n, mean - within(a));
        add(&mut cells, n + 1, within(b) - mean);
    }
    complete(cells, hats(nodes, [middle; 2]).nearest)
}

/// Radii at which a circle about the origin meets an edge or a corner of a rectangle.
fn bends([x, y]: [[f64; 2]; 2]) -> Vec<f64> {
    let corners = x.into_iter().flat_map(|x| y.map(|y| x.hypot(y)));
    x.into_iter().chain(y).map(f64::abs).chain(corners).collect()
}

/// Distances from the origin of a rectangle's middle, of its nearest and of its farthest point.
fn distances([x, y]: [[f64; 2]; 2]) -> [f64; 3] {
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    let nearest = |[low, high]: [f64; 2]| low.max(-high).max(0.0);
    let farthest = |[low, high]: [f64; 2]| high.max(-low);
    [middle(x).hypot(middle(y)), nearest(x).hypot(nearest(y)), farthest(x).hypot(farthest(y))]
}

/// Fraction within a radius of a rectangle, of a line along x if its height is zero, or of a point.
fn part_within(radius: f64, [x, y]: [[f64; 2]; 2]) -> f64 {
    let [width, height] = [x, y].map(|[low, high]| high - low);
    if height > 0.0 && width > 0.0 {
        area_within(radius, [x, y]) / (width * height)
    } else if width > 0.0 {
        length_within(radius, x, y[0]) / width
    } else {
        f64::from(u8::from(x[0].hypot(y[0]) < radius))
    }
}

fn add(cells: &mut Vec<(usize, f64)>, cell: usize, weight: f64) {
    match cells.last_mut() {
        Some((last, sum)) if *last == cell => *sum += weight,
        _ => cells.push((cell, weight)),
    }
}

/// Assigns the remainder to the outside.
fn complete(mut cells: Vec<(usize, f64)>, nearest: usize) -> Cover {
    cells.retain(|&(_, weight)| weight > 0.0);
    let inside: f64 = cells.iter().map(|&(_, weight)| weight).sum();
    // Rounding does not count as outside.
    const ROUNDING: f64 = 1e-9;
    if inside > 1.0 - ROUNDING {
        cells.iter_mut().for_each(|(_, weight)| *weight /= inside);
        return Cover { cells, outside: 0.0, nearest };
    }
    Cover { cells, outside: 1.0 - inside, nearest }
}

#[cfg(test)]
mod tests {
    use super::super::cells::Domain;
    use super::*;

    fn grids() -> [WallCells; 4] {
        [
            WallCells::Rings { count: 5, radius: 2.0 },
            WallCells::Tiles { count: [4, 3], size: [4.0, 2.0] },
            WallCells::Nodes { x: vec![-2.0, -0.5, 0.25, 2.0], y: vec![-1.0, 0.5, 1.0] },
            WallCells::RadialNodes { r: vec![0.0, 0.25, 1.0, 2.0] },
        ]
    }

    fn square([x, y]: [f64; 2], half: [f64; 2]) -> [[f64; 2]; 2] {
        [[x - half[0], x + half[0]], [y - half[1], y + half[1]]]
    }

    #[test]
    fn weights_sum_to_one() {
        for cells in grids() {
            for half in [[0.0; 2], [0.3, 0.0], [0.01, 0.02], [0.4, 0.4], [3.0, 3.0]] {
                for at in [[0.0, 0.0], [1.3, -0.7], [-2.0, 1.0], [9.0, 0.1], [-0.1, -8.0]] {
                    let cover = cells.cover(square(at, half));
                    let sum = cover.outside + cover.mean(|_| 1.0) - cover.outside;
                    assert!((sum - 1.0).abs() < 1e-12, "{cells:?} {at:?} {half:?} {cover:?}");
                    assert!(cover.cells.iter().all(|c| c.0 < cells.len() && c.1 >= 0.0));
                }
            }
        }
    }

    #[test]
    fn squares_tiling_the_wall_reproduce_cell_areas() {
        for cells in grids() {
            let (width, mut found) = (0.125, vec![0.0; cells.len()]);
            for i in -20..20 {
                for j in -20..20 {
                    let at = [i, j].map(|n| (f64::from(n) + 0.5) * width);
                    for (cell, weight) in cells.cover(square(at, [0.5 * width; 2])).cells {
                        found[cell] += width * width * weight;
                    }
                }
            }
            for (found, area) in found.iter().zip(cells.areas(Domain::whole(3))) {
                assert!((found / area - 1.0).abs() < 1e-4, "{cells:?}: {found} {area}");
            }
        }
    }

    #[test]
    fn rings_tiling_the_wall_reproduce_cell_areas() {
        let [cells, _, _, nodes] = grids();
        for cells in [cells, nodes] {
            let (width, mut found) = (0.3, vec![0.0; cells.len()]);
            for n in 0..10 {
                let [inner, outer] = [n, n + 1].map(|n| width * f64::from(n));
                let cover = cells.cover_ring([inner, outer]);
                let sum = cover.cells.iter().map(|cell| cell.1).sum::<f64>() + cover.outside;
                assert!((sum - 1.0).abs() < 1e-12, "{n}: {cover:?}");
                let area = std::f64::consts::PI * (outer * outer - inner * inner);
                cover.cells.iter().for_each(|&(cell, weight)| found[cell] += area * weight);
            }
            for (found, area) in found.iter().zip(cells.areas(Domain::whole(3))) {
                assert!((found / area - 1.0).abs() < 1e-12, "{cells:?}: {found} {area}");
            }
        }
    }

    #[test]
    fn mean_of_a_linear_field_is_its_central_value() {
        let [_, _, cells, _] = grids();
        let y = [-1.0, 0.5, 1.0];
        let WallCells::Nodes { x, .. } = &cells else { unreachable!() };
        let plane = |x: f64, y: f64| 3.0 - 2.0 * x + 0.5 * y;
        for (at, half) in
            [([-1.7, 0.7], 0.2), ([0.1, 0.2], 0.7), ([1.9, 0.0], 0.1), ([1.0, 0.3], 0.0)]
        {
            let cover = cells.cover(square(at, [half; 2]));
            let value = cover.mean(|c| plane(x[c % x.len()], y[c / x.len()]));
            assert!((value - plane(at[0], at[1])).abs() < 1e-13, "{at:?}");
        }
    }

    #[test]
    fn cell_order_matches_variable_order() {
        let [rings, tiles, ..] = grids();
        let cell = |cells: &WallCells, at| cells.cover(square(at, [0.0; 2])).cells[0].0;
        assert_eq!(cell(&rings, [0.0, 0.5]), 1);
        assert_eq!(cell(&tiles, [-1.5, 0.0]), 1);
        assert_eq!(cell(&tiles, [1.5, -0.9]), 9);
    }
}

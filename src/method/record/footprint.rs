//! Rings about the impact position of a drop, on the cells of a wall.
//!
//! A ring is represented by equidistant points on circles that halve its area, with equal weights, which are summed in
//! each cell. So everything arrives where cells partition unity.

use std::f64::consts::TAU;

use crate::port::WallCells;

/// Number of circles on which the points of a ring lie.
const CIRCLES: usize = 2;
/// Number of points on the innermost circles; farther out their number grows to keep the distance.
const FEWEST_POINTS: usize = 8;

/// The rings of one drop.
pub struct Footprint {
    pub rings: Vec<Ring>,
}

/// A ring: its parts and the outside part sum to 1.
#[derive(Default)]
pub struct Ring {
    pub parts: Vec<Part>,
    /// Part beyond the outermost cells, its outward direction, and the nearest cell.
    pub outside: Vec<Part>,
}

/// A part of a ring in a cell.
pub struct Part {
    pub cell: usize,
    pub weight: f64,
    /// Weight times the outward direction; for cells that are rings themselves, x is along their
    /// radius.
    pub outward: [f64; 2],
}

impl Footprint {
    pub fn of(cells: &WallCells, centre: [f64; 2], rings: usize, radius: f64) -> Self {
        let width = radius / rings as f64;
        let ring = |n: usize| {
            let mut ring = Ring::default();
            for circle in 0..CIRCLES {
                let [inner, outer] = [n, n + 1].map(|n| (width * n as f64).powi(2));
                let share = (circle as f64 + 0.5) / CIRCLES as f64;
                let at = (inner + share * (outer - inner)).sqrt();
                ring.add_circle(cells, centre, at, width);
            }
            Ring { parts: by_cell(ring.parts), outside: by_cell(ring.outside) }
        };
        Self { rings: (0..rings).map(ring).collect() }
    }
}

impl Ring {
    /// Mean of a value over the ring's cells; over the nearest cells if the ring covers none.
    pub fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        let parts = if self.parts.is_empty() { &self.outside } else { &self.parts };
        let all: f64 = parts.iter().map(|part| part.weight).sum();
        parts.iter().map(|part| part.weight * value(part.cell)).sum::<f64>() / all
    }

    fn add_circle(&mut self, cells: &WallCells, centre: [f64; 2], radius: f64, width: f64) {
        if cells.are_radial() {
            return self.add(cells, [radius, 0.0], [1.0, 0.0], 1.0 / CIRCLES as f64);
        }
        let octants = (TAU * radius / width / FEWEST_POINTS as f64).ceil().max(1.0) as usize;
        let count = FEWEST_POINTS * octants;
        let weight = 1.0 / (CIRCLES * count) as f64;
        for n in 0..count {
            let (sine, cosine) = (TAU * (n as f64 + 0.5) / count as f64).sin_cos();
            let at = [centre[0] + radius * cosine, centre[1] + radius * sine];
            self.add(cells, at, [cosine, sine], weight);
        }
    }

    fn add(&mut self, cells: &WallCells, at: [f64; 2], outward: [f64; 2], weight: f64) {
        let part = |cell: usize, share: f64| {
            let weight = weight * share;
            Part { cell, weight, outward: outward.map(|x| weight * x) }
        };
        if let WallCells::Nodes { x, y } = cells
            && let (Some(along_x), Some(along_y)) = (hats(x, at[0]), hats(y, at[1]))
        {
            for (j, b) in along_y {
                for (i, a) in along_x {
                    self.parts.push(part(i + j * x.len(), a * b));
                }
            }
            return;
        }
        let cover = cells.cover(at.map(|x| [x; 2]));
        self.parts.extend(cover.cells.iter().map(|&(cell, share)| part(cell, share)));
        if cover.outside > 0.0 {
            self.outside.push(part(cover.nearest, cover.outside));
        }
    }
}

/// Sums the parts in each cell.
fn by_cell(mut parts: Vec<Part>) -> Vec<Part> {
    parts.sort_by_key(|part| part.cell);
    parts.dedup_by(|next, sum| {
        let same = next.cell == sum.cell;
        if same {
            sum.weight += next.weight;
            (0..2).for_each(|axis| sum.outward[axis] += next.outward[axis]);
        }
        same
    });
    parts
}

/// The two functions linear between nodes that are nonzero at a place; `None` beyond the nodes.
fn hats(nodes: &[f64], at: f64) -> Option<[(usize, f64); 2]> {
    let last = nodes.len().checked_sub(1).filter(|&last| last > 0)?;
    if at < nodes[0] || at > nodes[last] {
        return None;
    }
    let n = nodes.partition_point(|&node| node <= at).clamp(1, last) - 1;
    let share = (at - nodes[n]) / (nodes[n + 1] - nodes[n]);
    Some([(n, 1.0 - share), (n + 1, share)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> WallCells {
        let nodes: Vec<f64> = (0..41).map(|n| -2.0 + 0.1 * f64::from(n)).collect();
        WallCells::Nodes { x: nodes.clone(), y: nodes }
    }

    /// The moments of a disc's contributions to a fine grid are those of a disc.
    #[test]
    fn deposits_preserve_amounts_and_moments() {
        let cells = grid();
        let WallCells::Nodes { x, .. } = &cells else { unreachable!() };
        let centre = [0.43, -0.61];
        let footprint = Footprint::of(&cells, centre, 10, 1.0);
        let mut moments = [0.0; 4];
        let mut outward = [0.0; 2];
        for (n, ring) in footprint.rings.iter().enumerate() {
            let share = (2 * n + 1) as f64 / 100.0;
            assert!(ring.outside.is_empty());
            for part in &ring.parts {
                let [dx, dy] =
                    [x[part.cell % x.len()] - centre[0], x[part.cell / x.len()] - centre[1]];
                let amount = share * part.weight;
                moments[0] += amount;
                moments[1] += amount * dx;
                moments[2] += amount * dy;
                moments[3] += amount * (dx * dx + dy * dy);
                outward[0] += share * part.outward[0];
                outward[1] += share * part.outward[1];
            }
        }
        assert!((moments[0] - 1.0).abs() < 1e-13);
        assert!(moments[1].abs() < 1e-13 && moments[2].abs() < 1e-13);
        // R²/2, plus the contribution of linear functions on a grid: at most h²/6 along each axis.
        assert!((moments[3] - 0.5).abs() < 0.1_f64.powi(2) / 3.0 + 1e-2, "{}", moments[3]);
        assert!(outward.iter().all(|x| x.abs() < 1e-13));
    }

    #[test]
    fn amounts_beyond_an_edge_are_outside() {
        let footprint = Footprint::of(&grid(), [2.0, 0.0], 5, 1.0);
        for ring in &footprint.rings {
            let [inside, outside] = [&ring.parts, &ring.outside]
                .map(|parts| parts.iter().map(|p| p.weight).sum::<f64>());
            assert!((inside - 0.5).abs() < 1e-12 && (outside - 0.5).abs() < 1e-12);
            assert!((ring.mean(|_| 300.0) - 300.0).abs() < 1e-10);
        }
    }

    #[test]
    fn rings_map_to_the_same_rings() {
        let cells = WallCells::Rings { count: 5, radius: 1.0 };
        let footprint = Footprint::of(&cells, [0.0; 2], 5, 1.0);
        for (n, ring) in footprint.rings.iter().enumerate() {
            assert!(ring.parts.iter().all(|part| part.cell == n && part.outward[1] == 0.0));
        }
    }
}

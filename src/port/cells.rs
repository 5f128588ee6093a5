//! The wall below bodies that fall, cut into cells that exchange heat and momentum with them.

use std::f64::consts::PI;

/// Division of the wall into cells.
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

/// Heat and momentum that the cells of the wall received during one step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WallExchange {
    /// Length of the step [s].
    pub duration: f64,
    /// Heat of each cell [J].
    pub heat: Vec<f64>,
    /// Impulse along x, y, z [N s] of each cell; negative z points into the wall. For rings and
    /// radial nodes, x is the radial component and y is zero.
    pub impulse: Vec<[f64; 3]>,
    /// Heat and impulse beyond the outermost cells.
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

    /// Returns true if a position's cells depend on its distance from the origin alone.
    pub fn are_radial(&self) -> bool {
        matches!(self, WallCells::Rings { .. } | WallCells::RadialNodes { .. })
    }

    /// Returns true if nothing lies beyond the outermost cells. The cells of a body end with it; a
    /// wall of rings or tiles continues at the temperature of its outermost cells.
    pub fn end_with_the_body(&self) -> bool {
        matches!(self, WallCells::Nodes { .. } | WallCells::RadialNodes { .. })
    }

    /// Area of each cell in a part of the wall [m²]; for nodal functions, their integral.
    pub fn areas(&self, domain: Domain) -> Vec<f64> {
        let length = |axis: usize, low: f64, high: f64| match domain.along[axis] {
            Some([first, last]) => (high.min(last) - low.max(first)).max(0.0),
            None => 1.0,
        };
        match self {
            WallCells::Rings { count, radius } => {
                let inner = PI * (radius / *count as f64).powi(2) / domain.images;
                (0..*count).map(|ring| inner * (2 * ring + 1) as f64).collect()
            }
            WallCells::Tiles { count, size } => {
                let lengths = [0, 1].map(|axis| {
                    let width = size[axis] / count[axis] as f64;
                    let place = |n: usize| width * (n as f64 - 0.5 * count[axis] as f64);
                    let tile = |n: usize| length(axis, place(n), place(n + 1));
                    (0..count[axis]).map(tile).collect::<Vec<f64>>()
                });
                let [x, y] = &lengths;
                x.iter().flat_map(|a| y.iter().map(move |b| a * b)).collect()
            }
            WallCells::Nodes { x, y } => {
                let [x, y] = [(0, x), (1, y)].map(|(axis, nodes)| match domain.along[axis] {
                    Some(ends) => hat_integrals(nodes, ends, |_| 1.0),
                    None => vec![1.0],
                });
                y.iter().flat_map(|b| x.iter().map(move |a| a * b)).collect()
            }
            WallCells::RadialNodes { r } => {
                hat_integrals(r, Domain::WHOLE, |r| 2.0 * PI * r / domain.images)
            }
        }
    }

    /// The middle of each cell, or the node of its function [m]; for rings along x.
    pub fn middles(&self) -> Vec<[f64; 2]> {
        match self {
            WallCells::Rings { count, radius } => {
                let width = radius / *count as f64;
                (0..*count).map(|ring| [width * (ring as f64 + 0.5), 0.0]).collect()
            }
            WallCells::RadialNodes { r } => r.iter().map(|&r| [r, 0.0]).collect(),
            WallCells::Tiles { .. } | WallCells::Nodes { .. } => {
                (0..self.len()).map(|cell| self.middle(cell)).collect()
            }
        }
    }

    /// The middle of a tile, or a node [m].
    fn middle(&self, cell: usize) -> [f64; 2] {
        match self {
            WallCells::Tiles { count, size } => {
                let place = |n: usize, axis: usize| {
                    (n as f64 + 0.5 - 0.5 * count[axis] as f64) * size[axis] / count[axis] as f64
                };
                [place(cell / count[1], 0), place(cell % count[1], 1)]
            }
            WallCells::Nodes { x, y } => [x[cell % x.len()], y[cell / x.len()]],
            WallCells::Rings { .. } | WallCells::RadialNodes { .. } => [0.0; 2],
        }
    }

    /// Cells that receive the image of a cell, and their weights; `signs` reflect x and y.
    pub fn image(&self, cell: usize, signs: [f64; 2]) -> Vec<(usize, f64)> {
        if signs == [1.0; 2] {
            return vec![(cell, 1.0)];
        }
        if self.are_radial() {
            return vec![(cell, 1.0)];
        }
        let middle = self.middle(cell);
        let at = [0, 1].map(|axis| [signs[axis] * middle[axis]; 2]);
        let cover = self.cover(at);
        match cover.cells.is_empty() {
            // The body extends less far on this side.
            true => vec![(cover.nearest, 1.0)],
            false => cover.cells,
        }
    }
}

/// A region of the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Domain {
    /// Range along x and y [m]; `None` along the axis that a plane model lacks, where it is a metre
    /// deep.
    pub along: [Option<[f64; 2]>; 2],
    /// Number of such regions in a circle about the origin.
    pub images: f64,
}

impl Domain {
    const WHOLE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// The entire wall below a model of two or three dimensions.
    pub fn whole(dimension: usize) -> Self {
        Self { along: [Some(Self::WHOLE), (dimension == 3).then_some(Self::WHOLE)], images: 1.0 }
    }
}

impl WallExchange {
    /// Adds the exchange of another step.
    pub fn add(&mut self, other: &Self) {
        self.duration += other.duration;
        self.heat_outside += other.heat_outside;
        self.heat.iter_mut().zip(&other.heat).for_each(|(sum, heat)| *sum += heat);
        let cells = self.impulse.iter_mut().zip(&other.impulse);
        for (sum, impulse) in cells.chain([(&mut self.impulse_outside, &other.impulse_outside)]) {
            sum.iter_mut().zip(impulse).for_each(|(sum, part)| *sum += part);
        }
    }

    /// An amount of the step as a mean rate; zero before the first step.
    pub fn rate(&self, amount: f64) -> f64 {
        if self.duration > 0.0 { amount / self.duration } else { 0.0 }
    }

    pub fn none(cells: usize) -> Self {
        let heat = vec![0.0; cells];
        Self { heat, impulse: vec![[0.0; 3]; cells], ..Self::default() }
    }
}

/// Integrals, between two ends, of the functions linear between nodes, times a linear weight.
fn hat_integrals(nodes: &[f64], [first, last]: [f64; 2], weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut integrals = vec![0.0; nodes.len()];
    for (n, ends) in nodes.windows(2).enumerate() {
        let [a, b] = [ends[0].max(first), ends[1].min(last)];
        if b <= a {
            continue;
        }
        // Simpson's rule is exact for the product.
        for (x, share) in [(a, 1.0), (0.5 * (a + b), 4.0), (b, 1.0)] {
            let part = (b - a) / 6.0 * share * weight(x);
            let above = (x - ends[0]) / (ends[1] - ends[0]);
            integrals[n] += part * (1.0 - above);
            integrals[n + 1] += part * above;
        }
    }
    integrals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_sum_to_the_whole() {
        let whole = PI * 4.0;
        for (cells, whole) in [
            (WallCells::Rings { count: 5, radius: 2.0 }, whole),
            (WallCells::Tiles { count: [4, 3], size: [4.0, 2.0] }, 8.0),
            (WallCells::Nodes { x: vec![-2.0, -0.5, 2.0], y: vec![-1.0, 0.5, 1.0] }, 8.0),
            (WallCells::RadialNodes { r: vec![0.0, 0.25, 1.0, 2.0] }, whole),
        ] {
            let areas = cells.areas(Domain::whole(3));
            assert_eq!(areas.len(), cells.len());
            let ends = [0.0, f64::INFINITY];
            let quarter = Domain { along: [Some(ends); 2], images: 4.0 };
            let part = cells.areas(quarter).iter().sum::<f64>();
            assert!((part - 0.25 * whole).abs() < 1e-13, "{cells:?}");
            assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-13, "{cells:?}");
        }
    }
}

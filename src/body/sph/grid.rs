//! Points of a grid along a model's axes.

use super::images::Ends;

/// Points of a bin along each of its edges: bins are what is looked for first.
const BIN: i32 = 4;
/// Points along an edge of the cells into which bins are divided.
const CELL: i32 = 2;

/// A grid that fits between the planes and into the periods of a model; along open axes it has an
/// origin that may move.
#[derive(Debug, Clone)]
pub struct Grid {
    axes: Vec<(usize, Axis)>,
    /// Distance of points over H; 1 along an axis that a plane model lacks.
    pub spacing: [f64; 3],
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Axis {
    Free,
    /// From the plane at 0 on.
    Above,
    /// Between two planes, or within a period, in this many bins.
    Bins {
        count: i32,
        round: bool,
    },
}

impl Grid {
    /// Points at most `spacing` apart, lengths over H.
    pub fn of(ends: [Ends; 3], spacing: f64, dimension: usize) -> Self {
        let axes: Vec<_> = if dimension == 2 { vec![0, 2] } else { vec![0, 1, 2] };
        let mut distances = [1.0; 3];
        let bins = |length: f64| (length / (f64::from(BIN) * spacing)).ceil();
        let axes = axes.into_iter().map(|a| {
            let (axis, distance) = match ends[a] {
                Ends::Planes { near: false, far: None } => (Axis::Free, spacing),
                Ends::Planes { far: None, .. } => (Axis::Above, spacing),
                Ends::Planes { far: Some(length), .. } | Ends::Period(length) => {
                    let count = bins(length);
                    let round = matches!(ends[a], Ends::Period(_));
                    let axis = Axis::Bins { count: count as i32, round };
                    (axis, length / (count * f64::from(BIN)))
                }
            };
            distances[a] = distance;
            (a, axis)
        });
        let axes = axes.collect();
        Self { axes, spacing: distances }
    }

    /// Whether the grid's origin may move along an axis.
    pub fn is_free(&self, axis: usize) -> bool {
        self.axes.contains(&(axis, Axis::Free))
    }

    /// What a point stands for, over H to the power of the dimension.
    pub fn volume(&self) -> f64 {
        self.axes.iter().map(|&(a, _)| self.spacing[a]).product()
    }

    /// What a point of the plane z = 0 stands for.
    pub fn area(&self) -> f64 {
        self.volume() / self.spacing[2]
    }

    /// Half the diagonal of a cell.
    pub fn cell_radius(&self) -> f64 {
        let half = |&(a, _): &(usize, Axis)| 0.5 * f64::from(CELL) * self.spacing[a];
        self.axes.iter().map(|axis| half(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// All bins in which points are, and those beside them, once each.
    pub fn bins(&self, points: &[[f64; 3]], origin: [f64; 3]) -> Vec<[i32; 3]> {
        let bin = |x: &[f64; 3]| {
            let mut bin = [0; 3];
            for &(a, _) in &self.axes {
                bin[a] = ((x[a] - origin[a]) / (f64::from(BIN) * self.spacing[a])).floor() as i32;
            }
            bin
        };
        let mut bins: Vec<[i32; 3]> = points.iter().map(bin).collect();
        for &(a, axis) in &self.axes {
            bins.sort_unstable();
            bins.dedup();
            let beside = |bin: &[i32; 3]| {
                let bin = *bin;
                (-1..=1).filter_map(move |step| {
                    let mut bin = bin;
                    bin[a] = axis.fitted(bin[a] + step)?;
                    Some(bin)
                })
            };
            bins = bins.iter().flat_map(beside).collect();
        }
        bins.sort_unstable();
        bins.dedup();
        bins
    }

    /// The cells of a bin.
    pub fn cells(&self, bin: [i32; 3]) -> Vec<[i32; 3]> {
        self.divided(bin, BIN / CELL)
    }

    /// The points of a cell.
    pub fn points(&self, cell: [i32; 3]) -> Vec<[i32; 3]> {
        self.divided(cell, CELL)
    }

    fn divided(&self, whole: [i32; 3], parts: i32) -> Vec<[i32; 3]> {
        let mut all = vec![[0; 3]];
        for &(a, _) in &self.axes {
            let part = |all: [i32; 3], k: i32| {
                let mut part = all;
                part[a] = parts * whole[a] + k;
                part
            };
            all = all.iter().flat_map(|&all| (0..parts).map(move |k| part(all, k))).collect();
        }
        all
    }

    /// The middle of a cell about the origin.
    pub fn middle(&self, cell: [i32; 3]) -> [f64; 3] {
        self.placed(cell, f64::from(CELL))
    }

    /// A point about the origin.
    pub fn place(&self, point: [i32; 3]) -> [f64; 3] {
        self.placed(point, 1.0)
    }

    fn placed(&self, number: [i32; 3], size: f64) -> [f64; 3] {
        let mut place = [0.0; 3];
        for &(a, _) in &self.axes {
            place[a] = size * self.spacing[a] * (f64::from(number[a]) + 0.5);
        }
        place
    }
}

impl Axis {
    /// The number of a bin, if there is one.
    fn fitted(self, bin: i32) -> Option<i32> {
        match self {
            Axis::Free => Some(bin),
            Axis::Above => (bin >= 0).then_some(bin),
            Axis::Bins { count, round: true } => Some(bin.rem_euclid(count)),
            Axis::Bins { count, round: false } => (0..count).contains(&bin).then_some(bin),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPEN: Ends = Ends::Planes { near: false, far: None };
    const MIRROR: Ends = Ends::Planes { near: true, far: None };

    #[test]
    fn a_grid_fits_into_its_model() {
        let grid = Grid::of([Ends::Period(2.1), MIRROR, OPEN], 0.2, 3);
        assert!((grid.spacing[0] * 12.0 - 2.1).abs() < 1e-14 && grid.spacing[1] == 0.2);
        assert!(grid.is_free(2) && !grid.is_free(0) && !grid.is_free(1));
        let bins = grid.bins(&[[2.0, 0.1, -0.1]], [0.0, 0.0, 0.05]);
        let mut along_x: Vec<i32> = bins.iter().map(|bin| bin[0]).collect();
        along_x.dedup();
        assert_eq!(along_x, [0, 1, 2]);
        assert!(bins.iter().all(|bin| (0..=1).contains(&bin[1]) && (-2..=0).contains(&bin[2])));
        assert_eq!(bins.len(), 3 * 2 * 3);
    }

    #[test]
    fn cells_hold_the_points_of_their_bin_once() {
        for (dimension, count) in [(2, 16), (3, 64)] {
            let grid = Grid::of([OPEN; 3], 0.1, dimension);
            let cells = grid.cells([-1, 0, 2]);
            let mut points = Vec::new();
            for cell in cells {
                let middle = grid.middle(cell);
                for point in grid.points(cell) {
                    let place = grid.place(point);
                    let square = (0..3).map(|a| (place[a] - middle[a]).powi(2)).sum::<f64>();
                    assert!(square.sqrt() < 0.5 * grid.cell_radius() + 1e-12);
                    points.push(point);
                }
            }
            points.sort_unstable();
            points.dedup();
            assert_eq!(points.len(), count);
            assert!((grid.volume() - 0.1f64.powi(dimension as i32)).abs() < 1e-15);
        }
    }
}

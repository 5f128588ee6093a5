//! Points of a grid along a model's axes.

use super::images::Ends;
use super::lanes::WIDTH;
use super::order::Bounds;

/// Number of points along each edge of a bin. The points of two edges form a sheet, which fills a
/// vector.
const BIN: i32 = 4;
const _: () = assert!((BIN * BIN) as usize == WIDTH);

/// Positions of sixteen points about a middle, and the half extent of all of them, along x, y, z.
#[derive(Debug, Clone)]
pub struct Spread {
    pub along: [[f64; WIDTH]; 3],
    pub half: [f64; 3],
}

impl Spread {
    fn of(along: [[f64; WIDTH]; 3]) -> Self {
        Self { along, half: along.map(|places| places.into_iter().fold(0.0, f64::max)) }
    }

    /// The bounding box of all points.
    pub fn bounds(&self, middle: [f64; 3]) -> Bounds {
        Bounds { low: middle, high: middle }.widened(self.half)
    }
}

/// A grid that fits between the planes and into the periods of a model; along open axes its origin
/// may move.
#[derive(Debug, Clone)]
pub struct Grid {
    axes: Vec<(usize, Axis)>,
    /// Distance of points over H; 1 along the axis that a plane model lacks.
    pub spacing: [f64; 3],
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Axis {
    Free,
    /// Upward from the plane at 0.
    Above,
    /// Between two planes, or within a period, in this many bins.
    Bins {
        count: i32,
        round: bool,
    },
}

impl Grid {
    /// Grid of points at most `spacing` apart, lengths over H, along all axes or along x and z
    /// alone.
    pub fn of(ends: [Ends; 3], spacing: f64, axes: usize) -> Self {
        let axes: Vec<_> = if axes == 2 { vec![0, 2] } else { vec![0, 1, 2] };
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

    /// Returns true if the grid's origin may move along an axis.
    pub fn is_free(&self, axis: usize) -> bool {
        self.axes.contains(&(axis, Axis::Free))
    }

    /// Volume that a point represents, over H to the power of the dimension.
    pub fn volume(&self) -> f64 {
        self.axes.iter().map(|&(a, _)| self.spacing[a]).product()
    }

    /// Area of the plane z = 0 that a point represents.
    pub fn area(&self) -> f64 {
        self.volume() / self.spacing[2]
    }

    /// All bins within a distance of points along each axis, without duplicates.
    pub fn bins(&self, points: &[[f64; 3]], origin: [f64; 3], distance: f64) -> Vec<[i32; 3]> {
        let bin = |x: &[f64; 3]| {
            let mut bin = [0; 3];
            for &(a, _) in &self.axes {
                bin[a] = ((x[a] - origin[a]) / (f64::from(BIN) * self.spacing[a])).floor() as i32;
            }
            bin
        };
        let mut bins: Vec<[i32; 3]> = points.iter().map(bin).collect();
        // Neighbouring points are consecutive.
        bins.dedup();
        for &(a, axis) in &self.axes {
            bins.sort_unstable();
            bins.dedup();
            let beside = (distance / (f64::from(BIN) * self.spacing[a])).ceil() as i32;
            let near = |bin: &[i32; 3]| {
                let bin = *bin;
                (-beside..=beside).filter_map(move |step| {
                    let mut bin = bin;
                    bin[a] = axis.fitted(bin[a] + step)?;
                    Some(bin)
                })
            };
            bins = bins.iter().flat_map(near).collect();
        }
        bins.sort_unstable();
        bins.dedup();
        bins
    }

    /// Positions of a sheet's points about its middle.
    pub fn spread(&self) -> Spread {
        let mut spread = [[0.0; WIDTH]; 3];
        for (&(a, _), stride) in self.axes.iter().zip([1, BIN as usize]) {
            for (lane, place) in spread[a].iter_mut().enumerate() {
                *place = self.spacing[a] * along_bin(lane / stride % BIN as usize);
            }
        }
        Spread::of(spread)
    }

    /// Middles of the quarters of all sheets of a bin about its middle, sheet by sheet. A plane
    /// model has one sheet per bin; the entries of the others repeat it.
    pub fn quarters(&self) -> Spread {
        let mut quarters = [[0.0; WIDTH]; 3];
        for (n, &(a, _)) in self.axes.iter().enumerate() {
            for (lane, place) in quarters[a].iter_mut().enumerate() {
                *place = self.spacing[a]
                    * match n {
                        2 => along_bin(lane / 4),
                        _ => [-1.0, 1.0][lane >> n & 1],
                    };
            }
        }
        Spread::of(quarters)
    }

    /// Largest distance of a quarter's points from its middle.
    pub fn quarter_radius(&self) -> f64 {
        let half = |&(a, _): &(usize, Axis)| 0.5 * self.spacing[a];
        self.axes.iter().take(2).map(|axis| half(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// The middle of a bin about the origin.
    pub fn middle(&self, bin: [i32; 3]) -> [f64; 3] {
        let mut middle = [0.0; 3];
        for &(a, _) in &self.axes {
            middle[a] = f64::from(BIN) * self.spacing[a] * (f64::from(bin[a]) + 0.5);
        }
        middle
    }

    /// Middles of the sheets of a bin about the origin, the lowest first.
    pub fn sheets(&self, bin: [i32; 3]) -> Vec<[f64; 3]> {
        let middle = self.middle(bin);
        match self.axes.get(2) {
            None => vec![middle],
            Some(&(a, _)) => (0..BIN as usize)
                .map(|k| {
                    let mut sheet = middle;
                    sheet[a] += self.spacing[a] * along_bin(k);
                    sheet
                })
                .collect(),
        }
    }

    /// Middle of the sheet whose points lie in the wall below a bin's lowest sheet, and their
    /// number, from the first on; `None` for higher bins.
    pub fn at_wall(&self, bin: [i32; 3]) -> Option<([f64; 3], usize)> {
        if bin[2] != 0 {
            return None;
        }
        let [x, y, _] = self.middle(bin);
        // A sheet of a plane model extends above the wall.
        Some(match self.axes.len() {
            2 => ([x, y, -self.spacing[2] * along_bin(0)], BIN as usize),
            _ => ([x, y, 0.0], WIDTH),
        })
    }
}

/// Position of the k-th point of a bin about its middle, in distances of points.
fn along_bin(k: usize) -> f64 {
    k as f64 - 0.5 * f64::from(BIN - 1)
}

impl Axis {
    /// Canonical number of a bin, if it exists.
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
    fn grid_fits_planes_and_periods() {
        let grid = Grid::of([Ends::Period(2.1), MIRROR, OPEN], 0.2, 3);
        assert!((grid.spacing[0] * 12.0 - 2.1).abs() < 1e-14 && grid.spacing[1] == 0.2);
        assert!(grid.is_free(2) && !grid.is_free(0) && !grid.is_free(1));
        let bins = grid.bins(&[[2.0, 0.1, -0.1]], [0.0, 0.0, 0.05], 0.1);
        let mut along_x: Vec<i32> = bins.iter().map(|bin| bin[0]).collect();
        along_x.dedup();
        assert_eq!(along_x, [0, 1, 2]);
        assert!(bins.iter().all(|bin| (0..=1).contains(&bin[1]) && (-2..=0).contains(&bin[2])));
        assert_eq!(bins.len(), 3 * 2 * 3);
    }

    /// All points of the sheets of a bin about the origin, in units of their distance.
    fn points(grid: &Grid, bin: [i32; 3]) -> Vec<[i32; 3]> {
        let spread = grid.spread();
        let mut points = Vec::new();
        for middle in grid.sheets(bin) {
            for lane in 0..WIDTH {
                let place = [0, 1, 2].map(|a| (middle[a] + spread.along[a][lane]) / 0.1 - 0.5);
                points.push(place.map(|x| (1e6 * x).round() as i32));
            }
        }
        points
    }

    #[test]
    fn sheets_partition_the_points_of_a_bin() {
        for (dimension, count) in [(2, 16), (3, 64)] {
            let grid = Grid::of([OPEN; 3], 0.1, dimension);
            let along = |a: usize, first: i32| match (dimension, a) {
                (2, 1) => vec![-500_000],
                _ => (first..first + 4).map(|k| 1_000_000 * k).collect(),
            };
            let mut all = Vec::new();
            for x in along(0, -4) {
                for y in along(1, 0) {
                    all.extend(along(2, 8).into_iter().map(|z| [x, y, z]));
                }
            }
            let mut found = points(&grid, [-1, 0, 2]);
            found.sort_unstable();
            assert_eq!((found.len(), found), (count, all));
            assert!((grid.volume() - 0.1f64.powi(dimension as i32)).abs() < 1e-15);
        }
    }

    #[test]
    fn quarters_cover_the_points_of_a_sheet() {
        for dimension in [2, 3] {
            let grid = Grid::of([OPEN; 3], 0.1, dimension);
            let (spread, quarters) = (grid.spread(), grid.quarters());
            let bin = [0, 0, 0];
            for (n, middle) in grid.sheets(bin).iter().enumerate() {
                let of_sheet: Vec<[f64; 3]> = (4 * n..4 * n + 4)
                    .map(|k| [0, 1, 2].map(|a| grid.middle(bin)[a] + quarters.along[a][k]))
                    .collect();
                for lane in 0..WIDTH {
                    let point = [0, 1, 2].map(|a| middle[a] + spread.along[a][lane]);
                    let away =
                        |q: &[f64; 3]| (0..3).map(|a| (q[a] - point[a]).powi(2)).sum::<f64>();
                    let nearest = of_sheet.iter().map(away).fold(f64::INFINITY, f64::min).sqrt();
                    assert!((nearest - grid.quarter_radius()).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn wall_points_lie_below_the_lowest_sheet() {
        for (dimension, count) in [(2, 4), (3, WIDTH)] {
            let grid = Grid::of([OPEN, OPEN, MIRROR], 0.1, dimension);
            let (bin, spread) = ([1, 0, 0], grid.spread());
            assert_eq!(grid.at_wall([1, 0, 1]), None);
            let (middle, points) = grid.at_wall(bin).unwrap();
            assert_eq!(points, count);
            let lowest = grid.sheets(bin)[0];
            for lane in 0..points {
                let at = |middle: [f64; 3], a: usize| middle[a] + spread.along[a][lane];
                assert!(at(middle, 2).abs() < 1e-15 && (at(lowest, 2) - 0.05).abs() < 1e-15);
                assert!((0..2).all(|a| at(middle, a) == at(lowest, a)));
            }
        }
    }
}

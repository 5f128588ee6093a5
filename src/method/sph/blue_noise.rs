//! Random points with a minimum distance, distributed as evenly as that allows.

use crate::kernel::Kernel;
use crate::math::random::Random;

/// Minimum distance of Poisson-disk points over the side of the mean volume of a point, in two and
/// three dimensions, for the densest packing that this sampling reaches.
const DENSITY: [f64; 2] = [0.785, 0.8325];
/// Attempts around a point before it is abandoned (Bridson 2007, doi 10.1145/1278780.1278807).
const ATTEMPTS: usize = 30;

/// Returns points inside a sphere about the origin and their shares of its volume, inversely
/// proportional to the number density. The density includes points outside the sphere, so that its
/// surface is not mistaken for a void.
pub fn place(radius: f64, spacing: f64, dimension: usize) -> Vec<([f64; 3], f64)> {
    let least = DENSITY[dimension - 2] * spacing;
    let support = 3.0 * spacing;
    let all = sample(radius + support, least, dimension);
    let grid = Grid::new(&all, support);
    let squared = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>();
    let inside = all.iter().filter(|p| squared(p) < radius * radius);
    let volume = |p: &[f64; 3]| {
        let mut density = 0.0;
        grid.near(*p, |j| {
            let distance = (0..3).map(|a| (all[j][a] - p[a]).powi(2)).sum::<f64>().sqrt();
            density += Kernel::WendlandC2.value(distance, support, dimension);
        });
        1.0 / density
    };
    let points: Vec<([f64; 3], f64)> = inside.map(|p| (*p, volume(p))).collect();
    let sum: f64 = points.iter().map(|point| point.1).sum();
    points.into_iter().map(|(point, volume)| (point, volume / sum)).collect()
}

/// Poisson-disk points in a ball, no two nearer than `least`.
fn sample(radius: f64, least: f64, dimension: usize) -> Vec<[f64; 3]> {
    let mut random = Places(Random::of(0x9E37_79B9_7F4A_7C15));
    let mut points = vec![[0.0; 3]];
    let mut grid = Grid { side: least, cells: Default::default() };
    grid.insert([0.0; 3], 0);
    let mut active = vec![0];
    while !active.is_empty() {
        let pick = random.below(active.len());
        let centre: [f64; 3] = points[active[pick]];
        let found = (0..ATTEMPTS).find_map(|_| {
            let step = random.shell(least, dimension);
            let candidate = [0, 1, 2].map(|a| centre[a] + step[a]);
            let inside = candidate.iter().map(|x| x * x).sum::<f64>() < radius * radius;
            let mut free = inside;
            grid.near(candidate, |j| {
                let d2: f64 = (0..3).map(|a| (points[j][a] - candidate[a]).powi(2)).sum();
                free &= d2 >= least * least;
            });
            free.then_some(candidate)
        });
        match found {
            Some(point) => {
                active.push(points.len());
                grid.insert(point, points.len());
                points.push(point);
            }
            None => {
                active.swap_remove(pick);
            }
        }
    }
    points
}

/// Points sorted into cells of equal side.
struct Grid {
    side: f64,
    cells: std::collections::HashMap<[i64; 3], Vec<usize>>,
}

impl Grid {
    fn new(points: &[[f64; 3]], side: f64) -> Self {
        let mut grid = Self { side, cells: Default::default() };
        points.iter().enumerate().for_each(|(i, point)| grid.insert(*point, i));
        grid
    }

    fn cell(&self, point: [f64; 3]) -> [i64; 3] {
        point.map(|x| (x / self.side).floor() as i64)
    }

    fn insert(&mut self, point: [f64; 3], index: usize) {
        self.cells.entry(self.cell(point)).or_default().push(index);
    }

    /// Visits the points in the cells around a place. They include all points within one cell side.
    fn near(&self, point: [f64; 3], mut visit: impl FnMut(usize)) {
        let [i, j, k] = self.cell(point);
        for cell in (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]) {
            self.cells.get(&cell).into_iter().flatten().for_each(|&index| visit(index));
        }
    }
}

/// Random numbers, and places that follow from them.
struct Places(Random);

impl Places {
    fn below(&mut self, count: usize) -> usize {
        (self.0.number() * count as f64) as usize
    }

    /// Returns a random step with a length between `least` and twice that.
    fn shell(&mut self, least: f64, dimension: usize) -> [f64; 3] {
        loop {
            let mut step = [0.0; 3].map(|_: f64| 2.0 * self.0.number() - 1.0);
            if dimension == 2 {
                step[1] = 0.0;
            }
            let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.5..1.0).contains(&length) {
                return step.map(|x| 2.0 * least * x);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn density_is_about_one_point_per_cell() {
        for (dimension, volume) in [(2, PI), (3, 4.0 * PI / 3.0)] {
            let spacing = [0.03, 0.1][dimension - 2];
            let points = place(1.0, spacing, dimension);
            let filled = points.len() as f64 * spacing.powi(dimension as i32) / volume;
            assert!((filled - 1.0).abs() < 0.05, "{dimension}-D: {filled}");
        }
    }

    #[test]
    fn minimum_distance_between_points() {
        let points = place(1.0, 0.15, 3);
        for (i, (a, _)) in points.iter().enumerate() {
            for (b, _) in &points[..i] {
                let d2: f64 = (0..3).map(|n| (a[n] - b[n]).powi(2)).sum();
                assert!(d2.sqrt() >= DENSITY[1] * 0.15 - 1e-12);
            }
        }
    }
}

//! Random particles in a rectangle and their Voronoi cells.

use std::collections::HashMap;

use super::arrangement::{Cell, Pair, distance};
use crate::math::random::Random;

/// Least distance of random points over the spacing: they are then about as dense as hexagons.
const APART: f64 = 0.76;
/// Places that are tried for points, over the number of points that are wanted.
const TRIALS: usize = 60;
/// Lloyd's steps: moves of all points to the centres of their cells, which make cells more even.
const LLOYD_STEPS: usize = 3;
/// Distance over the spacing of points that bound a cell, at most.
const REACH: f64 = 3.5;
/// Facets shorter than this part of the spacing are no links.
const SHORTEST: f64 = 0.05;

/// A rectangle `[low, high]` along both axes [m].
#[derive(Debug, Clone, Copy)]
pub struct Rectangle {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

/// A corner of a cell, with the point beyond the edge that begins there; `None` at the rectangle's sides.
type Corner = ([f64; 2], Option<usize>);

/// Evenly distributed random points, none nearer to another than a part of the spacing [m] at first.
pub fn random_points(rectangle: Rectangle, spacing: f64, seed: u32) -> Vec<[f64; 2]> {
    let mut random = Random::of(u64::from(seed).wrapping_add(0x9e37_79b9_7f4a_7c15));
    let side = [0, 1].map(|axis| rectangle.high[axis] - rectangle.low[axis]);
    let wanted = (side[0] * side[1] / (0.75_f64.sqrt() * spacing * spacing)).round() as usize;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut grid = Grid::new(spacing);
    for _ in 0..TRIALS * wanted {
        if points.len() == wanted {
            break;
        }
        let point = [0, 1].map(|axis| rectangle.low[axis] + side[axis] * random.number());
        let is_free = |&i: &usize| distance(points[i], point) >= APART * spacing;
        if grid.around(point, APART * spacing).iter().all(is_free) {
            grid.insert(point, points.len());
            points.push(point);
        }
    }
    for _ in 0..LLOYD_STEPS {
        let cells = cells(&points, rectangle, spacing);
        for (point, cell) in points.iter_mut().zip(&cells) {
            *point = centre(cell);
        }
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Pairs of points whose cells share a facet, with its width [m], and the cells.
pub fn tessellate(
    points: &[[f64; 2]],
    rectangle: Rectangle,
    spacing: f64,
) -> (Vec<Pair>, Vec<Cell>) {
    let mut pairs = Vec::new();
    let corners = cells(points, rectangle, spacing);
    for (i, cell) in corners.iter().enumerate() {
        let mut own: Vec<Pair> = Vec::new();
        for (k, (corner, beyond)) in cell.iter().enumerate() {
            let next = cell[(k + 1) % cell.len()].0;
            let facet = distance(*corner, next);
            if let Some(j) = beyond.filter(|&j| j > i && facet > SHORTEST * spacing) {
                own.push(Pair { ends: [i, j], facet });
            }
        }
        own.sort_by_key(|pair| pair.ends);
        pairs.extend(own);
    }
    let measured = points.iter().zip(&corners).map(|(point, cell)| measure(*point, cell));
    (pairs, measured.collect())
}

/// Area of a cell and its polar second moment about a point, of the triangles between that point and the edges.
fn measure(point: [f64; 2], cell: &[Corner]) -> Cell {
    let (mut area, mut moment) = (0.0, 0.0);
    for (k, (corner, _)) in cell.iter().enumerate() {
        let next = cell[(k + 1) % cell.len()].0;
        let [a, b] = [corner, &next].map(|end| [end[0] - point[0], end[1] - point[1]]);
        let twice = a[0] * b[1] - a[1] * b[0];
        let product = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        area += 0.5 * twice;
        moment += twice * (product(a, a) + product(a, b) + product(b, b)) / 12.0;
    }
    Cell { area, moment }
}

/// The cell of each point: the rectangle, cut by the bisectors with the points around.
fn cells(points: &[[f64; 2]], rectangle: Rectangle, spacing: f64) -> Vec<Vec<Corner>> {
    let mut grid = Grid::new(spacing);
    points.iter().enumerate().for_each(|(i, point)| grid.insert(*point, i));
    let of_point = |(i, point): (usize, &[f64; 2])| {
        let [low, high] = [rectangle.low, rectangle.high];
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let mut cell: Vec<Corner> = corners.map(|corner| (corner, None)).to_vec();
        let mut near: Vec<usize> = grid.around(*point, REACH * spacing);
        near.retain(|&j| j != i);
        near.sort_by(|&a, &b| distance(*point, points[a]).total_cmp(&distance(*point, points[b])));
        for j in near {
            cut(&mut cell, *point, (j, points[j]));
        }
        cell
    };
    points.iter().enumerate().map(of_point).collect()
}

/// Cuts off the part of a cell nearer to another point.
fn cut(cell: &mut Vec<Corner>, own: [f64; 2], (other, place): (usize, [f64; 2])) {
    let beyond = |[x, y]: [f64; 2]| {
        let middle = [0.5 * (own[0] + place[0]), 0.5 * (own[1] + place[1])];
        (x - middle[0]) * (place[0] - own[0]) + (y - middle[1]) * (place[1] - own[1])
    };
    let sides: Vec<f64> = cell.iter().map(|(corner, _)| beyond(*corner)).collect();
    if sides.iter().all(|&side| side <= 0.0) {
        return;
    }
    let mut left = Vec::with_capacity(cell.len() + 1);
    for k in 0..cell.len() {
        let next = (k + 1) % cell.len();
        let ((a, edge), b) = (cell[k], cell[next].0);
        let at = |part: f64| [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];
        let crossing = at(sides[k] / (sides[k] - sides[next]));
        match (sides[k] <= 0.0, sides[next] <= 0.0) {
            (true, true) => left.push((a, edge)),
            (true, false) => {
                left.push((a, edge));
                left.push((crossing, Some(other)));
            }
            (false, true) => left.push((crossing, edge)),
            (false, false) => {}
        }
    }
    *cell = left;
}

/// Centre of area of a cell.
fn centre(cell: &[Corner]) -> [f64; 2] {
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    let origin = cell[0].0;
    for ends in cell.windows(2) {
        let [a, b] = [0, 1].map(|k| [ends[k].0[0] - origin[0], ends[k].0[1] - origin[1]]);
        let twice = a[0] * b[1] - a[1] * b[0];
        area += 0.5 * twice;
        moment = [0, 1].map(|axis| moment[axis] + twice * (a[axis] + b[axis]) / 6.0);
    }
    [0, 1].map(|axis| origin[axis] + moment[axis] / area)
}

/// Points by the squares of a grid.
struct Grid {
    size: f64,
    squares: HashMap<[i64; 2], Vec<(usize, [f64; 2])>>,
}

impl Grid {
    fn new(size: f64) -> Self {
        Self { size, squares: HashMap::new() }
    }

    fn square(&self, point: [f64; 2]) -> [i64; 2] {
        point.map(|x| (x / self.size).floor() as i64)
    }

    fn insert(&mut self, point: [f64; 2], number: usize) {
        self.squares.entry(self.square(point)).or_default().push((number, point));
    }

    /// Numbers of points nearer than a distance, by their squares.
    fn around(&self, point: [f64; 2], reach: f64) -> Vec<usize> {
        let ([x, y], steps) = (self.square(point), (reach / self.size).ceil() as i64);
        let squares =
            (x - steps..=x + steps).flat_map(|x| (y - steps..=y + steps).map(move |y| [x, y]));
        let all = squares.filter_map(|square| self.squares.get(&square)).flatten();
        all.filter(|(_, place)| distance(*place, point) <= reach).map(|(i, _)| *i).collect()
    }
}

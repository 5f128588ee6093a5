//! Round strands along a path of straight pieces; in a plane strips.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::{Blocks, COINCIDENT, Form, INNER, Mesh, Side, cells_along};

/// A circle, in a plane an interval, that is moved along a path. The strand is cut in half of the angle between two
/// pieces, so that its volume is that of a straight one of the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    form: Form,
    points: Vec<Vector3<f64>>,
    radius: f64,
}

/// Why a path makes no strand; points are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BadPath {
    /// Two points in a row at one place, of which this is the second.
    Twice { point: usize },
    /// A bend that leaves too little of a piece beside it on its inner side.
    Sharp { point: usize },
    /// Pieces from these points on that overlap.
    Meets { points: [usize; 2] },
}

/// Least length of a piece on the inner side of its bends, over that of its axis.
const LEFT: f64 = 0.1;
/// Places of the axis closer than a diameter belong to one bend within this length along it, over the radius.
const BEND: f64 = PI;
/// Bound on the distance of the outermost nodes from the axis, over the radius.
const RIM: f64 = 1.2;
/// Rounding over the radius.
const SLACK: f64 = 1e-9;

impl Sweep {
    pub fn new(form: Form, path: &[[f64; 3]], radius: f64) -> Self {
        Self { form, points: path.iter().map(|&at| at.into()).collect(), radius }
    }

    /// Finds what keeps the path from being that of a strand.
    pub fn fault(&self) -> Option<BadPath> {
        let pieces = 0..self.pieces();
        if let Some(piece) = pieces.clone().find(|&n| self.length(n) <= SLACK * self.radius) {
            return Some(BadPath::Twice { point: piece + 1 });
        }
        let bend = |point: usize| self.normal(point).dot(&self.direction(point.max(1) - 1));
        let back = (1..self.pieces()).find(|&point| bend(point) <= SLACK);
        let sharp = back.or_else(|| {
            let piece = pieces.clone().find(|&n| self.least(n) < LEFT * self.length(n))?;
            Some(if bend(piece + 1) < bend(piece) { piece + 1 } else { piece })
        });
        if let Some(point) = sharp {
            return Some(BadPath::Sharp { point });
        }
        let starts: Vec<f64> = pieces
            .clone()
            .scan(0.0, |sum, n| {
                let start = *sum;
                *sum += self.length(n);
                Some(start)
            })
            .collect();
        pieces.clone().find_map(|a| {
            let meets = |&b: &usize| {
                let ([u, v], distance) = self.nearest(a, b);
                let between = starts[b] + v * self.length(b) - starts[a] - u * self.length(a);
                distance < 2.0 * self.radius * (1.0 - SLACK) && between > BEND * self.radius
            };
            let other = (a + 2..self.pieces()).find(meets)?;
            Some(BadPath::Meets { points: [a, other] })
        })
    }

    /// Lowest and highest coordinates.
    pub fn ranges(&self) -> [[f64; 2]; 3] {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for piece in 0..self.pieces() {
            let along = self.direction(piece);
            for point in [piece, piece + 1] {
                let normal = self.normal(point);
                for (axis, [low, high]) in ranges.iter_mut().enumerate() {
                    // The rim is at w·h, for all w across the piece with the length of the radius.
                    let h = Vector3::ith(axis, 1.0) - normal * (along[axis] / along.dot(&normal));
                    let reach = self.radius * h.norm();
                    *low = low.min(self.points[point][axis] - reach);
                    *high = high.max(self.points[point][axis] + reach);
                }
            }
        }
        ranges
    }

    /// Volume, of a strip its area.
    pub fn volume(&self) -> f64 {
        let section = match self.form {
            Form::Solid => PI * self.radius * self.radius,
            _ => 2.0 * self.radius,
        };
        section * (0..self.pieces()).map(|piece| self.length(piece)).sum::<f64>()
    }

    /// Returns true if a place lies in the strand, to rounding.
    pub fn contains(&self, at: [f64; 3]) -> bool {
        let (at, slack) = (Vector3::from(at), SLACK * self.radius);
        (0..self.pieces()).any(|piece| {
            let from = at - self.points[piece];
            let along = self.direction(piece);
            (from - along * along.dot(&from)).norm() <= self.radius + slack
                && from.dot(&self.normal(piece)) >= -slack
                && (at - self.points[piece + 1]).dot(&self.normal(piece + 1)) <= slack
        })
    }

    /// Meshes the strand by cells of an order with nodes at some distance. The side of its first section is left, that
    /// of its last right.
    pub fn mesh(&self, order: usize, spacing: f64) -> Mesh {
        let section = self.section(order, spacing);
        let [first, second] = self.across();
        let place = |[u, v]: [f64; 2]| self.points[0] + first * u + second * v;
        let mut ends: Vec<Vector3<f64>> = section.nodes.iter().map(|&at| place(at)).collect();
        let mut blocks = Blocks::new((self.form, order), spacing);
        blocks.nodes.extend(ends.iter().map(|at| <[f64; 3]>::from(*at)));
        for piece in 0..self.pieces() {
            let next: Vec<_> = ends.iter().map(|&at| self.project(at, piece)).collect();
            let layers = cells_along(self.length(piece), order, spacing);
            for layer in 0..layers {
                let below = blocks.nodes.len() - ends.len();
                for copy in order * layer + 1..=order * (layer + 1) {
                    let part = copy as f64 / (order * layers) as f64;
                    let between = ends.iter().zip(&next).map(|(a, b)| a + (b - a) * part);
                    blocks.nodes.extend(between.map(<[f64; 3]>::from));
                }
                let offset = |copy: usize| (below + copy * ends.len()) as u32;
                let offsets: Vec<u32> = (0..=order).map(offset).collect();
                blocks.cells.extend(section.cells.iter().map(|cell| self.cell(cell, &offsets)));
            }
            ends = next;
        }
        let last = self.pieces();
        blocks.finish(|corners| {
            let is_at = |point: usize| {
                let (normal, slack) = (self.normal(point), COINCIDENT * spacing);
                let on_end = |at: &[f64; 3]| {
                    let from = Vector3::from(*at) - self.points[point];
                    from.dot(&normal).abs() < slack && from.norm() < RIM * self.radius
                };
                corners.iter().all(on_end)
            };
            Some(match () {
                () if is_at(0) => Side::Left,
                () if is_at(last) => Side::Right,
                () => Side::Round,
            })
        })
    }

    /// Nodes of a cell between copies of the section, whose nodes begin at some numbers.
    fn cell(&self, of_section: &[u32], offsets: &[u32]) -> Vec<u32> {
        let copies = || offsets.iter().map(|offset| of_section.iter().map(move |n| n + offset));
        match self.form {
            Form::Solid => copies().flatten().collect(),
            // Along the path first.
            _ => of_section.iter().flat_map(|n| offsets.iter().map(move |o| n + o)).collect(),
        }
    }

    /// Nodes and cells across the path, about its axis.
    fn section(&self, order: usize, spacing: f64) -> Section {
        let count = |length: f64| cells_along(length, order, spacing);
        match self.form {
            Form::Solid => {
                let counts = [INNER, 1.0 - INNER].map(|part| count(part * self.radius));
                let disc = Mesh::of_ball_by((Form::Plane, order), self.radius, counts, [false; 2]);
                // The polygon has the area of the circle.
                let scale = (PI * self.radius * self.radius / disc.area()).sqrt();
                let nodes = disc.nodes.iter().map(|&[x, _, z]| [scale * x, scale * z]).collect();
                Section { nodes, cells: disc.cells }
            }
            _ => {
                let cells = count(2.0 * self.radius);
                let count = order * cells;
                let place = |n: usize| self.radius * (2.0 * n as f64 / count as f64 - 1.0);
                let cell = |n: usize| (order * n..=order * (n + 1)).map(|n| n as u32).collect();
                let nodes = (0..=count).map(|n| [place(n), 0.0]).collect();
                Section { nodes, cells: (0..cells).map(cell).collect() }
            }
        }
    }

    fn pieces(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    fn length(&self, piece: usize) -> f64 {
        (self.points[piece + 1] - self.points[piece]).norm()
    }

    fn direction(&self, piece: usize) -> Vector3<f64> {
        (self.points[piece + 1] - self.points[piece]).normalize()
    }

    /// Normal of the section at a point of the path.
    fn normal(&self, point: usize) -> Vector3<f64> {
        if point == 0 {
            return self.direction(0);
        }
        let before = self.direction(point - 1);
        let after = if point < self.pieces() { self.direction(point) } else { before };
        let sum = before + after;
        let length = sum.norm();
        if length > 0.0 { sum / length } else { Vector3::zeros() }
    }

    /// Least length of a piece, on the inner side of the bends at its ends.
    fn least(&self, piece: usize) -> f64 {
        let along = self.direction(piece);
        let [from, to] =
            [piece, piece + 1].map(|point| self.normal(point)).map(|n| n / along.dot(&n));
        self.length(piece) - self.radius * (to - from).norm()
    }

    /// Projects a place along a piece to the section at its end.
    fn project(&self, at: Vector3<f64>, piece: usize) -> Vector3<f64> {
        let (along, normal) = (self.direction(piece), self.normal(piece + 1));
        at + along * ((self.points[piece + 1] - at).dot(&normal) / along.dot(&normal))
    }

    /// Directions across the first piece, which it follows in the sense of a right-handed screw: the first horizontal,
    /// in a plane the only one.
    fn across(&self) -> [Vector3<f64>; 2] {
        let along = self.direction(0);
        if self.form != Form::Solid {
            return [Vector3::new(-along.z, 0.0, along.x), Vector3::zeros()];
        }
        let horizontal = Vector3::z().cross(&along);
        let first = if horizontal.norm() > SLACK { horizontal.normalize() } else { Vector3::x() };
        [first, along.cross(&first)]
    }

    /// Shares of two pieces at their closest places, and the distance between these.
    fn nearest(&self, a: usize, b: usize) -> ([f64; 2], f64) {
        let along = [a, b].map(|piece| self.points[piece + 1] - self.points[piece]);
        let offset = self.points[b] - self.points[a];
        let [aa, bb] = along.map(|edge| edge.norm_squared());
        let (ab, of_a, of_b) =
            (along[0].dot(&along[1]), along[0].dot(&offset), along[1].dot(&offset));
        let determinant = aa * bb - ab * ab;
        let u = match determinant > SLACK * aa * bb {
            true => ((of_a * bb - of_b * ab) / determinant).clamp(0.0, 1.0),
            false => 0.0,
        };
        let v = ((u * ab - of_b) / bb).clamp(0.0, 1.0);
        let u = ((v * ab + of_a) / aa).clamp(0.0, 1.0);
        ([u, v], (offset + along[1] * v - along[0] * u).norm())
    }
}

/// Nodes across a path, and the cells between them.
struct Section {
    nodes: Vec<[f64; 2]>,
    cells: Vec<Vec<u32>>,
}

#[cfg(test)]
mod tests {
    use super::super::super::finite_elements;
    use super::*;

    /// Half of a turn of radius 3, and a corner upwards.
    fn path(form: Form) -> Vec<[f64; 3]> {
        let turn = (0..=12).map(|n| PI * f64::from(n) / 12.0).map(|angle| match form {
            Form::Solid => [3.0 * angle.sin(), -3.0 * angle.cos(), 0.0],
            _ => [3.0 * angle.sin(), 0.0, -3.0 * angle.cos()],
        });
        let [x, y, z] = if form == Form::Solid { [-2.0, 3.0, 0.0] } else { [-2.0, 0.0, 3.0] };
        turn.chain([[x, y, z], [x, y, z + 2.0]]).collect()
    }

    fn length(path: &[[f64; 3]]) -> f64 {
        let piece = |ends: &[[f64; 3]]| (Vector3::from(ends[1]) - Vector3::from(ends[0])).norm();
        path.windows(2).map(piece).sum()
    }

    #[test]
    fn strands_have_the_volume_of_straight_ones() {
        for form in [Form::Plane, Form::Solid] {
            let path = path(form);
            let sweep = Sweep::new(form, &path, 0.5);
            assert_eq!(sweep.fault(), None);
            let spacings = if form == Form::Solid { vec![0.1] } else { vec![0.1, 0.05] };
            for (order, spacing) in
                [1, 2].into_iter().flat_map(|o| spacings.iter().map(move |s| (o, *s)))
            {
                let mesh = sweep.mesh(order, spacing);
                let space = finite_elements(&mesh);
                assert!(space.volume.weights.iter().all(|&w| w > 0.0));
                let section = if form == Form::Solid { PI * 0.25 } else { 1.0 };
                let volume: f64 = space.volume.weights.iter().sum();
                let whole = section * length(&path);
                assert!((volume / whole - 1.0).abs() < 1e-12, "{form:?} {volume} of {whole}");
                let edge = if form == Form::Solid { PI } else { 2.0 };
                let area: f64 = space.boundary.samples.weights.iter().sum();
                let whole = edge * length(&path) + 2.0 * section;
                assert!((area / whole - 1.0).abs() < 0.01, "{form:?} {area} of {whole}");
                for (side, part) in [(Side::Left, section), (Side::Right, section)] {
                    let own = space.boundary.sides.iter().zip(&space.boundary.samples.weights);
                    let own: f64 = own.filter(|(own, _)| **own == side).map(|(_, w)| w).sum();
                    assert!((own / part - 1.0).abs() < 1e-12, "{form:?} {side:?} {own}");
                }
                let around = Sweep::new(form, &path, 0.52);
                assert!(mesh.nodes.iter().all(|&at| around.contains(at)));
                for (axis, [low, high]) in sweep.ranges().into_iter().enumerate() {
                    let along = || mesh.nodes.iter().map(|at| at[axis]);
                    let flat = axis == 1 && form != Form::Solid;
                    let gap = along().fold(f64::INFINITY, f64::min) - low;
                    assert!(flat || gap.abs() < 0.02, "{form:?} {axis} {gap}");
                    let gap = high - along().fold(f64::NEG_INFINITY, f64::max);
                    assert!(flat || gap.abs() < 0.02, "{form:?} {axis} {gap}");
                }
            }
        }
    }

    #[test]
    fn paths_that_make_no_strand_are_found() {
        let fault = |path: &[[f64; 3]]| Sweep::new(Form::Solid, path, 0.5).fault();
        let at = |x: f64, y: f64| [x, y, 0.0];
        assert_eq!(
            fault(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.0)]),
            Some(BadPath::Twice { point: 2 })
        );
        let sharp = Some(BadPath::Sharp { point: 1 });
        assert_eq!(fault(&[at(0.0, 0.0), at(4.0, 0.0), at(0.0, 0.0)]), sharp);
        assert_eq!(fault(&[at(0.0, 0.0), at(4.0, 0.0), at(0.0, 0.5)]), sharp);
        // Legs of a U that is narrower than the strand, and of one that is not.
        let [narrow, wide] =
            [0.9, 1.2].map(|y| [at(0.0, 0.0), at(4.0, 0.0), at(4.0, y), at(0.0, y)]);
        assert!(matches!(fault(&narrow), Some(BadPath::Sharp { .. })));
        assert_eq!(fault(&wide), None);
        let crossing = [at(0.0, 0.0), at(9.0, 0.0), at(9.0, 4.0), at(4.0, 4.0), at(4.0, -4.0)];
        assert_eq!(fault(&crossing), Some(BadPath::Meets { points: [0, 3] }));
        let beside = [at(0.0, 0.0), at(9.0, 0.0), at(9.0, 4.0), at(4.0, 4.0), at(4.0, 1.4)];
        assert_eq!(fault(&beside), None);
        // A turn of many short pieces does not meet itself.
        let turn = |n: i32| (f64::from(n) * 0.1).sin_cos();
        let turn: Vec<_> = (0..60).map(turn).map(|(x, y)| at(0.9 * x, 0.9 * y)).collect();
        assert_eq!(fault(&turn[..40]), None);
        assert!(matches!(fault(&turn), Some(BadPath::Meets { .. })));
    }
}

//! Meshes of quadrilaterals or hexahedra of simple shapes, whose nodes are those of any discretisation.

mod sweep;

use std::collections::HashMap;

use super::{Form, finite_elements};
pub use sweep::{BadPath, Sweep};

/// Part of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    Left,
    Right,
    Front,
    Back,
    Bottom,
    Top,
    /// The surface of a round shape.
    Round,
    /// A surface without a name, on which no condition acts.
    Free,
}

/// A mesh. Cells list their nodes with the first coordinate changing fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    pub form: Form,
    /// Order of the functions of a cell: linear or quadratic along each edge.
    pub order: usize,
    pub nodes: Vec<[f64; 3]>,
    /// `(order + 1)²` nodes each in a plane, `(order + 1)³` in space: corners, and for order 2 the middles between.
    pub cells: Vec<Vec<u32>>,
    /// Edges (`order + 1` nodes) or faces (their square, the first coordinate changing fastest) of the boundary with
    /// their sides; those on planes of symmetry and on an axis are none.
    pub faces: Vec<(Side, Vec<u32>)>,
}

/// Edge of the boxes in which nodes count as one, over the extent of a cell.
const COINCIDENT: f64 = 1e-6;

impl Mesh {
    /// Pairs of nodes that follow each other along an edge of a cell, each once.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let across = self.order + 1;
        let strides = [1, across, across * across];
        let strides = &strides[..self.form.axes().len()];
        let of_cell = |cell: &Vec<u32>| {
            let inner =
                |a: usize| strides.iter().filter(move |&&stride| a / stride % across < self.order);
            let pairs = (0..cell.len()).flat_map(|a| inner(a).map(move |stride| (a, a + stride)));
            let sorted = |(a, b): (usize, usize)| [cell[a].min(cell[b]), cell[a].max(cell[b])];
            pairs.map(sorted).collect::<Vec<_>>()
        };
        let mut edges: Vec<[u32; 2]> = self.cells.iter().flat_map(of_cell).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// A box with its origin at the centre of its top: `low` to `high`, cut into `count` linear cells along each axis
    /// of the form.
    pub fn of_box(form: Form, low: [f64; 3], high: [f64; 3], count: [usize; 3]) -> Self {
        Self::of_box_by((form, 1), low, high, count)
    }

    /// The same of cells of an order.
    pub fn of_box_by(
        (form, order): (Form, usize),
        low: [f64; 3],
        high: [f64; 3],
        count: [usize; 3],
    ) -> Self {
        let mut blocks = Blocks::new((form, order), smallest(low, high, count, form));
        blocks.add(count, |[u, v, w]| {
            let place = |axis: usize, part: f64| low[axis] + part * (high[axis] - low[axis]);
            [place(0, u), if form == Form::Solid { place(1, v) } else { 0.0 }, place(2, w)]
        });
        let tolerance = blocks.tolerance;
        let axis_is_inside = form == Form::Axisymmetric && low[0] == 0.0;
        blocks.finish(|corners| {
            let on = |axis: usize, at: f64| {
                corners.iter().all(|corner| (corner[axis] - at).abs() < tolerance)
            };
            let sides = [
                (0, low[0], Side::Left),
                (0, high[0], Side::Right),
                (1, low[1], Side::Front),
                (1, high[1], Side::Back),
                (2, low[2], Side::Bottom),
                (2, high[2], Side::Top),
            ];
            let flat = form != Form::Solid;
            sides
                .into_iter()
                .filter(|&(axis, _, side)| {
                    !(flat && axis == 1 || axis_is_inside && side == Side::Left)
                })
                .find(|&(axis, at, _)| on(axis, at))
                .map(|(_, _, side)| side)
        })
    }

    /// Moves the layers of nodes of a box or a cylinder, which are equally thick, to heights from the bottom on.
    pub fn at_heights(mut self, heights: &[f64]) -> Self {
        let (low, high) = (heights[0], heights[heights.len() - 1]);
        let steps = (heights.len() - 1) as f64;
        for node in &mut self.nodes {
            let place = ((node[2] - low) / (high - low) * steps).round();
            node[2] = heights[place as usize];
        }
        self
    }

    /// Moves all nodes.
    pub fn mapped(mut self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.nodes.iter_mut().for_each(|node| *node = place(*node));
        self
    }

    /// A box without the faces on planes x = 0 and y = 0 that mirror it: they bound the model and not the body.
    pub fn without_cuts(mut self, mirrors: [bool; 2]) -> Self {
        let is_cut =
            |side: Side| side == Side::Left && mirrors[0] || side == Side::Front && mirrors[1];
        self.faces.retain(|(side, _)| !is_cut(*side));
        self
    }

    /// A cylinder of a radius and a thickness about z below the origin, of cells of an order: `counts` are those of the
    /// inner block (half of it) along x and y, from it to the surface, and along z. Only the part with positive x (or
    /// y) is meshed where `halved`.
    pub fn of_cylinder(
        order: usize,
        [radius, thickness]: [f64; 2],
        counts: [usize; 3],
        halved: [bool; 2],
    ) -> Self {
        let [inner, outer, along] = counts;
        let flat =
            Self::of_ball_by((Form::Plane, order), radius, [inner, outer], [halved[0], false]);
        let is_inside = |cell: &&Vec<u32>| {
            let middle = cell.iter().map(|&node| flat.nodes[node as usize][2]).sum::<f64>();
            !halved[1] || middle > 0.0
        };
        let width = radius / (inner + outer) as f64;
        let form = (Form::Solid, order);
        let mut blocks = Blocks::new(form, width.min(thickness / along as f64));
        let place = |layer: usize| thickness * (layer as f64 / (order * along) as f64 - 1.0);
        for cell in flat.cells.iter().filter(is_inside) {
            for layer in 0..along {
                let node = |n: usize| {
                    let [x, _, y] = flat.nodes[cell[n % cell.len()] as usize];
                    blocks.node([x, y, place(order * layer + n / cell.len())])
                };
                let nodes = (0..cell.len() * (order + 1)).map(node).collect();
                blocks.cells.push(nodes);
            }
        }
        let slack = blocks.tolerance;
        blocks.finish(|corners| {
            let all = |is_there: &dyn Fn(&[f64; 3]) -> bool| corners.iter().all(is_there);
            match () {
                () if all(&|at| at[2] > -slack) => Some(Side::Top),
                () if all(&|at| at[2] < slack - thickness) => Some(Side::Bottom),
                () if all(&|at| at[0].hypot(at[1]) > radius - slack) => Some(Side::Round),
                () => None,
            }
        })
    }

    /// Area of a plane mesh.
    fn area(&self) -> f64 {
        let of_corners = |cell: &Vec<u32>| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|n| self.nodes[cell[n] as usize]);
            0.5 * ((d[0] - a[0]) * (c[2] - b[2]) - (d[2] - a[2]) * (c[0] - b[0])).abs()
        };
        match self.order {
            1 => self.cells.iter().map(of_corners).sum(),
            _ => finite_elements(self).volume.weights.iter().sum(),
        }
    }

    /// A ball (in a plane a circle) about the origin, of which only the part with positive x (and y) is meshed where
    /// `halved`: an inner block of `2 inner` linear cells along each axis, and `outer` cells from it to the surface.
    pub fn of_ball(form: Form, radius: f64, inner: usize, outer: usize, halved: [bool; 2]) -> Self {
        Self::of_ball_by((form, 1), radius, [inner, outer], halved)
    }

    /// The same of cells of an order.
    pub fn of_ball_by(
        (form, order): (Form, usize),
        radius: f64,
        [inner, outer]: [usize; 2],
        halved: [bool; 2],
    ) -> Self {
        let halved = [halved[0] || form == Form::Axisymmetric, halved[1]];
        let edge = INNER * radius;
        let width = (edge / inner as f64).min((radius - edge) / outer as f64);
        let mut blocks = Blocks::new((form, order), width);
        let axes = form.axes();
        // Place of the inner block: a cube whose faces bulge.
        let inside = |p: [f64; 3]| bulged(p, edge, axes);
        let ranges = [halved[0], halved[1], false].map(|half| if half { 0.0 } else { -1.0 });
        let counts = ranges.map(|low| if low == 0.0 { inner } else { 2 * inner });
        let along = |axis: usize, part: f64| ranges[axis] + part * (1.0 - ranges[axis]);
        blocks.add(counts, |[u, v, w]| {
            let y = if form == Form::Solid { along(1, v) } else { 0.0 };
            inside([along(0, u), y, along(2, w)])
        });
        for &axis in axes {
            for sign in [-1.0, 1.0] {
                if sign < ranges[axis] {
                    continue;
                }
                let mut count = counts;
                count[axis] = outer;
                blocks.add(count, |parts| {
                    let mut p = [0, 1, 2].map(|a| along(a, parts[a]));
                    if form != Form::Solid {
                        p[1] = 0.0;
                    }
                    p[axis] = sign;
                    // Keeps cells right-handed on both ends.
                    let part = if sign > 0.0 { parts[axis] } else { 1.0 - parts[axis] };
                    let from = inside(p);
                    let to = on_sphere(p, radius);
                    [0, 1, 2].map(|a| from[a] + part * (to[a] - from[a]))
                });
            }
        }
        let slack = 1e-9 * radius;
        blocks.finish(|corners| {
            let is_out = |corner: &[f64; 3]| {
                corner.iter().map(|x| x * x).sum::<f64>().sqrt() > radius - slack
            };
            corners.iter().all(is_out).then_some(Side::Round)
        })
    }
}

/// Half of the edge of the inner block of a ball, over its radius.
const INNER: f64 = 0.55;
/// Part of the way from a cube to a sphere to which the faces of the inner block bulge.
const BULGE: f64 = 0.35;

fn bulged(p: [f64; 3], edge: f64, axes: &[usize]) -> [f64; 3] {
    let most = axes.iter().map(|&a| p[a].abs()).fold(0.0, f64::max);
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return [0.0; 3];
    }
    // A ball of the same size along the axes.
    let round = most / length;
    let factor = edge * (1.0 + BULGE * most * (round - 1.0));
    p.map(|x| factor * x)
}

fn on_sphere(p: [f64; 3], radius: f64) -> [f64; 3] {
    // Equal angles between the nodes of a face.
    let q = p.map(|x| (std::f64::consts::FRAC_PI_4 * x).tan());
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| radius * x / length)
}

fn smallest(low: [f64; 3], high: [f64; 3], count: [usize; 3], form: Form) -> f64 {
    let widths = form.axes().iter().map(|&a| (high[a] - low[a]) / count[a] as f64);
    widths.fold(f64::INFINITY, f64::min)
}

/// Structured blocks that are joined where their nodes coincide.
struct Blocks {
    form: Form,
    order: usize,
    tolerance: f64,
    nodes: Vec<[f64; 3]>,
    places: HashMap<[i64; 3], u32>,
    cells: Vec<Vec<u32>>,
}

impl Blocks {
    /// `width` is that of the smallest cell.
    fn new((form, order): (Form, usize), width: f64) -> Self {
        Self {
            form,
            order,
            tolerance: COINCIDENT * width,
            nodes: Vec::new(),
            places: HashMap::new(),
            cells: Vec::new(),
        }
    }

    /// Adds a block of cells; `place` maps the unit cube.
    fn add(&mut self, count: [usize; 3], place: impl Fn([f64; 3]) -> [f64; 3]) {
        let (mut count, order) = (count, self.order);
        if self.form != Form::Solid {
            count[1] = 0;
        }
        let size = count.map(|n| order * n + 1);
        let mut numbers = Vec::with_capacity(size.iter().product());
        for k in 0..size[2] {
            for j in 0..size[1] {
                for i in 0..size[0] {
                    let part = |n: usize, a: usize| n as f64 / (order * count[a]).max(1) as f64;
                    numbers.push(self.node(place([part(i, 0), part(j, 1), part(k, 2)])));
                }
            }
        }
        let number = |i: usize, j: usize, k: usize| numbers[i + size[0] * (j + size[1] * k)];
        for k in 0..count[2] {
            for j in 0..count[1].max(1) {
                for i in 0..count[0] {
                    let node = |n: usize| {
                        let [u, v, w] = place_in_cell(self.form, order, n);
                        number(order * i + u, order * j + v, order * k + w)
                    };
                    self.cells.push((0..nodes_of_cell(self.form, order)).map(node).collect());
                }
            }
        }
    }

    fn node(&mut self, at: [f64; 3]) -> u32 {
        // Neighbouring boxes are looked through, so that rounding parts no nodes.
        let box_of = at.map(|x| (x / (4.0 * self.tolerance)).round() as i64);
        for n in 0..27_i64 {
            let near = [box_of[0] + n % 3 - 1, box_of[1] + n / 3 % 3 - 1, box_of[2] + n / 9 - 1];
            if let Some(&node) = self.places.get(&near) {
                let known = self.nodes[node as usize];
                if (0..3).all(|a| (known[a] - at[a]).abs() < self.tolerance) {
                    return node;
                }
            }
        }
        let node = self.nodes.len() as u32;
        self.places.insert(box_of, node);
        self.nodes.push(at);
        node
    }

    /// Finds the boundary. `side` returns the side of a face, and none for those on planes of symmetry.
    fn finish(self, side: impl Fn(&[[f64; 3]]) -> Option<Side>) -> Mesh {
        let mut seen: HashMap<Vec<u32>, (usize, Vec<u32>)> = HashMap::new();
        let patterns = faces_of_cell(self.form, self.order);
        let mut order = Vec::new();
        for cell in &self.cells {
            for pattern in &patterns {
                let face: Vec<u32> = pattern.iter().map(|&n| cell[n]).collect();
                let mut key = face.clone();
                key.sort_unstable();
                let entry = seen.entry(key.clone()).or_insert_with(|| {
                    order.push(key);
                    (0, face)
                });
                entry.0 += 1;
            }
        }
        let mut faces = Vec::new();
        for key in order {
            let (times, face) = &seen[&key];
            if *times > 1 {
                continue;
            }
            let corners: Vec<[f64; 3]> = face.iter().map(|&n| self.nodes[n as usize]).collect();
            if let Some(side) = side(&corners) {
                faces.push((side, face.clone()));
            }
        }
        Mesh { form: self.form, order: self.order, nodes: self.nodes, cells: self.cells, faces }
    }
}

/// Number of cells of an order, with nodes at some distance, along a length.
pub fn cells_along(length: f64, order: usize, spacing: f64) -> usize {
    (length / (order as f64 * spacing)).round().max(1.0) as usize
}

/// Number of nodes of a cell.
pub(super) fn nodes_of_cell(form: Form, order: usize) -> usize {
    (order + 1).pow(form.axes().len() as u32)
}

/// Place of a node in its cell, along x, y and z; y is 0 in a plane.
pub(super) fn place_in_cell(form: Form, order: usize, node: usize) -> [usize; 3] {
    let across = order + 1;
    let [first, rest] = [node % across, node / across];
    match form {
        Form::Solid => [first, rest % across, rest / across],
        _ => [first, 0, rest],
    }
}

/// Nodes of the faces of a cell, by axes, the lower one first.
fn faces_of_cell(form: Form, order: usize) -> Vec<Vec<usize>> {
    let ends = form.axes().iter().flat_map(|&axis| [(axis, 0), (axis, order)]);
    let all = || 0..nodes_of_cell(form, order);
    ends.map(|(axis, end)| all().filter(|&n| place_in_cell(form, order, n)[axis] == end).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::finite_elements;
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn balls_and_boxes_have_their_volumes_and_areas() {
        for (form, halved, volume, area) in [
            (Form::Plane, [false, false], PI, 2.0 * PI),
            (Form::Plane, [true, false], 0.5 * PI, PI),
            (Form::Axisymmetric, [true, false], 4.0 / 3.0 * PI, 4.0 * PI),
            (Form::Solid, [false, false], 4.0 / 3.0 * PI, 4.0 * PI),
            (Form::Solid, [true, true], PI / 3.0, PI),
        ] {
            for of_cells in [1, 2] {
                let mut errors = Vec::new();
                for fine in [1, 2] {
                    let counts = [4 * fine, 3 * fine];
                    let mesh = Mesh::of_ball_by((form, of_cells), 1.0, counts, halved);
                    let space = finite_elements(&mesh);
                    let found: f64 = space.volume.weights.iter().sum();
                    assert!(space.volume.weights.iter().all(|&w| w > 0.0));
                    let skin: f64 = space.boundary.samples.weights.iter().sum();
                    errors.push([1.0 - found / volume, 1.0 - skin / area]);
                }
                // Quadratic edges interpolate a circle to the fourth order.
                let wanted = 2.0 * of_cells as f64;
                for a in 0..2 {
                    let order = (errors[0][a] / errors[1][a]).log2();
                    let case = format!("{form:?} {of_cells} {halved:?} {errors:?}");
                    assert!((order - wanted).abs() < 0.1 * wanted, "{case}");
                }
            }
        }
    }

    #[test]
    fn boxes_have_sides() {
        let mesh = Mesh::of_box(Form::Solid, [-1.0, -2.0, -3.0], [1.0, 2.0, 0.0], [2, 3, 4]);
        let space = finite_elements(&mesh);
        let area = |side: Side| -> f64 {
            let of = |n: &usize| space.boundary.sides[*n] == side;
            (0..space.boundary.sides.len())
                .filter(of)
                .map(|n| space.boundary.samples.weights[n])
                .sum()
        };
        for (side, expected) in [(Side::Left, 12.0), (Side::Back, 6.0), (Side::Top, 8.0)] {
            assert!((area(side) - expected).abs() < 1e-12, "{side:?}");
        }
        assert!((space.volume.weights.iter().sum::<f64>() - 24.0).abs() < 1e-12);
        assert_eq!(mesh.nodes.len(), 3 * 4 * 5);
    }
}

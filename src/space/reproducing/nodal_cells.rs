//! Cells of nodes and the integrals of functions over them.

use super::super::{Boundary, Form, Mesh};
use super::cell_map::{Place, gauss_points};
use super::cells::{on_facet, push};
use super::facets::{Facet, corner_bits};
use super::{Functions, Refused, Row};

/// Cell of a node: the parts next to it that the middles of edges, facets and cells cut from the cells of the mesh.
/// Integrals are weighted by the depth w of the model; places are relative to the node until [`Self::centred`].
#[derive(Debug, Clone, Default)]
pub(super) struct NodalCell {
    /// ∫ w.
    pub volume: f64,
    /// ∫ x w.
    pub first: [f64; 3],
    /// ∫ x xᵀ w.
    pub second: [[f64; 3]; 3],
    /// ∫ ∂w/∂r, zero but in axisymmetric models: the circumference's change by the radius, times the area.
    pub ring: f64,
    /// ∫ x ∂w/∂r.
    pub ring_first: [f64; 3],
    pub row: Vec<Moments>,
}

/// Integrals of a node's function over the cell of a node.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Moments {
    pub node: u32,
    /// ∫ Ψ w.
    pub value: f64,
    /// ∫ ∇Ψ w, by the divergence theorem.
    pub gradient: [f64; 3],
    /// ∫ x_k ∂Ψ/∂x_l w, by the divergence theorem.
    pub gradient_first: [[f64; 3]; 3],
    /// ∫ Ψ ∂w/∂r and ∫ x Ψ ∂w/∂r: circumferential strains, as w is 2πr.
    pub hoop: f64,
    pub hoop_first: [f64; 3],
}

/// Integrates functions over the cells of all nodes, with `count` Gauss points along each edge of each part; the
/// points on the surface are those of the boundary.
///
/// Source of the gradients: Chen, Wu, Yoon & You (2001), Int. J. Numer. Methods Eng. 50, 435–466,
/// doi 10.1002/1097-0207(20010120)50:2<435::AID-NME32>3.0.CO;2-A.
pub(super) fn nodal_cells(
    mesh: &Mesh,
    functions: &Functions,
    surface: &[Vec<Facet>],
    count: usize,
) -> Result<(Vec<NodalCell>, Boundary), Refused> {
    let mut cells = vec![NodalCell::default(); mesh.nodes.len()];
    let mut boundary = Boundary::default();
    let mut sums = Sums::new(mesh);
    let mut row = Row::default();
    for (cell, facets) in mesh.cells.iter().zip(surface) {
        sums.clear(cell);
        for part in 0..cell.len() {
            let (low, high) = part_of(mesh.form, part);
            for (local, weight) in gauss_points(mesh.form.axes(), low, high, count) {
                let place = Place::of(mesh, cell, local);
                functions.evaluate(place.at, false, &mut row)?;
                let volume = weight * place.volume();
                sums.add_volume(part, &place, volume, &row, &mut cells[cell[part] as usize]);
            }
            for facet in inner_facets(mesh.form, part) {
                for (local, weight) in gauss_points(&facet.along, facet.low, facet.high, count) {
                    let place = Place::of(mesh, cell, local);
                    functions.evaluate(place.at, false, &mut row)?;
                    let depth = weight * mesh.form.depth(place.at);
                    let area = place.area(facet.axis).map(|x| depth * x);
                    sums.add_surface(part, &place, area, &row);
                    sums.add_surface(facet.beyond, &place, area.map(|x| -x), &row);
                }
            }
            for facet in facets.iter().filter(|f| corner_bits(mesh.form, part)[f.axis] == f.upper) {
                for (local, weight) in on_facet(mesh, facet, low, high, count) {
                    let place = Place::of(mesh, cell, local);
                    functions.evaluate(place.at, facet.side.is_some(), &mut row)?;
                    let area = push(&mut boundary, mesh, facet, &place, weight, &row);
                    sums.add_surface(part, &place, area, &row);
                }
            }
        }
        sums.merge_into(cell, &mut cells);
    }
    Ok((cells, boundary))
}

impl NodalCell {
    /// Refers first and second moments to the centre of the cell, and returns that.
    pub(super) fn centred(&mut self, node: [f64; 3]) -> [f64; 3] {
        let centre = self.first.map(|x| x / self.volume);
        for k in 0..3 {
            for l in 0..3 {
                self.second[k][l] -= self.volume * centre[k] * centre[l];
            }
            self.ring_first[k] -= self.ring * centre[k];
            for moments in &mut self.row {
                (0..3)
                    .for_each(|l| moments.gradient_first[k][l] -= centre[k] * moments.gradient[l]);
                moments.hoop_first[k] -= centre[k] * moments.hoop;
            }
        }
        self.first = [0.0; 3];
        [0, 1, 2].map(|a| node[a] + centre[a])
    }
}

/// Part of the unit cell next to a corner.
fn part_of(form: Form, corner: usize) -> ([f64; 3], [f64; 3]) {
    let low = corner_bits(form, corner).map(|upper| if upper { 0.5 } else { 0.0 });
    (low, low.map(|x| x + 0.5))
}

/// Surface between the parts of two corners of a cell.
struct InnerFacet {
    axis: usize,
    along: Vec<usize>,
    low: [f64; 3],
    high: [f64; 3],
    /// Corner on its upper side.
    beyond: usize,
}

/// Surfaces on the upper side of a corner's part.
fn inner_facets(form: Form, corner: usize) -> Vec<InnerFacet> {
    let axes = form.axes();
    let (low, high) = part_of(form, corner);
    let lower = |&(_, &axis): &(usize, &usize)| !corner_bits(form, corner)[axis];
    let facet = |(bit, &axis): (usize, &usize)| {
        let mut low = low;
        low[axis] = 0.5;
        let along = axes.iter().copied().filter(|&other| other != axis).collect();
        InnerFacet { axis, along, low, high, beyond: corner | 1 << bit }
    };
    axes.iter().enumerate().filter(lower).map(facet).collect()
}

/// Integrals over the parts of one cell of the mesh.
struct Sums<'a> {
    mesh: &'a Mesh,
    corners: Vec<[f64; 3]>,
    /// Place of each node in the rows of the present cell; `ABSENT` if it has none.
    slots: Vec<u32>,
    nodes: Vec<u32>,
    /// For each part, moments in the order of `nodes`.
    parts: Vec<Vec<Moments>>,
}

const ABSENT: u32 = u32::MAX;

impl<'a> Sums<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let parts = mesh.cells.iter().map(Vec::len).max().unwrap_or(0);
        Self {
            mesh,
            corners: Vec::new(),
            slots: vec![ABSENT; mesh.nodes.len()],
            nodes: Vec::new(),
            parts: vec![Vec::new(); parts],
        }
    }

    fn clear(&mut self, cell: &[u32]) {
        self.corners.clear();
        self.corners.extend(cell.iter().map(|&node| self.mesh.nodes[node as usize]));
        for node in self.nodes.drain(..) {
            self.slots[node as usize] = ABSENT;
        }
        self.parts.iter_mut().for_each(Vec::clear);
    }

    fn slot(&mut self, node: u32) -> usize {
        let slot = &mut self.slots[node as usize];
        if *slot == ABSENT {
            *slot = self.nodes.len() as u32;
            self.nodes.push(node);
            let empty = Moments { node, ..Moments::default() };
            self.parts.iter_mut().for_each(|part| part.push(empty));
        }
        *slot as usize
    }

    /// Adds a point of a part: ∫ q ∂Ψ/∂x_l w = ∮ q Ψ n_l w − ∫ Ψ ∂(q w)/∂x_l for q = 1 and x_k.
    fn add_volume(
        &mut self,
        part: usize,
        place: &Place,
        area: f64,
        row: &Row,
        cell: &mut NodalCell,
    ) {
        let x = [0, 1, 2].map(|a| place.at[a] - self.corners[part][a]);
        let volume = area * self.mesh.form.depth(place.at);
        let ring = match self.mesh.form {
            Form::Axisymmetric => area * 2.0 * std::f64::consts::PI,
            Form::Plane | Form::Solid => 0.0,
        };
        cell.volume += volume;
        cell.ring += ring;
        for k in 0..3 {
            cell.first[k] += volume * x[k];
            cell.ring_first[k] += ring * x[k];
            (0..3).for_each(|l| cell.second[k][l] += volume * x[k] * x[l]);
        }
        for (&node, &value) in row.nodes.iter().zip(&row.values) {
            let slot = self.slot(node);
            let moments = &mut self.parts[part][slot];
            let hoop = ring * value;
            moments.value += volume * value;
            moments.hoop += hoop;
            moments.gradient[0] -= hoop;
            for (k, &x) in x.iter().enumerate() {
                moments.gradient_first[k][k] -= volume * value;
                moments.gradient_first[k][0] -= x * hoop;
                moments.hoop_first[k] += x * hoop;
            }
        }
    }

    /// Adds a point of the surface of a part with its outward area.
    fn add_surface(&mut self, part: usize, place: &Place, area: [f64; 3], row: &Row) {
        let x = [0, 1, 2].map(|a| place.at[a] - self.corners[part][a]);
        for (&node, &value) in row.nodes.iter().zip(&row.values) {
            let slot = self.slot(node);
            let moments = &mut self.parts[part][slot];
            for (l, area) in area.iter().enumerate() {
                let flux = value * area;
                moments.gradient[l] += flux;
                (0..3).for_each(|k| moments.gradient_first[k][l] += x[k] * flux);
            }
        }
    }

    fn merge_into(&self, cell: &[u32], cells: &mut [NodalCell]) {
        let mut order: Vec<usize> = (0..self.nodes.len()).collect();
        order.sort_unstable_by_key(|&n| self.nodes[n]);
        for (&node, part) in cell.iter().zip(&self.parts) {
            let row = &mut cells[node as usize].row;
            *row = merged(row, order.iter().map(|&n| part[n]));
        }
    }
}

/// Sum of two rows in ascending order of nodes.
fn merged(row: &[Moments], other: impl Iterator<Item = Moments>) -> Vec<Moments> {
    let mut sum = Vec::with_capacity(row.len() + other.size_hint().0);
    let mut rest = row.iter().copied().peekable();
    for moments in other {
        while let Some(before) = rest.next_if(|m| m.node < moments.node) {
            sum.push(before);
        }
        match rest.next_if(|m| m.node == moments.node) {
            Some(same) => sum.push(same.plus(&moments)),
            None => sum.push(moments),
        }
    }
    sum.extend(rest);
    sum
}

impl Moments {
    fn plus(&self, other: &Self) -> Self {
        let add = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] + b[k]);
        Self {
            node: self.node,
            value: self.value + other.value,
            gradient: add(self.gradient, other.gradient),
            gradient_first: [0, 1, 2].map(|k| add(self.gradient_first[k], other.gradient_first[k])),
            hoop: self.hoop + other.hoop,
            hoop_first: add(self.hoop_first, other.hoop_first),
        }
    }
}

//! Meshes whose nodes and cells are given, checked to be those of one body.

use std::collections::HashMap;

use super::bins::Bins;
use super::finite_elements::shape;
use super::reproducing::facets::corners;
use super::{Form, Mesh, Side};

/// Why given cells make no mesh; nodes, cells and named facets are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadMesh {
    /// No cell.
    Empty,
    /// A node left of the axis of a meridian section.
    BesideAxis { node: usize },
    /// A node that belongs to no cell.
    Unused { node: usize },
    /// Two nodes at one place.
    Twice { nodes: [usize; 2] },
    /// A cell without volume, or one that is folded at a corner.
    Folded { cell: usize },
    /// A cell on a facet that two others share.
    Crowded { cell: usize },
    /// A cell that no way along common nodes connects with the first.
    Apart { cell: usize },
    /// A cell at an edge of the surface, in a section a node of it, at which more than two facets meet.
    Pinched { cell: usize },
    /// A named facet that is none of the surface.
    Inside { facet: usize },
    /// A facet that is named twice, differently.
    Renamed { facet: usize },
}

/// Distance over the extent of the mesh within which nodes lie on its outermost planes, and on the axis.
const ON_PLANE: f64 = 1e-9;
/// Distance over the shortest edge of a cell within which two nodes are at one place.
const COINCIDENT: f64 = 1e-6;
/// Smallest volume per unit cell at a corner, over the largest of the cell.
const FOLDED: f64 = 1e-6;

impl Mesh {
    /// Creates a mesh of given cells, which list their corners with the first coordinate changing fastest. Facets of
    /// the surface have the sides of `named`, and are free otherwise; without `named` those on the outermost planes
    /// have the sides of a box, and the others are round. Those on the axis of a meridian section are none.
    pub fn of_cells(
        form: Form,
        nodes: Vec<[f64; 3]>,
        cells: Vec<Vec<u32>>,
        named: Option<&[(Side, Vec<u32>)]>,
    ) -> Result<Self, BadMesh> {
        if cells.is_empty() {
            return Err(BadMesh::Empty);
        }
        let mut mesh = Self { form, order: 1, nodes, cells, faces: Vec::new() };
        mesh.check_nodes()?;
        let ranges = mesh.flush()?;
        mesh.check_cells()?;
        let mut facets: HashMap<Vec<u32>, usize> = HashMap::new();
        let mut order: Vec<(usize, Vec<u32>)> = Vec::new();
        for (number, cell) in mesh.cells.iter().enumerate() {
            for &axis in form.axes() {
                for upper in [false, true] {
                    let facet = corners(form, cell, axis, upper);
                    let uses = facets.entry(sorted(&facet)).or_default();
                    *uses += 1;
                    if *uses > 2 {
                        return Err(BadMesh::Crowded { cell: number });
                    }
                    order.push((number, facet));
                }
            }
        }
        order.retain(|(_, facet)| facets[&sorted(facet)] == 1);
        if let Some(cell) = pinched(&order) {
            return Err(BadMesh::Pinched { cell });
        }
        let sides = named.map(|named| sides(named, &facets)).transpose()?;
        let nodes = &mesh.nodes;
        let side = |facet: &Vec<u32>| {
            let on = |axis: usize, at: f64| facet.iter().all(|&n| nodes[n as usize][axis] == at);
            if form == Form::Axisymmetric && on(0, 0.0) {
                return None;
            }
            Some(match &sides {
                Some(sides) => sides.get(&sorted(facet)).copied().unwrap_or(Side::Free),
                None => {
                    let outermost = |(axis, end, _): &&(usize, usize, Side)| {
                        form.axes().contains(axis) && on(*axis, ranges[*axis][*end])
                    };
                    OUTERMOST.iter().find(outermost).map_or(Side::Round, |(_, _, side)| *side)
                }
            })
        };
        let faces = order.into_iter().filter_map(|(_, facet)| Some((side(&facet)?, facet)));
        mesh.faces = faces.collect();
        Ok(mesh)
    }

    /// The plane on which a side lies, as its axis and place; `None` if it is not on one, or the body is on both sides
    /// of it.
    pub fn plane_of(&self, side: Side) -> Option<(usize, f64)> {
        let of_side = self.faces.iter().filter(|(own, _)| *own == side);
        let nodes: Vec<[f64; 3]> =
            of_side.flat_map(|(_, facet)| facet.iter().map(|&n| self.nodes[n as usize])).collect();
        let first = nodes.first()?;
        let is_plane = |&&axis: &&usize| {
            let place = first[axis];
            let beyond = |sign: f64| self.nodes.iter().any(|at| sign * (at[axis] - place) > 0.0);
            nodes.iter().all(|at| at[axis] == place) && !(beyond(1.0) && beyond(-1.0))
        };
        self.form.axes().iter().find(is_plane).map(|&axis| (axis, first[axis]))
    }

    fn check_nodes(&self) -> Result<(), BadMesh> {
        let mut is_used = vec![false; self.nodes.len()];
        self.cells.iter().flatten().for_each(|&node| is_used[node as usize] = true);
        if let Some(node) = is_used.iter().position(|used| !used) {
            return Err(BadMesh::Unused { node });
        }
        let edges = self.edges();
        let lengths = || edges.iter().map(|&[a, b]| self.distance(a, b));
        let longest = lengths().fold(0.0, f64::max);
        let shortest = lengths().filter(|length| *length > 0.0).fold(longest, f64::min);
        match coincident(self.form, &self.nodes, COINCIDENT * shortest) {
            Some(nodes) => Err(BadMesh::Twice { nodes }),
            None => Ok(()),
        }
    }

    fn distance(&self, a: u32, b: u32) -> f64 {
        let (a, b) = (self.nodes[a as usize], self.nodes[b as usize]);
        (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>().sqrt()
    }

    /// Moves nodes by rounding onto the outermost planes and the axis; returns the range along each axis.
    fn flush(&mut self) -> Result<[[f64; 2]; 3], BadMesh> {
        let range = |axis: usize| {
            let along = self.nodes.iter().map(|at| at[axis]);
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let mut ranges = [0, 1, 2].map(range);
        let extent = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let slack = ON_PLANE * extent;
        if self.form == Form::Axisymmetric {
            if let Some(node) = self.nodes.iter().position(|at| at[0] < -slack) {
                return Err(BadMesh::BesideAxis { node });
            }
            if ranges[0][0] <= slack {
                ranges[0][0] = 0.0;
            }
        }
        for node in &mut self.nodes {
            for (x, ends) in node.iter_mut().zip(&ranges) {
                if let Some(end) = ends.iter().find(|end| (*x - **end).abs() <= slack) {
                    *x = *end;
                }
            }
        }
        Ok(ranges)
    }

    /// Refuses cells that are folded, and parts that hang together with nothing.
    fn check_cells(&self) -> Result<(), BadMesh> {
        if let Some(cell) = self.cells.iter().position(|cell| self.is_folded(cell)) {
            return Err(BadMesh::Folded { cell });
        }
        let links = self.cells.iter().flat_map(|cell| cell.iter().map(|&node| [cell[0], node]));
        let roots = roots(self.nodes.len(), links);
        let first = roots[self.cells[0][0] as usize];
        match self.cells.iter().position(|cell| roots[cell[0] as usize] != first) {
            Some(cell) => Err(BadMesh::Apart { cell }),
            None => Ok(()),
        }
    }

    fn is_folded(&self, cell: &[u32]) -> bool {
        let at_corner = |corner: usize| {
            let local = match self.form {
                Form::Solid => [corner & 1, corner >> 1 & 1, corner >> 2].map(|bit| bit as f64),
                _ => [(corner & 1) as f64, 0.0, (corner >> 1) as f64],
            };
            let mut jacobian = [[0.0; 3]; 3];
            for (n, &node) in cell.iter().enumerate() {
                let (_, slope) = shape((self.form, 1), n, local);
                let x = self.nodes[node as usize];
                for a in 0..3 {
                    (0..3).for_each(|b| jacobian[a][b] += x[a] * slope[b]);
                }
            }
            if self.form != Form::Solid {
                jacobian[1][1] = 1.0;
            }
            crate::math::matrix3::inverse(&jacobian).1
        };
        let volumes: Vec<f64> = (0..cell.len()).map(at_corner).collect();
        let largest =
            volumes.iter().fold(0.0, |most: f64, v| if v.abs() > most.abs() { *v } else { most });
        let is_small = |&volume: &f64| volume * largest.signum() <= FOLDED * largest.abs();
        volumes.iter().any(is_small)
    }
}

/// Axis, end and name of each outermost plane.
const OUTERMOST: [(usize, usize, Side); 6] = [
    (0, 0, Side::Left),
    (0, 1, Side::Right),
    (1, 0, Side::Front),
    (1, 1, Side::Back),
    (2, 0, Side::Bottom),
    (2, 1, Side::Top),
];

/// Sides of the named facets, all of which are on the surface.
fn sides(
    named: &[(Side, Vec<u32>)],
    facets: &HashMap<Vec<u32>, usize>,
) -> Result<HashMap<Vec<u32>, Side>, BadMesh> {
    let mut sides = HashMap::new();
    for (facet, (side, nodes)) in named.iter().enumerate() {
        let key = sorted(nodes);
        if facets.get(&key) != Some(&1) {
            return Err(BadMesh::Inside { facet });
        }
        if sides.insert(key, *side).is_some_and(|before| before != *side) {
            return Err(BadMesh::Renamed { facet });
        }
    }
    Ok(sides)
}

/// A cell with an edge of the surface, in a section with a node of it, at which more than two facets meet: facets of
/// neighbours do not match there, or cells touch along it alone.
fn pinched(surface: &[(usize, Vec<u32>)]) -> Option<usize> {
    let mut uses: HashMap<Vec<u32>, usize> = HashMap::new();
    surface.iter().find_map(|(cell, facet)| {
        let rims = match facet[..] {
            [a, b, c, d] => vec![vec![a, b], vec![a, c], vec![b, d], vec![c, d]],
            _ => facet.iter().map(|&node| vec![node]).collect(),
        };
        let is_crowded = rims.iter().any(|rim| {
            let uses = uses.entry(sorted(rim)).or_default();
            *uses += 1;
            *uses > 2
        });
        is_crowded.then_some(*cell)
    })
}

fn sorted(nodes: &[u32]) -> Vec<u32> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

/// Finds two points whose coordinates differ by less than a distance.
pub(super) fn coincident(form: Form, nodes: &[[f64; 3]], distance: f64) -> Option<[usize; 2]> {
    let axes = form.axes();
    let supports: Vec<[[f64; 3]; 2]> =
        nodes.iter().map(|at| [at.map(|x| x - distance), at.map(|x| x + distance)]).collect();
    let range = |axis: usize| {
        let along = nodes.iter().map(|at| at[axis]);
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
    };
    let extent = axes.iter().map(|&axis| range(axis)).map(|[a, b]| b - a).fold(0.0, f64::max);
    let width = (extent / (nodes.len() as f64).powf(1.0 / axes.len() as f64)).max(distance);
    let bins = Bins::new(axes, &supports, [width; 3]);
    let is_near = |a: usize, b: usize| {
        axes.iter().all(|&axis| (nodes[a][axis] - nodes[b][axis]).abs() < distance)
    };
    (0..nodes.len()).find_map(|node| {
        let others = bins.near(nodes[node]).iter().map(|&other| other as usize);
        let twin = others.filter(|&other| other > node).find(|&other| is_near(node, other));
        twin.map(|other| [node, other])
    })
}

/// One node for all that links connect, for each node.
pub(super) fn roots(count: usize, links: impl Iterator<Item = [u32; 2]>) -> Vec<usize> {
    let mut parents: Vec<usize> = (0..count).collect();
    fn root(parents: &mut [usize], mut node: usize) -> usize {
        while parents[node] != node {
            parents[node] = parents[parents[node]];
            node = parents[node];
        }
        node
    }
    for [a, b] in links {
        let [a, b] = [a, b].map(|node| root(&mut parents, node as usize));
        parents[a.max(b)] = a.min(b);
    }
    (0..count).map(|node| root(&mut parents, node)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(form: Form, nodes: &[[f64; 3]], cells: &[&[u32]]) -> Option<BadMesh> {
        let cells = cells.iter().map(|cell| cell.to_vec()).collect();
        Mesh::of_cells(form, nodes.to_vec(), cells, None).err()
    }

    #[test]
    fn cells_that_touch_at_a_point_are_refused() {
        let places = [[0, 0], [1, 0], [0, 1], [1, 1], [2, 1], [1, 2], [2, 2]];
        let nodes = places.map(|[x, z]| [f64::from(x), 0.0, f64::from(z)]);
        let found = refused(Form::Plane, &nodes, &[&[0, 1, 2, 3], &[3, 4, 5, 6]]);
        assert_eq!(found, Some(BadMesh::Pinched { cell: 1 }));
    }

    /// Two cubes, whole and with the upper corners of both turned by a quarter: no facet is common then.
    #[test]
    fn cells_whose_facets_do_not_match_are_refused() {
        let node = |n: u32| [n % 3, n / 3 % 2, n / 6].map(f64::from);
        let nodes: Vec<_> = (0..12).map(node).collect();
        let whole: [&[u32]; 2] = [&[0, 1, 3, 4, 6, 7, 9, 10], &[1, 2, 4, 5, 7, 8, 10, 11]];
        assert_eq!(refused(Form::Solid, &nodes, &whole), None);
        let turned: [&[u32]; 2] = [&[0, 1, 3, 4, 7, 10, 6, 9], &[1, 2, 4, 5, 8, 11, 7, 10]];
        let found = refused(Form::Solid, &nodes, &turned);
        assert_eq!(found, Some(BadMesh::Pinched { cell: 1 }));
    }
}

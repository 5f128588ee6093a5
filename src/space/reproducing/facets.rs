//! Facets of cells: which lie on the surface of a mesh, on which side, and on which planes functions vanish.

use std::collections::HashMap;

use super::super::{Form, Mesh, Side};
use super::Sides;

/// A facet of a cell on the surface of the mesh.
#[derive(Debug, Clone, Copy)]
pub(in crate::space) struct Facet {
    /// Coordinate of the cell that is constant on it, and whether it is 1 there rather than 0.
    pub axis: usize,
    pub upper: bool,
    /// `None` on planes of symmetry and on an axis.
    pub side: Option<Side>,
}

/// Corners of a cell, as bits along each of its coordinates.
pub(super) fn corner_bits(form: Form, corner: usize) -> [bool; 3] {
    match form {
        Form::Solid => [corner & 1 != 0, corner & 2 != 0, corner & 4 != 0],
        Form::Plane | Form::Axisymmetric => [corner & 1 != 0, false, corner & 2 != 0],
    }
}

/// Facets of each cell on the surface.
pub(in crate::space) fn surface(mesh: &Mesh) -> Vec<Vec<Facet>> {
    let known: HashMap<Vec<u32>, Side> =
        mesh.faces.iter().map(|(side, face)| (sorted(face.clone()), *side)).collect();
    let mut uses: HashMap<Vec<u32>, usize> = HashMap::new();
    let each = |cell: &[u32], visit: &mut dyn FnMut(usize, bool, Vec<u32>)| {
        for &axis in mesh.form.axes() {
            for upper in [false, true] {
                visit(axis, upper, sorted(corners(mesh.form, cell, axis, upper)));
            }
        }
    };
    for cell in &mesh.cells {
        each(cell, &mut |_, _, key| *uses.entry(key).or_default() += 1);
    }
    let facets_of = |cell: &Vec<u32>| {
        let mut facets = Vec::new();
        each(cell, &mut |axis, upper, key| {
            if uses[&key] == 1 {
                facets.push(Facet { axis, upper, side: known.get(&key).copied() });
            }
        });
        facets
    };
    mesh.cells.iter().map(facets_of).collect()
}

/// Planes of symmetry, an axis and flat sides that are held: their normal coordinate, and its value there.
pub(super) fn planes(mesh: &Mesh, surface: &[Vec<Facet>], held: Sides) -> Vec<(usize, f64)> {
    let is_plane = |facet: &&Facet| facet.side.is_none_or(|side| held.contains(side));
    let mut planes = Vec::new();
    for (cell, facets) in mesh.cells.iter().zip(surface) {
        for facet in facets.iter().filter(is_plane) {
            let corners = corners(mesh.form, cell, facet.axis, facet.upper);
            let place = |axis: usize, n: usize| mesh.nodes[corners[n] as usize][axis];
            let flat = mesh
                .form
                .axes()
                .iter()
                .find(|&&axis| (1..corners.len()).all(|n| place(axis, n) == place(axis, 0)));
            if let Some(&axis) = flat
                && !planes.contains(&(axis, place(axis, 0)))
            {
                planes.push((axis, place(axis, 0)));
            }
        }
    }
    planes
}

pub(in crate::space) fn corners(form: Form, cell: &[u32], axis: usize, upper: bool) -> Vec<u32> {
    let on = |&n: &usize| corner_bits(form, n)[axis] == upper;
    (0..cell.len()).filter(on).map(|n| cell[n]).collect()
}

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes
}

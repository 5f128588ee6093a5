//! Finite elements: functions that are linear or quadratic along each edge of quadrilaterals and hexahedra.

use super::mesh::{nodes_of_cell, place_in_cell};
use super::shares::shares;
use super::{Boundary, Form, Mesh, Samples, Sharing, Space, Value};
use crate::math::matrix3::{self, cross};

/// Places of Gauss points on the unit interval, by orders of functions, and weights of those of quadratic ones; those
/// of linear ones are equal.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
const GAUSS_QUADRATIC: [f64; 3] = [0.112_701_665_379_258_3, 0.5, 0.887_298_334_620_741_7];
const WEIGHTS_QUADRATIC: [f64; 3] = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];

/// Creates the space of a mesh's functions. The points of a cell share one dilatation, or with quadratic functions one
/// that is linear over the cell, so that nearly incompressible bodies do not lock (J. C. Simo, R. L. Taylor & K. S.
/// Pister 1985, doi 10.1016/0045-7825(85)90033-7).
pub fn finite_elements(mesh: &Mesh) -> Space {
    let mut volume = Samples::default();
    let mut groups = Vec::new();
    for cell in &mesh.cells {
        let first = volume.len();
        for (local, part) in gauss_points(mesh.form, mesh.order) {
            let (at, weight, row) = sample(mesh, cell, (local, part));
            volume.push(at, weight, row);
        }
        groups.push(first..volume.len());
    }
    let sharing = match mesh.order {
        1 => Sharing::Mean,
        _ => Sharing::linear(&volume, &groups, mesh.form),
    };
    let shares = shares(mesh, &volume);
    Space {
        form: mesh.form,
        order: mesh.order,
        nodes: mesh.nodes.clone(),
        volume,
        groups,
        sharing,
        boundary: boundary(mesh),
        at_nodes: None,
        shares,
        links: mesh.edges(),
    }
}

/// Gauss points of a unit cell with their parts of its volume.
fn gauss_points(form: Form, order: usize) -> Vec<([f64; 3], f64)> {
    let count = nodes_of_cell(form, order);
    let point = |n: usize| {
        let place = place_in_cell(form, order, n);
        let axes = form.axes();
        let mut local = [0.0; 3];
        axes.iter().for_each(|&a| local[a] = along(order, place[a]).0);
        let part = match order {
            1 => 1.0 / count as f64,
            _ => axes.iter().map(|&a| along(order, place[a]).1).product(),
        };
        (local, part)
    };
    (0..count).map(point).collect()
}

/// A Gauss point of the unit interval and its weight.
fn along(order: usize, place: usize) -> (f64, f64) {
    match order {
        1 => (GAUSS[place], 0.5),
        _ => (GAUSS_QUADRATIC[place], WEIGHTS_QUADRATIC[place]),
    }
}

/// Place, weight and row of a point of a cell, at a place of the unit cell and for a part of its volume.
pub(super) fn sample(
    mesh: &Mesh,
    cell: &[u32],
    (local, part): ([f64; 3], f64),
) -> ([f64; 3], f64, Vec<Value>) {
    let axes = mesh.form.axes();
    let shapes: Vec<(f64, [f64; 3])> =
        (0..cell.len()).map(|n| shape((mesh.form, mesh.order), n, local)).collect();
    let mut at = [0.0; 3];
    // ∂X_a/∂ξ_b.
    let mut jacobian = [[0.0; 3]; 3];
    for (&node, (value, slope)) in cell.iter().zip(&shapes) {
        let x = mesh.nodes[node as usize];
        for a in 0..3 {
            at[a] += value * x[a];
            (0..3).for_each(|b| jacobian[a][b] += x[a] * slope[b]);
        }
    }
    if axes.len() == 2 {
        jacobian[1][1] = 1.0;
    }
    let (inverse, determinant) = matrix3::inverse(&jacobian);
    let weight = determinant.abs() * part * mesh.form.depth(at);
    let row = cell.iter().zip(&shapes).map(|(&node, (value, slope))| {
        let mut gradient = [0, 1, 2].map(|a| (0..3).map(|b| slope[b] * inverse[b][a]).sum());
        if axes.len() == 2 {
            gradient[1] = 0.0;
        }
        Value { node, value: *value, gradient }
    });
    (at, weight, row.collect())
}

/// Function of a node and its derivatives at a place of the unit cell.
pub(super) fn shape((form, order): (Form, usize), node: usize, local: [f64; 3]) -> (f64, [f64; 3]) {
    let place = place_in_cell(form, order, node);
    let mut factors = [(1.0, 0.0); 3];
    form.axes().iter().for_each(|&a| factors[a] = line(order, place[a], local[a]));
    let value = factors[0].0 * factors[1].0 * factors[2].0;
    let slope = [0, 1, 2].map(|a| factors[a].1 * factors[(a + 1) % 3].0 * factors[(a + 2) % 3].0);
    (value, slope)
}

/// Function of a node of the unit interval and its derivative.
fn line(order: usize, place: usize, x: f64) -> (f64, f64) {
    match (order, place) {
        (1, 0) => (1.0 - x, -1.0),
        (1, _) => (x, 1.0),
        (_, 0) => ((1.0 - x) * (1.0 - 2.0 * x), 4.0 * x - 3.0),
        (_, 1) => (4.0 * x * (1.0 - x), 4.0 - 8.0 * x),
        _ => (x * (2.0 * x - 1.0), 4.0 * x - 1.0),
    }
}

/// Points of the boundary: two Gauss points along each edge, three with quadratic functions, with the functions of the
/// edge or face and their gradients along it; across it they have none.
pub(super) fn boundary(mesh: &Mesh) -> Boundary {
    let centre_of_cell = centres(mesh);
    let mut boundary = Boundary::default();
    for (number, (side, face)) in mesh.faces.iter().enumerate() {
        let places: Vec<[f64; 3]> = face.iter().map(|&n| mesh.nodes[n as usize]).collect();
        for n in 0..face.len() {
            let (parts, part) = face_point((mesh.form, mesh.order), n);
            let (mut at, mut tangents) = ([0.0; 3], [[0.0; 3]; 2]);
            for (x, (value, slope)) in places.iter().zip(&parts) {
                for a in 0..3 {
                    at[a] += value * x[a];
                    (0..2).for_each(|b| tangents[b][a] += slope[b] * x[a]);
                }
            }
            if mesh.form != Form::Solid {
                tangents[1] = [0.0, 1.0, 0.0];
            }
            let area = cross(tangents[0], tangents[1]);
            let size = area.iter().map(|x| x * x).sum::<f64>().sqrt();
            let inside = centre_of_cell[number];
            let outward = (0..3).map(|a| area[a] * (at[a] - inside[a])).sum::<f64>().signum();
            let weight = size * part * mesh.form.depth(at);
            let dual = dual(tangents);
            let row = face.iter().zip(&parts).map(|(&node, (value, slope))| Value {
                node,
                value: *value,
                gradient: [0, 1, 2].map(|a| slope[0] * dual[0][a] + slope[1] * dual[1][a]),
            });
            boundary.samples.push(at, weight, row);
            boundary.normals.push(area.map(|x| outward * x / size));
            boundary.sides.push(*side);
        }
    }
    boundary
}

/// Vectors along a surface whose products with its tangents are 1 with their own and 0 with the other.
fn dual(tangents: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [u, v] = tangents;
    let [uu, uv, vv] = [dot(u, u), dot(u, v), dot(v, v)];
    let determinant = uu * vv - uv * uv;
    [
        [0, 1, 2].map(|a| (vv * u[a] - uv * v[a]) / determinant),
        [0, 1, 2].map(|a| (uu * v[a] - uv * u[a]) / determinant),
    ]
}

/// Functions of the nodes of a face at one of its Gauss points, with their derivatives, and its part of the area.
fn face_point((form, order): (Form, usize), point: usize) -> (Vec<(f64, [f64; 2])>, f64) {
    let across = order + 1;
    let [first, second] = [point % across, point / across];
    let (u, part) = along(order, first);
    let of_edge: Vec<(f64, f64)> = (0..across).map(|n| line(order, n, u)).collect();
    if form != Form::Solid {
        return (of_edge.into_iter().map(|(value, slope)| (value, [slope, 0.0])).collect(), part);
    }
    let (v, other) = along(order, second);
    let of_row = |row: usize| {
        let (value, slope) = line(order, row, v);
        of_edge.iter().map(move |own| (own.0 * value, [own.1 * value, own.0 * slope]))
    };
    ((0..across).flat_map(of_row).collect(), part * other)
}

/// Centre of the nodes of the cell behind each face of the boundary.
fn centres(mesh: &Mesh) -> Vec<[f64; 3]> {
    let mut cells_of = vec![Vec::new(); mesh.nodes.len()];
    for (number, cell) in mesh.cells.iter().enumerate() {
        cell.iter().for_each(|&node| cells_of[node as usize].push(number));
    }
    let centre = |face: &Vec<u32>| {
        let behind = cells_of[face[0] as usize]
            .iter()
            .find(|&&cell| face.iter().all(|node| mesh.cells[cell].contains(node)))
            .expect("a face belongs to a cell");
        let cell = &mesh.cells[*behind];
        let count = cell.len() as f64;
        [0, 1, 2].map(|a| cell.iter().map(|&n| mesh.nodes[n as usize][a]).sum::<f64>() / count)
    };
    mesh.faces.iter().map(|(_, face)| centre(face)).collect()
}

//! Finite elements: linear functions along each edge of quadrilaterals and hexahedra.

use super::{Boundary, Form, Mesh, Samples, Space, Value};
use crate::math::matrix3::{self, cross};

/// Gauss points of two on the unit interval.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Creates the space of a mesh's functions, linear between its nodes. Points of a cell share one dilatation, so that
/// nearly incompressible bodies do not lock (Simo, Taylor & Pister 1985, Comput. Methods Appl. Mech. Eng. 51, 177–208,
/// doi 10.1016/0045-7825(85)90033-7).
pub fn finite_elements(mesh: &Mesh) -> Space {
    let mut volume = Samples::default();
    let mut groups = Vec::new();
    let mut shares = vec![0.0; mesh.nodes.len()];
    for cell in &mesh.cells {
        let first = volume.len();
        for local in gauss_points(mesh.form) {
            let (at, weight, row) = sample(mesh, cell, local);
            for value in &row {
                shares[value.node as usize] += weight * value.value;
            }
            volume.push(at, weight, row);
        }
        groups.push(first..volume.len());
    }
    Space {
        form: mesh.form,
        nodes: mesh.nodes.clone(),
        volume,
        groups,
        boundary: boundary(mesh),
        at_nodes: None,
        shares,
        links: mesh.edges(),
    }
}

fn gauss_points(form: Form) -> Vec<[f64; 3]> {
    let count = if form == Form::Solid { 8 } else { 4 };
    let point = |n: usize| match form {
        Form::Solid => [GAUSS[n & 1], GAUSS[n >> 1 & 1], GAUSS[n >> 2]],
        _ => [GAUSS[n & 1], 0.0, GAUSS[n >> 1]],
    };
    (0..count).map(point).collect()
}

/// Place, weight and row of a point of a cell.
pub(super) fn sample(mesh: &Mesh, cell: &[u32], local: [f64; 3]) -> ([f64; 3], f64, Vec<Value>) {
    let axes = mesh.form.axes();
    let shapes: Vec<(f64, [f64; 3])> =
        (0..cell.len()).map(|n| shape(mesh.form, n, local)).collect();
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
    let points = if axes.len() == 2 { 4.0 } else { 8.0 };
    let weight = determinant.abs() / points * mesh.form.depth(at);
    let row = cell.iter().zip(&shapes).map(|(&node, (value, slope))| {
        let mut gradient = [0, 1, 2].map(|a| (0..3).map(|b| slope[b] * inverse[b][a]).sum());
        if axes.len() == 2 {
            gradient[1] = 0.0;
        }
        Value { node, value: *value, gradient }
    });
    (at, weight, row.collect())
}

/// Function of a corner and its derivatives at a place of the unit cell.
pub(super) fn shape(form: Form, corner: usize, local: [f64; 3]) -> (f64, [f64; 3]) {
    let bits = match form {
        Form::Solid => [corner & 1, corner >> 1 & 1, corner >> 2],
        _ => [corner & 1, 2, corner >> 1],
    };
    let factors = [0, 1, 2].map(|a| match bits[a] {
        0 => (1.0 - local[a], -1.0),
        1 => (local[a], 1.0),
        _ => (1.0, 0.0),
    });
    let value = factors[0].0 * factors[1].0 * factors[2].0;
    let slope = [0, 1, 2].map(|a| factors[a].1 * factors[(a + 1) % 3].0 * factors[(a + 2) % 3].0);
    (value, slope)
}

/// Points of the boundary: two Gauss points an edge, four a face, with the functions of the edge or face and their
/// gradients along it; across it they have none.
pub(super) fn boundary(mesh: &Mesh) -> Boundary {
    let centre_of_cell = centres(mesh);
    let mut boundary = Boundary::default();
    for (number, (side, face)) in mesh.faces.iter().enumerate() {
        let corners: Vec<[f64; 3]> = face.iter().map(|&n| mesh.nodes[n as usize]).collect();
        for n in 0..face.len() {
            let local = [GAUSS[n & 1], GAUSS[n >> 1]];
            let parts = face_shape(face.len(), local);
            let (mut at, mut along) = ([0.0; 3], [[0.0; 3]; 2]);
            for (x, (value, slope)) in corners.iter().zip(&parts) {
                for a in 0..3 {
                    at[a] += value * x[a];
                    (0..2).for_each(|b| along[b][a] += slope[b] * x[a]);
                }
            }
            if face.len() == 2 {
                along[1] = [0.0, 1.0, 0.0];
            }
            let area = cross(along[0], along[1]);
            let size = area.iter().map(|x| x * x).sum::<f64>().sqrt();
            let inside = centre_of_cell[number];
            let outward = (0..3).map(|a| area[a] * (at[a] - inside[a])).sum::<f64>().signum();
            let weight = size / face.len() as f64 * mesh.form.depth(at);
            let dual = dual(along);
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

fn face_shape(corners: usize, [u, v]: [f64; 2]) -> Vec<(f64, [f64; 2])> {
    if corners == 2 {
        return vec![(1.0 - u, [-1.0, 0.0]), (u, [1.0, 0.0])];
    }
    vec![
        ((1.0 - u) * (1.0 - v), [v - 1.0, u - 1.0]),
        (u * (1.0 - v), [1.0 - v, -u]),
        ((1.0 - u) * v, [-v, 1.0 - u]),
        (u * v, [v, u]),
    ]
}

/// Centre of the cell behind each face of the boundary.
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

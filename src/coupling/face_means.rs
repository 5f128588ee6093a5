//! Means over the cells of a footprint on the top or the bottom of a solid.

use std::collections::BTreeMap;

use super::footprint::{Placement, SparseVector, cells_on_plane, cells_on_radius};
use crate::method::fem::Temperatures;
use crate::method::mesh::{Geometry, Mesh};
use crate::scene::Footprint;

/// For each cell the weights of nodal values, which sum to 1: `Σ_i w_i T_i = ∫ T dA / A`.
///
/// The weights are the nodal vectors of loads on the same cells over the areas of these. Heat fluxes on the cells and
/// mean temperatures there are therefore conjugate in the body's own equations, and the transfer is conservative.
pub struct FaceMeans {
    cells: Vec<CellMean>,
}

struct CellMean {
    /// Symmetry class, node and weight.
    heat: Vec<(usize, usize, f64)>,
    /// Place [m] and weight of nodes of the displacement mesh, on the whole face.
    points: Vec<([f64; 3], f64)>,
}

impl FaceMeans {
    /// Means of a footprint about a place [m] on the top if `high`, on the mesh of heat. If means of mechanical
    /// quantities are needed, also on the mesh of displacements.
    pub fn of(
        (heat, force): (&Mesh, Option<&Mesh>),
        high: bool,
        footprint: &Footprint,
        [x, y]: [f64; 2],
    ) -> Self {
        let place = Placement { x, y, radius: footprint.radius().unwrap_or_default() };
        let of_heat = seen_on(heat, footprint, &place).map(|cell| heat_weights(heat, high, &cell));
        let mut cells: Vec<CellMean> =
            of_heat.map(|heat| CellMean { heat, points: Vec::new() }).collect();
        if let Some(mesh) = force {
            for (cell, seen) in cells.iter_mut().zip(seen_on(mesh, footprint, &place)) {
                cell.points = points(mesh, high, &seen);
            }
        }
        Self { cells }
    }

    /// Mean temperature above the initial one on a cell [K].
    pub fn rise(&self, cell: usize, temperatures: &Temperatures) -> f64 {
        let value = |&(class, node, weight): &(usize, usize, f64)| {
            temperatures.get(class).and_then(|part| part.get(node)).map_or(0.0, |t| weight * t)
        };
        self.cells[cell].heat.iter().map(value).sum()
    }

    /// Returns the weights of nodal temperatures of each symmetry class, in the plane of the face, and true if that is
    /// the top.
    pub fn on_face(&self, cell: usize, mesh: &Mesh) -> (Vec<Vec<f64>>, bool) {
        let [nx, ny, nz] = mesh.sided_counts();
        let plane = nx * ny;
        let mut weights = vec![Vec::new(); mesh.parities().len()];
        let mut high = false;
        for &(class, node, weight) in &self.cells[cell].heat {
            high |= node >= plane * (nz - 1);
            let own: &mut Vec<f64> = &mut weights[class];
            own.resize(plane, 0.0);
            own[node % plane] += weight;
        }
        (weights, high)
    }

    /// Places [m] and weights whose sum is the mean on a cell of a field interpolated between nodes.
    pub fn points(&self, cell: usize) -> &[([f64; 3], f64)] {
        &self.cells[cell].points
    }
}

/// A cell as seen at each image of the meshed part of a face: axes along which it is mirrored, and nodal vector.
type Seen = Vec<([bool; 2], SparseVector)>;

fn seen_on(
    mesh: &Mesh,
    footprint: &Footprint,
    place: &Placement,
) -> impl Iterator<Item = Seen> + use<> {
    let images: Vec<([bool; 2], Vec<SparseVector>)> = match mesh.geometry {
        Geometry::Axisymmetric => {
            vec![([false; 2], cells_on_radius(&mesh.axes[0], footprint, place.radius))]
        }
        Geometry::Box => {
            let plane = [&mesh.axes[0], &mesh.axes[1]];
            let of_image = |image| (image, cells_on_plane(plane, footprint, place, image));
            images_of(mesh).map(of_image).collect()
        }
    };
    let count = images.first().map_or(0, |(_, cells)| cells.len());
    (0..count).map(move |cell| {
        images.iter().map(|(image, cells)| (*image, cells[cell].clone())).collect()
    })
}

/// Mirror images of the mesh that form the body.
fn images_of(mesh: &Mesh) -> impl Iterator<Item = [bool; 2]> {
    let [x, y] = mesh.mirrored.map(|is_mirrored| if is_mirrored { 2 } else { 1 });
    (0..y).flat_map(move |j| (0..x).map(move |i| [i == 1, j == 1]))
}

fn area(cell: &Seen) -> f64 {
    cell.iter().flat_map(|(_, vector)| vector).map(|(_, weight)| weight).sum()
}

/// Weights of the parts of a field: odd ones have the sign of the image.
fn heat_weights(mesh: &Mesh, high: bool, cell: &Seen) -> Vec<(usize, usize, f64)> {
    let [nx, ny, nz] = mesh.sided_counts();
    let first = if high { nx * ny * (nz - 1) } else { 0 };
    let area = area(cell);
    let mut weights = BTreeMap::new();
    for (class, parity) in mesh.parities().iter().enumerate() {
        for (image, vector) in cell {
            for &(node, weight) in vector {
                *weights.entry((class, first + node)).or_insert(0.0) +=
                    parity.sign(*image) * weight / area;
            }
        }
    }
    let nonzero = weights.into_iter().filter(|(_, weight)| *weight != 0.0);
    nonzero.map(|((class, node), weight)| (class, node, weight)).collect()
}

fn points(mesh: &Mesh, high: bool, cell: &Seen) -> Vec<([f64; 3], f64)> {
    let [x, y, z] = &mesh.axes;
    let depth = if high { z.end() } else { z.start() };
    let area = area(cell);
    let signed = |value: f64, is_image: bool| if is_image { -value } else { value };
    let places = |image: &[bool; 2], node: usize| match mesh.geometry {
        Geometry::Axisymmetric => around(x.nodes[node], depth),
        Geometry::Box => {
            let [i, j] = [node % x.len(), node / x.len()];
            vec![[signed(x.nodes[i], image[0]), signed(y.nodes[j], image[1]), depth]]
        }
    };
    let mut points = Vec::new();
    for (image, vector) in cell {
        for &(node, weight) in vector {
            let places = places(image, node);
            let weight = weight / area / places.len() as f64;
            points.extend(places.into_iter().map(|place| (place, weight)));
        }
    }
    points
}

/// Places on a circle whose mean of a component along x, y or z is that of the circle.
fn around(radius: f64, depth: f64) -> Vec<[f64; 3]> {
    match radius > 0.0 {
        true => [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .map(|[x, y]| [radius * x, radius * y, depth])
            .to_vec(),
        false => vec![[0.0, 0.0, depth]],
    }
}

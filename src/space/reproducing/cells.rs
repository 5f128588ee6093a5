//! Gauss points of a mesh's cells and of their facets on the surface.

use super::super::{Boundary, Mesh, Samples};
use super::cell_map::{Place, gauss_points};
use super::facets::Facet;
use super::{Functions, Refused, Row};

/// Points of the volume, `count` along each edge of a cell.
pub(super) fn volume(mesh: &Mesh, functions: &Functions, count: usize) -> Result<Samples, Refused> {
    let rule = gauss_points(mesh.form.axes(), [0.0; 3], [1.0; 3], count);
    let mut samples = Samples::default();
    let mut row = Row::default();
    for cell in &mesh.cells {
        for &(local, weight) in &rule {
            let place = Place::of(mesh, cell, local);
            functions.evaluate(place.at, true, &mut row)?;
            let volume = weight * place.volume() * mesh.form.depth(place.at);
            samples.push(place.at, volume, row.values());
        }
    }
    Ok(samples)
}

/// Points of the sides, `count` along each edge of a facet, with values and gradients.
pub(super) fn boundary(
    mesh: &Mesh,
    functions: &Functions,
    surface: &[Vec<Facet>],
    count: usize,
) -> Result<Boundary, Refused> {
    let mut boundary = Boundary::default();
    let mut row = Row::default();
    for (cell, facets) in mesh.cells.iter().zip(surface) {
        for facet in facets.iter().filter(|facet| facet.side.is_some()) {
            for (local, weight) in on_facet(mesh, facet, [0.0; 3], [1.0; 3], count) {
                let place = Place::of(mesh, cell, local);
                functions.evaluate(place.at, true, &mut row)?;
                push(&mut boundary, mesh, facet, &place, weight, &row);
            }
        }
    }
    Ok(boundary)
}

/// Gauss points of the part of a facet that lies within `low` to `high` of the unit cell.
pub(super) fn on_facet(
    mesh: &Mesh,
    facet: &Facet,
    mut low: [f64; 3],
    high: [f64; 3],
    count: usize,
) -> Vec<([f64; 3], f64)> {
    low[facet.axis] = if facet.upper { 1.0 } else { 0.0 };
    let along: Vec<usize> =
        mesh.form.axes().iter().copied().filter(|&axis| axis != facet.axis).collect();
    gauss_points(&along, low, high, count)
}

/// Adds a point of a facet, unless it is on a plane of symmetry. Returns its outward area vector.
pub(super) fn push(
    boundary: &mut Boundary,
    mesh: &Mesh,
    facet: &Facet,
    place: &Place,
    weight: f64,
    row: &Row,
) -> [f64; 3] {
    let outward = if facet.upper { weight } else { -weight };
    let area = place.area(facet.axis).map(|x| outward * mesh.form.depth(place.at) * x);
    if let Some(side) = facet.side {
        let size = area.iter().map(|x| x * x).sum::<f64>().sqrt();
        boundary.samples.push(place.at, size, row.values());
        boundary.normals.push(area.map(|x| x / size));
        boundary.sides.push(side);
    }
    area
}

//! Meshes of bodies that crack: uniform, as cracks may run anywhere, also along planes of symmetry.

use crate::method::mesh::{Axis, Geometry, Layering, Mesh, Weight};
use crate::scene::{Mesh as MeshKeys, Shape, Solid};

/// Builds the mesh of a body whose damage spreads over a length [m], with multiples of the usual numbers of elements
/// along its surface and through its thickness. A plane section is one element wide along y.
pub fn crack_mesh(solid: &Solid, mirrored: [bool; 2], length: f64, factors: [f64; 2]) -> Mesh {
    let Solid { shape, mesh: keys, .. } = solid;
    let usual = keys.spacing_of_cracks(length);
    let [along, through] = [0, 1].map(|way| usual[way] / factors[way]);
    let lateral = |own: usize, half: f64, spacing: f64| match mirrored[own] {
        true => half_axis(half, spacing),
        false => axis([-half, half], spacing, Weight::Uniform),
    };
    let height = axis([-shape.thickness(), 0.0], through, Weight::Uniform);
    let layering = Layering::default();
    match *shape {
        Shape::Box([lx, ly, _]) => {
            let x = lateral(0, lx / 2.0, along);
            let y = match solid.cracks_in_space() {
                true => lateral(1, ly / 2.0, along),
                false => {
                    let low = if mirrored[1] { 0.0 } else { -ly / 2.0 };
                    axis([low, ly / 2.0], ly, Weight::Uniform)
                }
            };
            Mesh { axes: [x, y, height], mirrored, geometry: Geometry::Box, layering }
        }
        Shape::Disc(disc) => {
            let radii = axis([0.0, disc.radius], along, Weight::Radial);
            let axes = [radii, Axis::point(), height];
            Mesh { axes, mirrored, geometry: Geometry::Axisymmetric, layering }
        }
    }
}

/// Equal linear elements, at most `spacing` long [m].
fn axis([start, end]: [f64; 2], spacing: f64, weight: Weight) -> Axis {
    let count = MeshKeys::elements_of_cracks(end - start, spacing);
    let place = |i: usize| match i {
        i if i == count => end,
        i => start + (end - start) * i as f64 / count as f64,
    };
    Axis::from_element_ends(&(0..=count).map(place).collect::<Vec<_>>(), 1, weight)
}

/// Half of an odd number of equal linear elements, at most `spacing` long [m]: half of the middle one stands beside the
/// plane of symmetry at zero, so that a crack there breaks one row of elements, as it does elsewhere.
fn half_axis(half: f64, spacing: f64) -> Axis {
    let count = MeshKeys::elements_of_cracks(2.0 * half, spacing) | 1;
    let place = |i: usize| half * (2 * i + 1) as f64 / count as f64;
    let inner = (0..count / 2).map(place);
    let ends: Vec<f64> = [0.0].into_iter().chain(inner).chain([half]).collect();
    Axis::from_element_ends(&ends, 1, Weight::Uniform)
}

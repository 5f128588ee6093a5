//! Meshes of bodies that crack: uniform, as cracks may run anywhere.

use crate::method::mesh::{Axis, Geometry, Layering, Mesh, Weight};
use crate::scene::{Mesh as MeshKeys, Shape, Solid};

/// Builds the mesh of a body whose damage spreads over a length [m], with multiples of the usual numbers of elements
/// along its surface and through its thickness. A plane section is one element wide along y.
pub fn crack_mesh(solid: &Solid, mirrored: [bool; 2], length: f64, factors: [f64; 2]) -> Mesh {
    let Solid { shape, mesh: keys, .. } = solid;
    let usual = keys.spacing_of_cracks(length);
    let [along, through] = [0, 1].map(|way| usual[way] / factors[way]);
    let low = |axis: usize, half: f64| if mirrored[axis] { 0.0 } else { -half };
    let height = axis([-shape.thickness(), 0.0], through, Weight::Uniform);
    let layering = Layering::default();
    match *shape {
        Shape::Box([lx, ly, _]) => {
            let x = axis([low(0, lx / 2.0), lx / 2.0], along, Weight::Uniform);
            let across = if solid.cracks_in_space() { along } else { ly };
            let y = axis([low(1, ly / 2.0), ly / 2.0], across, Weight::Uniform);
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

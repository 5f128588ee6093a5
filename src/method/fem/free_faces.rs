//! Unsupported faces of a body: equilibrium prescribes their traction.

use super::elastic::Support;
use crate::method::mesh::{Geometry, Mesh, MeshFace};

/// Ends of the axes of a mesh that are faces without a support.
#[derive(Debug, Clone)]
pub struct FreeFaces {
    /// Coordinates of the low and the high end of each axis [m].
    ends: [[Option<f64>; 2]; 3],
}

impl FreeFaces {
    pub fn of(mesh: &Mesh, supports: &[(MeshFace, Support)]) -> Self {
        let end = |axis: usize, high: bool| {
            let own = &mesh.axes[axis];
            let is_face = own.elements() > 0 && (high || !is_inside(mesh, axis));
            let is_held = supports.iter().any(|(face, _)| *face == MeshFace { axis, high });
            (is_face && !is_held).then(|| if high { own.end() } else { own.start() })
        };
        Self { ends: [0, 1, 2].map(|axis| [false, true].map(|high| end(axis, high))) }
    }

    /// Returns true if an end of an axis is a free face.
    pub fn is_free(&self, axis: usize, high: bool) -> bool {
        self.ends[axis][usize::from(high)].is_some()
    }

    /// Returns the axis normal to the free face that contains a place of the mesh; top and bottom take precedence over
    /// sides.
    pub fn normal_at(&self, place: [f64; 3]) -> Option<usize> {
        [2, 0, 1].into_iter().find(|&axis| self.ends[axis].contains(&Some(place[axis])))
    }
}

/// Returns true if the low end of an axis is a plane or axis of symmetry.
pub fn is_inside(mesh: &Mesh, axis: usize) -> bool {
    match mesh.geometry {
        Geometry::Box => axis < 2 && mesh.mirrored[axis],
        Geometry::Axisymmetric => axis == 0 && mesh.axes[0].start() == 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Axis, Layering, Weight};

    #[test]
    fn supported_faces_and_planes_of_symmetry_are_not_free() {
        let axis = || Axis::from_element_ends(&[0.0, 1.0, 2.0], 1, Weight::Uniform);
        let mesh = Mesh {
            axes: [axis(), axis(), axis()],
            mirrored: [true, false],
            geometry: Geometry::Box,
            layering: Layering::default(),
        };
        let bottom = (MeshFace { axis: 2, high: false }, Support::Clamped);
        let faces = FreeFaces::of(&mesh, &[bottom]);
        assert_eq!(faces.normal_at([0.0, 1.0, 0.0]), None);
        assert_eq!(faces.normal_at([2.0, 0.0, 0.0]), Some(0));
        assert_eq!(faces.normal_at([0.0, 0.0, 1.0]), Some(1));
        assert_eq!(faces.normal_at([2.0, 2.0, 2.0]), Some(2));
    }
}

//! Solids that crack: their law, and the mesh that it needs.

use super::grid::lateral_extents;
use super::types::{Mesh, PlaneSection, Shape, Solid};
use crate::laws::fracture::GradientDamage;

/// Tolerance of spacings, relative: a third of a length is a third of it within rounding.
const SLACK: f64 = 1e-9;

impl Solid {
    /// Returns true if cracks run in the body.
    pub fn cracks(&self) -> bool {
        self.materials_of_layers().into_iter().any(|own| own.fracture.cracking.is_some())
    }

    /// Returns true if cracks run in space, and not in a section.
    pub fn cracks_in_space(&self) -> bool {
        self.cracks() && self.section.is_none() && matches!(self.shape, Shape::Box(_))
    }

    /// Law of cracks of a body of one material; `None` if nothing cracks or constants are missing.
    pub fn damage(&self) -> Option<GradientDamage> {
        let material = self.material.as_ref()?.material();
        let law = material.at(self.initial_temperature).law()?;
        let is_plane_stress = self.section == Some(PlaneSection::PlaneStress);
        material.fracture.cracking?.law(&law, material.fracture.toughness, is_plane_stress)
    }
}

impl Solid {
    /// Extents of what cracks along the axes of its mesh [m]: of a section x and z, in space x, y and z.
    pub fn extents_of_cracks(&self) -> Vec<f64> {
        let [x, y] = lateral_extents(&self.shape);
        match self.cracks_in_space() {
            true => vec![x, y, self.shape.thickness()],
            false => vec![x, self.shape.thickness()],
        }
    }

    /// Number of nodes with which cracks of a length [m] are resolved.
    pub fn nodes_of_cracks(&self, length: f64) -> f64 {
        let [along, through] = self.mesh.spacing_of_cracks(length);
        let extents = self.extents_of_cracks();
        let (last, others) = extents.split_last().expect("there are two at least");
        let others: f64 = others.iter().map(|extent| extent / along + 1.0).product();
        others * (last / through + 1.0)
    }
}

impl Mesh {
    /// Nodes per length of damage that resolve a crack.
    pub const NODES_PER_LENGTH: f64 = 3.0;

    /// Node spacings of a body that cracks, along its surface and through its thickness [m].
    pub fn spacing_of_cracks(&self, length: f64) -> [f64; 2] {
        let along = self.spacing.unwrap_or(length / Self::NODES_PER_LENGTH);
        [along, self.depth_spacing.unwrap_or(along)]
    }

    /// Number of equal elements along an extent [m] that are at most `spacing` long [m].
    pub fn elements_of_cracks(extent: f64, spacing: f64) -> usize {
        (extent / spacing * (1.0 - SLACK)).ceil().max(1.0) as usize
    }

    /// Returns true if a node spacing resolves the length of damage.
    pub fn resolves_cracks(spacing: f64, length: f64) -> bool {
        spacing * Self::NODES_PER_LENGTH <= length * (1.0 + SLACK)
    }
}

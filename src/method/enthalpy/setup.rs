//! What a nonlinear heat problem is made of, as plain data.

use crate::laws::{Conduction, ConductionError};
use crate::method::mesh::{Mesh, MeshFace};

/// A body and what surrounds it.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Where it is mirrored, all loads are even about the planes.
    pub mesh: Mesh,
    /// Temperature [K] from which enthalpies count; best that of the body at time zero.
    pub reference: f64,
    pub materials: Vec<Conduction>,
    /// For each element of the mesh along z, its material; empty for the first one throughout.
    pub layers: Vec<usize>,
    pub contacts: Vec<Contact>,
    /// An end of an axis may stand here more than once, as with convection and radiation. All others are insulated.
    pub faces: Vec<Face>,
}

/// Resistance to heat between two layers: both have nodes of their own there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Elements along z that lie below it: at least one, and not all of them.
    pub below: usize,
    /// Contact conductance [W/(m² K)].
    pub conductance: f64,
}

/// A thermal condition on an end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    pub place: MeshFace,
    pub condition: Condition,
}

/// Condition on a face, and what the value of the face in [`Loads`] is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// Heat flux into the body [W/m²] is the value.
    Flux,
    /// Heat transfer coefficient h [W/(m² K)]; the value is the ambient temperature [K].
    Convective(f64),
    /// Emissivity ε of `q = ε σ (T∞⁴ − T⁴)` [1]; the value is the temperature of the surroundings T∞ [K].
    Radiative(f64),
    /// Prescribed temperature [K] is the value. On an edge of two, the one listed first holds.
    Prescribed,
}

/// What drives the heat, or a time derivative of it.
#[derive(Debug, Clone, Copy)]
pub struct Loads<'a> {
    /// Heat into the nodes of the bottom and the top [W], x running fastest; empty for none. As of linear elements on
    /// all nodes ([`linear_mesh`]).
    pub surface: &'a [Vec<f64>; 2],
    /// For each face its value, as its [`Condition`] says.
    pub faces: &'a [f64],
}

/// Why there is no such problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    #[error("reference temperature {0} K (allowed: finite, above 0)")]
    Reference(f64),
    #[error("material {0}: {1}")]
    Material(usize, ConductionError),
    #[error("{layers} layers for {elements} elements along z (allowed: one for each, or none)")]
    Layers { layers: usize, elements: usize },
    #[error("a layer of material {material} (allowed: below {materials})")]
    NoMaterial { material: usize, materials: usize },
    #[error("a contact above {below} elements (allowed: 1 to {most}, each once)")]
    ContactPlace { below: usize, most: usize },
    #[error("contact conductance {0} W/(m² K) (allowed: finite, 0 or above)")]
    Conductance(f64),
    #[error("heat transfer coefficient {0} W/(m² K) (allowed: finite, 0 or above)")]
    Coefficient(f64),
    #[error("emissivity {0} (allowed: 0 to 1)")]
    Emissivity(f64),
    #[error("a face on axis {0} that has no elements")]
    NoFace(usize),
    #[error("nodes of an axis do not ascend")]
    Nodes,
}

/// The same nodes in linear elements.
pub fn linear_mesh(mesh: &Mesh) -> Mesh {
    let mut linear = mesh.clone();
    linear.axes.iter_mut().for_each(|axis| axis.order = 1);
    linear
}

impl Setup {
    pub fn check(&self) -> Result<(), SetupError> {
        if !(self.reference > 0.0 && self.reference.is_finite()) {
            return Err(SetupError::Reference(self.reference));
        }
        let ascends = |axis: &[f64]| axis.windows(2).all(|pair| pair[0] < pair[1]);
        if !self.mesh.axes.iter().all(|axis| ascends(&axis.nodes)) {
            return Err(SetupError::Nodes);
        }
        for (number, material) in self.materials.iter().enumerate() {
            material.check().map_err(|error| SetupError::Material(number, error))?;
        }
        self.check_layers()?;
        self.faces.iter().try_for_each(|face| self.check_face(face))
    }

    fn check_layers(&self) -> Result<(), SetupError> {
        let elements = self.mesh.axes[2].elements();
        let layers = self.layers.len();
        if layers != elements && layers != 0 {
            return Err(SetupError::Layers { layers, elements });
        }
        let materials = self.materials.len();
        if let Some(&material) = self.layers.iter().chain(&[0]).find(|&&m| m >= materials) {
            return Err(SetupError::NoMaterial { material, materials });
        }
        for (i, &Contact { below, conductance }) in self.contacts.iter().enumerate() {
            let earlier = self.contacts[..i].iter().any(|other| other.below == below);
            if below == 0 || below >= elements || earlier {
                return Err(SetupError::ContactPlace { below, most: elements.saturating_sub(1) });
            }
            if !(conductance >= 0.0 && conductance.is_finite()) {
                return Err(SetupError::Conductance(conductance));
            }
        }
        Ok(())
    }

    fn check_face(&self, face: &Face) -> Result<(), SetupError> {
        let axis = face.place.axis;
        if axis > 2 || self.mesh.axes[axis].elements() == 0 {
            return Err(SetupError::NoFace(axis));
        }
        match face.condition {
            Condition::Convective(h) if !(h >= 0.0 && h.is_finite()) => {
                Err(SetupError::Coefficient(h))
            }
            Condition::Radiative(emissivity) if !(0.0..=1.0).contains(&emissivity) => {
                Err(SetupError::Emissivity(emissivity))
            }
            _ => Ok(()),
        }
    }

    /// Material of each element along z of linear elements on all nodes.
    pub(super) fn linear_layers(&self) -> Vec<usize> {
        let axis = &self.mesh.axes[2];
        let material = |i: usize| self.layers.get(i / axis.order).copied().unwrap_or(0);
        (0..axis.len() - 1).map(material).collect()
    }
}

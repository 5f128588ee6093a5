//! Data of a nonlinear heat problem.

use crate::laws::{Conduction, ConductionError};
use crate::method::mesh::{Mesh, MeshFace};

/// A body and its surroundings.
#[derive(Debug, Clone)]
pub struct Setup {
    /// If it is mirrored, all loads are even about the planes.
    pub mesh: Mesh,
    /// Reference temperature of enthalpies [K], preferably that of the body at time zero.
    pub reference: f64,
    pub materials: Vec<Conduction>,
    /// Material of each element of the mesh along z; empty if the first one applies throughout.
    pub layers: Vec<usize>,
    pub contacts: Vec<Contact>,
    /// An end of an axis may be listed more than once, as with convection and radiation. All other ends are insulated.
    pub faces: Vec<Face>,
}

/// Thermal resistance between two layers, which have separate nodes there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Number of elements along z below it: at least one, and not all of them.
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

/// Condition on a face, with the meaning of the face's value in [`Loads`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// The value is the heat flux into the body [W/m²].
    Flux,
    /// Heat transfer coefficient h [W/(m² K)]; the value is the ambient temperature [K].
    Convective(f64),
    /// Emissivity ε of `q = ε σ (T∞⁴ − T⁴)` [1]; the value is the temperature of the surroundings T∞ [K].
    Radiative(f64),
    /// Heat transfer coefficient h [W/(m² K)] and temperature [K] of a bath, which covers what is below its surface;
    /// the value is the height of the surface [m], along z from the origin.
    Wetted { coefficient: f64, ambient: f64 },
    /// The value is the prescribed temperature [K]. On an edge of two such faces, the one listed first applies.
    Prescribed,
}

/// Loads of the heat problem, or a time derivative of them.
#[derive(Debug, Clone, Copy)]
pub struct Loads<'a> {
    /// Heat into the nodes of the bottom and the top [W], x running fastest, as for linear elements on all nodes
    /// ([`linear_mesh`]); empty for none.
    pub surface: &'a [Vec<f64>; 2],
    /// Value of each face, as defined by its [`Condition`].
    pub faces: &'a [f64],
}

/// Reasons why a setup is invalid.
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
    #[error("a bath at {0} K (allowed: finite, above 0)")]
    Ambient(f64),
    #[error("emissivity {0} (allowed: 0 to 1)")]
    Emissivity(f64),
    #[error("a face on axis {0} that has no elements")]
    NoFace(usize),
    #[error("nodes of an axis do not ascend")]
    Nodes,
}

/// Returns the mesh of linear elements on the same nodes.
pub fn linear_mesh(mesh: &Mesh) -> Mesh {
    let mut linear = mesh.clone();
    linear.layering = mesh.layering.in_parts(mesh.axes[2].order);
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
            Condition::Wetted { coefficient, .. }
                if !(coefficient >= 0.0 && coefficient.is_finite()) =>
            {
                Err(SetupError::Coefficient(coefficient))
            }
            Condition::Wetted { ambient, .. } if !(ambient > 0.0 && ambient.is_finite()) => {
                Err(SetupError::Ambient(ambient))
            }
            Condition::Radiative(emissivity) if !(0.0..=1.0).contains(&emissivity) => {
                Err(SetupError::Emissivity(emissivity))
            }
            _ => Ok(()),
        }
    }

    /// Material of each linear element along z.
    pub(super) fn linear_layers(&self) -> Vec<usize> {
        let axis = &self.mesh.axes[2];
        let material = |i: usize| self.layers.get(i / axis.order).copied().unwrap_or(0);
        (0..axis.len() - 1).map(material).collect()
    }
}

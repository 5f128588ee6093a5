//! The constants of bodies that units offer as parameters: each kind lists its own and knows where they stand.

mod bath;
mod droplet;
mod filament;
mod fluid;
mod lattice;
mod large_strain;
mod solid;

pub use bath::BathConstant;
pub use droplet::DropletConstant;
pub use filament::FilamentConstant;
pub use fluid::FluidConstant;
pub use lattice::LatticeConstant;
pub use solid::LayersOf;

use super::types::{Body, FaceName, Scene};
use crate::laws::{AtStart, MaterialConstant};
use crate::limits::Bounds;
use crate::quantity::Quantity;

/// A number within a body that may be set until initialisation ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Constant {
    InitialTemperature,
    /// Of the material of a solid, or of the law of viscosity of a fluid.
    Material(&'static MaterialConstant),
    /// Of the material of some layers.
    LayerMaterial {
        layers: LayersOf,
        constant: &'static MaterialConstant,
    },
    /// Thermal resistance between a layer, counted from 0, and the one above.
    ContactResistance {
        layer: usize,
    },
    ConvectionCoefficient {
        face: FaceName,
    },
    /// Of the bath of a solid.
    Bath(&'static BathConstant),
    Droplet(&'static DropletConstant),
    Filament(&'static FilamentConstant),
    Lattice(&'static LatticeConstant),
    /// Of the fluid of a droplet or filament.
    Fluid(&'static FluidConstant),
    /// Depth of the scene's flaw of this number, in one of its bodies.
    FlawDepth {
        flaw: usize,
    },
}

/// A constant as a unit names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OfferedConstant {
    /// Name of the variable after that of the body and a point.
    pub key: String,
    pub description: String,
    pub constant: Constant,
}

impl Constant {
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::InitialTemperature => Quantity::Temperature,
            Self::Material(constant) | Self::LayerMaterial { constant, .. } => constant.quantity,
            Self::ContactResistance { .. } => Quantity::ThermalResistance,
            Self::ConvectionCoefficient { .. } => Quantity::HeatTransferCoefficient,
            Self::Bath(constant) => constant.quantity,
            Self::Droplet(constant) => constant.quantity,
            Self::Filament(constant) => constant.quantity,
            Self::Lattice(constant) => constant.quantity,
            Self::Fluid(constant) => constant.quantity,
            Self::FlawDepth { .. } => Quantity::Length,
        }
    }

    /// Declared least and largest value.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Material(constant) | Self::LayerMaterial { constant, .. } => constant.bounds,
            Self::Bath(constant) => constant.bounds,
            Self::Lattice(constant) => constant.bounds,
            _ => Bounds::from(0.0),
        }
    }

    /// Dependence of outputs at time zero on the constant of a body. Those of large strain have their mass, and are in
    /// equilibrium, from the first.
    pub fn at_start(&self, body: &Body) -> AtStart {
        match self {
            Self::Material(constant) | Self::LayerMaterial { constant, .. }
                if matches!(body, Body::LargeStrain(_))
                    && constant.start == AtStart::Never
                    && !large_strain::is_thermal(constant) =>
            {
                AtStart::PoleAtZero
            }
            Self::InitialTemperature | Self::FlawDepth { .. } => AtStart::PoleAtZero,
            Self::Material(constant) | Self::LayerMaterial { constant, .. } => constant.start,
            Self::ContactResistance { .. } | Self::ConvectionCoefficient { .. } | Self::Bath(_) => {
                AtStart::Never
            }
            Self::Droplet(constant) => constant.start,
            Self::Filament(_) => AtStart::Never,
            Self::Lattice(constant) => constant.start,
            Self::Fluid(constant) => constant.start,
        }
    }
}

impl Body {
    /// The constants that the body offers; `name` is that of the body.
    pub fn constants(&self, name: &str) -> Vec<OfferedConstant> {
        match self {
            Body::Solid(solid) => solid::offered(name, solid),
            Body::Droplet(droplet) => droplet::offered(name, droplet),
            Body::LargeStrain(solid) => large_strain::offered(name, solid),
            Body::Filament(filament) => filament::offered(name, filament),
            Body::Lattice(own) => lattice::offered(name, own),
            Body::Reservoir(_) => vec![OfferedConstant {
                key: "initial_temperature".to_owned(),
                description: format!("temperature of {name} at time zero"),
                constant: Constant::InitialTemperature,
            }],
        }
    }

    /// Places of a constant of the body: one, or one in each of some layers.
    ///
    /// # Panics
    /// If a body of this kind does not offer the constant.
    pub fn places_of(&mut self, constant: &Constant) -> Vec<&mut f64> {
        match (self, constant) {
            (body, Constant::InitialTemperature) => vec![body.initial_temperature_mut()],
            (Body::Solid(solid), constant) => solid::places(solid, constant),
            (Body::Droplet(droplet), Constant::Droplet(constant)) => {
                constant.place(droplet).into_iter().collect()
            }
            (Body::Droplet(droplet), Constant::Fluid(constant)) => {
                constant.place(&mut droplet.fluid).into_iter().collect()
            }
            (Body::Filament(filament), Constant::Fluid(constant)) => {
                constant.place(&mut filament.fluid).into_iter().collect()
            }
            (Body::Filament(filament), Constant::Filament(constant)) => {
                constant.place(filament).into_iter().collect()
            }
            (Body::Filament(filament), Constant::Material(constant)) => {
                filament.fluid.viscosity.number(constant.key).into_iter().collect()
            }
            (Body::Droplet(droplet), Constant::Material(constant)) => {
                droplet.fluid.viscosity.number(constant.key).into_iter().collect()
            }
            (Body::LargeStrain(solid), constant) => large_strain::places(solid, constant),
            (Body::Lattice(lattice), Constant::Lattice(constant)) => {
                constant.place(lattice).into_iter().collect()
            }
            _ => panic!("a body offers the constants of its kind"),
        }
    }

    /// Place among the kinds in the list of a unit's parameters.
    fn rank(&self) -> u8 {
        match self {
            Body::Solid(_) => 0,
            Body::Reservoir(_) => 1,
            Body::Droplet(_) => 2,
            Body::LargeStrain(_) => 3,
            Body::Filament(_) => 4,
            Body::Lattice(_) => 5,
        }
    }
}

impl Scene {
    /// The bodies in the order in which a unit lists their parameters: by kind, then by name.
    pub fn bodies_by_kind(&self) -> Vec<(&str, &Body)> {
        let mut bodies: Vec<_> =
            self.body.iter().map(|(name, body)| (name.as_str(), body)).collect();
        bodies.sort_by_key(|(_, body)| body.rank());
        bodies
    }
}

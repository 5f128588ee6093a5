//! Amounts that loads carry through a face: a row for each, with its value per area on a footprint.

use crate::limits::{self, Limits};
use crate::quantity::Quantity;

/// An amount per area and time, or the power of a whole footprint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    HeatFlux,
    Power,
    Pressure,
    ShearX,
    ShearY,
    ShearR,
}

/// Action of an amount on a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Heat that enters.
    Heat,
    /// Force into the body.
    Inward,
    /// Force along x (0) or y (1).
    Along(usize),
    /// Force away from the middle of the footprint.
    Outward,
}

impl Channel {
    /// All channels, in the order of a load's inputs.
    pub const ALL: [Self; 6] =
        [Self::HeatFlux, Self::Power, Self::Pressure, Self::ShearX, Self::ShearY, Self::ShearR];

    /// Last part of the names of its variables, and its key among a load's start values.
    pub const fn key(self) -> &'static str {
        match self {
            Self::HeatFlux => "heat_flux",
            Self::Power => "power",
            Self::Pressure => "pressure",
            Self::ShearX => "shear_x",
            Self::ShearY => "shear_y",
            Self::ShearR => "shear_r",
        }
    }

    /// Noun for the descriptions of inputs.
    pub const fn words(self) -> &'static str {
        match self {
            Self::HeatFlux => "heat flux into the body",
            Self::Power => "heating power of the whole footprint, into the body",
            Self::Pressure => "pressure that acts into the body",
            Self::ShearX => "shear traction along x",
            Self::ShearY => "shear traction along y",
            Self::ShearR => "radial shear traction, outward positive",
        }
    }

    pub const fn direction(self) -> Direction {
        match self {
            Self::HeatFlux | Self::Power => Direction::Heat,
            Self::Pressure => Direction::Inward,
            Self::ShearX => Direction::Along(0),
            Self::ShearY => Direction::Along(1),
            Self::ShearR => Direction::Outward,
        }
    }

    pub const fn quantity(self) -> Quantity {
        match self {
            Self::HeatFlux => Quantity::HeatFlux,
            Self::Power => Quantity::HeatFlow,
            Self::Pressure | Self::ShearX | Self::ShearY | Self::ShearR => Quantity::Stress,
        }
    }

    pub fn limits(self) -> Limits {
        match self {
            Self::HeatFlux => limits::heat_flux(),
            Self::Power => limits::power(),
            Self::Pressure | Self::ShearX | Self::ShearY | Self::ShearR => limits::traction(),
        }
    }

    pub const fn is_heat(self) -> bool {
        matches!(self.direction(), Direction::Heat)
    }

    /// Returns true if the amount is that of a whole footprint rather than per area.
    pub const fn is_of_whole(self) -> bool {
        matches!(self, Self::Power)
    }

    /// Largest value per area that a unit of the amount makes on a footprint of an equivalent area A [m²], and its
    /// derivative by that area: 1/A and −1/A² for amounts of the whole footprint, else 1 and 0.
    pub fn density(self, area: f64) -> [f64; 2] {
        if self.is_of_whole() { [1.0 / area, -1.0 / (area * area)] } else { [1.0, 0.0] }
    }

    pub const fn is_shear(self) -> bool {
        matches!(self.direction(), Direction::Along(_) | Direction::Outward)
    }
}

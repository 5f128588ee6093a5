//! Amounts that loads carry through a face: a row for each amount that has a value in every cell of a footprint.

use crate::limits::{self, Limits};
use crate::quantity::Quantity;

/// An amount per area and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    HeatFlux,
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
    pub const ALL: [Self; 5] =
        [Self::HeatFlux, Self::Pressure, Self::ShearX, Self::ShearY, Self::ShearR];

    /// Last part of the names of its variables, and its key among a load's start values.
    pub const fn key(self) -> &'static str {
        match self {
            Self::HeatFlux => "heat_flux",
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
            Self::Pressure => "pressure that acts into the body",
            Self::ShearX => "shear traction along x",
            Self::ShearY => "shear traction along y",
            Self::ShearR => "radial shear traction, outward positive",
        }
    }

    pub const fn direction(self) -> Direction {
        match self {
            Self::HeatFlux => Direction::Heat,
            Self::Pressure => Direction::Inward,
            Self::ShearX => Direction::Along(0),
            Self::ShearY => Direction::Along(1),
            Self::ShearR => Direction::Outward,
        }
    }

    pub const fn quantity(self) -> Quantity {
        if self.is_heat() { Quantity::HeatFlux } else { Quantity::Stress }
    }

    pub fn limits(self) -> Limits {
        if self.is_heat() { limits::heat_flux() } else { limits::traction() }
    }

    pub const fn is_heat(self) -> bool {
        matches!(self, Self::HeatFlux)
    }

    pub const fn is_shear(self) -> bool {
        matches!(self.direction(), Direction::Along(_) | Direction::Outward)
    }
}

//! Constants of a strand and of the plate below it.

use std::f64::consts::FRAC_PI_4;

use crate::laws::Fluid;
use crate::method::sph::Phases;
use crate::port::WallCells;

/// Everything that is known of a filament before time starts.
#[derive(Debug, Clone, PartialEq)]
pub struct LinePlan {
    pub fluid: Fluid,
    /// Temperature of which the heat content is zero; the fluid is molten there [K].
    pub reference: f64,
    /// Inner diameter of the nozzle D [m].
    pub diameter: f64,
    /// Least height of the outlet while fluid comes [m].
    pub least_height: f64,
    /// Length of a segment where the strand is as thick as the nozzle [m].
    pub spacing: f64,
    /// Largest volume that may come [m³].
    pub most: f64,
    /// [m/s²]
    pub gravity: f64,
    /// Heat transfer coefficient to the air [W/(m² K)].
    pub air: f64,
    /// Conductance of the contact with the plate; `None` for perfect contact [W/(m² K)].
    pub conductance: Option<f64>,
    /// Cells of the plate; `None` for a plane that neither conducts nor moves.
    pub cells: Option<WallCells>,
}

/// Segments in addition to those of the largest volume, for strands that end early.
const SPARE: usize = 16;

impl LinePlan {
    /// Section of the nozzle [m²].
    pub fn outlet(&self) -> f64 {
        FRAC_PI_4 * self.diameter.powi(2)
    }

    /// Volume at which a segment is complete [m³].
    pub fn segment_volume(&self) -> f64 {
        self.outlet() * self.spacing
    }

    /// Largest number of segments: twice those of the largest volume, because interrupted strands end in the middle of
    /// a segment. The state holds those that have been laid.
    pub fn capacity(&self) -> usize {
        2 * (self.most / self.segment_volume()).ceil() as usize + SPARE
    }

    /// Phases of a fluid that freezes and conducts heat.
    pub fn phases(&self) -> Option<Phases> {
        let freezing = self.fluid.freezing().filter(|_| self.fluid.conductivity > 0.0)?;
        let molten = [self.fluid.specific_heat, self.fluid.conductivity];
        Some(Phases::of(&freezing, molten, self.reference))
    }
}

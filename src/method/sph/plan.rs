//! What a model of droplets is made from.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::images::copies;
use crate::kernel::Kernel;
use crate::port::WallCells;
pub use crate::scene::Placement;
use crate::scene::Precision;

/// Droplets of one fluid above one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct DropletPlan {
    /// 3, or 2 for a plane model in x and z.
    pub dimension: usize,
    /// Whether all of it is round about the axis x = y = 0: particles are rings, of which x is the radius. Of three
    /// dimensions, with neither mirrors nor ends along x and y.
    pub axisymmetric: bool,
    /// Distance of particles Δx [m].
    pub spacing: f64,
    /// Support radius of the kernel over the distance of particles, H/Δx.
    pub support: f64,
    pub kernel: Kernel,
    pub fluid: Fluid,
    pub placement: Placement,
    /// Precision of pair interactions.
    pub precision: Precision,
    /// δ of the density diffusion, for a smoothing length H/2.
    pub density_diffusion: f64,
    /// Whether density diffusion is corrected by renormalised gradients, which leaves linear
    /// densities (such as of a fluid at rest under gravity) as they are.
    pub corrected_diffusion: bool,
    /// Whether particles are moved from crowded places to empty ones.
    pub shifting: bool,
    /// Body force a mass [m/s²].
    pub gravity: [f64; 3],
    /// The planes x = 0 and y = 0 mirror the model, which then holds only x ≥ 0 (y ≥ 0).
    pub mirrors: [bool; 2],
    /// How far the model goes along x, y and z.
    pub extents: [Extent; 3],
    /// In the order of their times; none where drops are released on demand.
    pub releases: Vec<Release>,
    /// Drops that somebody else releases, see [`DropletSph::ask`](super::DropletSph::ask).
    pub demand: Option<Demand>,
    /// Nothing for a droplet in free space.
    pub wall: Option<Wall>,
}

/// A Newtonian fluid that conducts heat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// At rest ρ₀ [kg/m³].
    pub density: f64,
    /// Dynamic viscosity µ [Pa s].
    pub viscosity: f64,
    /// [J/(kg K)]
    pub specific_heat: f64,
    /// [W/(m K)]; 0 leaves heat out.
    pub conductivity: f64,
    /// [N/m]
    #[serde(default)]
    pub surface_tension: f64,
    /// Speed of sound c₀ of the model [m/s]: at least ten times the fastest flow keeps the density
    /// within 1 %.
    pub sound_speed: f64,
}

/// How far a model goes along an axis: at least two support radii, if it ends.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Extent {
    #[default]
    Open,
    /// Again and again the same after this length [m]; with neither mirror nor wall along this axis.
    Periodic(f64),
    /// Between insulated planes at 0 and at this length [m]. The fluid slips along those across x and
    /// y, and sticks to those across z, of which the one at 0 may be the wall.
    Closed(f64),
}

/// One round droplet that starts to move at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Release {
    /// [s]
    pub time: f64,
    pub centre: [f64; 3],
    pub diameter: f64,
    /// [m/s]
    pub velocity: [f64; 3],
    /// [K]
    pub temperature: f64,
}

/// Drops that are released when they are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// How many there may be.
    pub most: usize,
    /// A drop as it is expected. All have its diameter; its temperature is the model's reference.
    pub expected: Release,
}

impl DropletPlan {
    /// Along which of x and y nothing moves as a whole.
    pub fn even(&self) -> [bool; 2] {
        self.mirrors.map(|mirrored| mirrored || self.axisymmetric)
    }

    /// Axes in which particles stand: 3, or x and z alone.
    pub fn axes(&self) -> usize {
        if self.axisymmetric { 2 } else { self.dimension }
    }

    /// Volume of a drop of some diameter [m³], in a plane model [m²].
    pub fn volume(&self, diameter: f64) -> f64 {
        match self.dimension {
            2 => PI / 4.0 * diameter.powi(2),
            _ => PI / 6.0 * diameter.powi(3),
        }
    }

    /// Number of particles of a drop of some diameter [m], images left out.
    pub fn particles_of(&self, diameter: f64) -> f64 {
        if self.axisymmetric {
            return PI / 8.0 * (diameter / self.spacing).powi(2);
        }
        self.volume(diameter) / self.spacing.powi(self.dimension as i32) / copies(self.mirrors)
    }

    /// All drops that there may be; those on demand as if all were asked for at once.
    pub fn drops(&self) -> impl Iterator<Item = Release> + '_ {
        let asked = self.demand.iter().flat_map(|demand| (0..demand.most).map(|_| demand.expected));
        self.releases.iter().copied().chain(asked)
    }

    /// The zero of the model's temperatures [K].
    pub fn reference_temperature(&self) -> f64 {
        self.drops().next().map_or(0.0, |drop| drop.temperature)
    }
}

/// The rigid plane z = 0, to which the fluid sticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// Where temperatures come from and heat and impulse go to.
    pub cells: WallCells,
    /// Contact angle of the fluid [rad].
    pub contact_angle: f64,
    /// `√(kρc)` of a solid below [W √s/(m² K)], whose surface answers after a step; nothing for a wall
    /// whose temperature is held.
    pub effusivity: Option<f64>,
}

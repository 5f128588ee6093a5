//! Definition of a model of droplets.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::images::copies;
use super::method::Method;
use super::phases::Phases;
use crate::kernel::Kernel;
pub use crate::laws::Freezing;
use crate::laws::Viscosity;
use crate::port::WallCells;
pub use crate::scene::Placement;
use crate::scene::Precision;

/// Droplets of one fluid above one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct DropletPlan {
    /// 3, or 2 for a plane model in x and z.
    pub dimension: usize,
    /// True for an axisymmetric model about x = y = 0: particles are rings, and x is the radius. It
    /// has three dimensions, and neither mirrors nor ends along x and y.
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
    /// Advance of viscosity in time.
    pub viscous: Viscous,
    /// δ of the density diffusion, for a smoothing length H/2.
    pub density_diffusion: f64,
    /// True if density diffusion is corrected by renormalised gradients. The correction preserves
    /// linear densities, such as that of a fluid at rest under gravity.
    pub corrected_diffusion: bool,
    /// True if particles are shifted from crowded to sparse regions.
    pub shifting: bool,
    /// Body force per mass [m/s²].
    pub gravity: [f64; 3],
    /// The planes x = 0 and y = 0 mirror the model, which then holds only x ≥ 0 (y ≥ 0).
    pub mirrors: [bool; 2],
    /// Extents of the model along x, y and z.
    pub extents: [Extent; 3],
    /// Releases in the order of their times; empty where drops are released on demand.
    pub releases: Vec<Release>,
    /// Drops released by a caller, see [`DropletSph::ask`](super::DropletSph::ask).
    pub demand: Option<Demand>,
    /// The nozzle from which fluid comes; `None` for drops.
    pub feed: Option<Feed>,
    /// The wall; `None` for a droplet in free space.
    pub wall: Option<Wall>,
}

/// Advance of viscosity in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viscous {
    /// With the other forces, in steps short enough for it; for Newtonian fluids of constant viscosity.
    Explicit,
    /// Solved at the end of each step; its stability sets no limit. Time steps follow from the viscosity at a shear
    /// rate [1/s].
    Implicit { rate: f64 },
    /// The same together with pressure: sound sets no limit either.
    WithPressure { rate: f64 },
}

/// Constants of a fluid as particles take them, with the speed of sound of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// Density at rest ρ₀ [kg/m³].
    pub density: f64,
    /// Dynamic viscosity µ [Pa s].
    pub viscosity: Viscosity,
    /// [J/(kg K)]
    pub specific_heat: f64,
    /// Thermal conductivity [W/(m K)]; 0 disables heat.
    pub conductivity: f64,
    /// [N/m]
    #[serde(default)]
    pub surface_tension: f64,
    /// Speed of sound c₀ of the model [m/s]: at least ten times the fastest flow keeps the density
    /// within 1 %.
    pub sound_speed: f64,
    /// Freezing of the fluid; `None` if it stays liquid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freezing: Option<Freezing>,
}

/// Extent of a model along an axis: at least two support radii, if bounded.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Extent {
    #[default]
    Open,
    /// Periodic with this length [m]; without mirror or wall along this axis.
    Periodic(f64),
    /// Bounded by insulated planes at 0 and at this length [m]. The fluid slips along those across
    /// x and y, and sticks to those across z; the one at z = 0 may be the wall.
    Closed(f64),
}

/// A round droplet and the time at which it starts to move.
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

/// Drops released on demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest number of drops.
    pub most: usize,
    /// The expected drop. All drops have its diameter; its temperature is the model's reference.
    pub expected: Release,
}

/// A round nozzle that points downwards, from which fluid comes, see [`feed`](super::feed).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feed {
    /// Inner diameter of the outlet [m].
    pub diameter: f64,
    /// Place of the outlet at time zero [m].
    pub outlet: [f64; 3],
    /// Largest volume that may come [m³].
    pub most: f64,
    /// Expected largest speed of fluid and nozzle [m/s].
    pub fastest: f64,
    /// Temperature of the fluid at time zero, the reference of the model [K].
    pub temperature: f64,
    /// Coefficient of the heat that passes to the air [W/(m² K)].
    pub air: f64,
}

impl DropletPlan {
    /// The plan with the cheaper of explicit steps and of its own at a speed of the flow [m/s]; its own where the
    /// viscosity is not constant.
    pub fn with_cheaper_viscosity(self, fastest: f64) -> Self {
        if self.fluid.viscosity.constant().is_none() {
            return self;
        }
        let explicit = Self { viscous: Viscous::Explicit, ..self.clone() };
        let cost = |plan: &Self| Method::of(plan).step_cost() / Method::of(plan).step_at(fastest);
        if cost(&explicit) <= cost(&self) { explicit } else { self }
    }

    /// Returns for x and y whether there is no motion as a whole along that axis.
    pub fn even(&self) -> [bool; 2] {
        self.mirrors.map(|mirrored| mirrored || self.axisymmetric)
    }

    /// Number of axes in which particles are arranged: 3, or 2 (x and z).
    pub fn axes(&self) -> usize {
        if self.axisymmetric { 2 } else { self.dimension }
    }

    /// Phases of a fluid that freezes and conducts heat.
    pub fn phases(&self) -> Option<Phases> {
        let fluid = &self.fluid;
        let frozen = fluid.freezing.filter(|_| fluid.conductivity > 0.0)?;
        let molten = [fluid.specific_heat, fluid.conductivity];
        Some(Phases::of(&frozen, molten, self.reference_temperature()))
    }

    /// Volume of a drop of a diameter [m³]; in a plane model [m²].
    pub fn volume(&self, diameter: f64) -> f64 {
        match self.dimension {
            2 => PI / 4.0 * diameter.powi(2),
            _ => PI / 6.0 * diameter.powi(3),
        }
    }

    /// Number of particles of a drop of a diameter [m], images excluded.
    pub fn particles_of(&self, diameter: f64) -> f64 {
        if self.axisymmetric {
            return PI / 8.0 * (diameter / self.spacing).powi(2);
        }
        self.volume(diameter) / self.spacing.powi(self.dimension as i32) / copies(self.mirrors)
    }

    /// Number of particles once all drops are released, or all fluid has come, images excluded.
    pub fn particles(&self) -> usize {
        let drops = self.drops().map(|drop| self.particles_of(drop.diameter)).sum::<f64>();
        let fed = self.feed.map_or(0.0, |feed| feed.most / self.spacing.powi(3));
        (drops + fed).round() as usize
    }

    /// All possible drops; those on demand as if all were requested at once.
    pub fn drops(&self) -> impl Iterator<Item = Release> + '_ {
        let asked = self.demand.iter().flat_map(|demand| (0..demand.most).map(|_| demand.expected));
        self.releases.iter().copied().chain(asked)
    }

    /// Zero of the model's temperatures [K].
    pub fn reference_temperature(&self) -> f64 {
        let of_drops = || self.drops().next().map_or(0.0, |drop| drop.temperature);
        self.feed.map_or_else(of_drops, |feed| feed.temperature)
    }
}

/// The rigid plane z = 0, to which the fluid sticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// Cells that provide temperatures and receive heat and impulse.
    pub cells: WallCells,
    /// Contact angle of the fluid [rad].
    pub contact_angle: f64,
    /// `√(kρc)` of a solid below [W √s/(m² K)] whose surface responds after a step; `None` for a
    /// wall of prescribed temperature.
    pub effusivity: Option<f64>,
    /// Conductance of the contact [W/(m² K)]; `None` for perfect contact.
    pub conductance: Option<f64>,
}

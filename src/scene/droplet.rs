//! Droplets, the walls that make units of them and their couplings to solids.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use super::types::{CellValues, Footprint};
use crate::kernel::Kernel;

/// Round drops of one fluid that arrive, along −z, above the plane z = 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Droplet {
    #[serde(default)]
    pub method: DropletMethod,
    /// [m]
    pub diameter: f64,
    /// Speed towards the wall at the release [m/s].
    pub impact_velocity: f64,
    /// Uniform temperature at the release [K].
    pub initial_temperature: f64,
    /// Gap between a drop's lowest point and the wall at its release [m]; half a `spacing` if left
    /// out.
    pub height: Option<f64>,
    /// Distance of particles [m].
    pub spacing: f64,
    pub fluid: Fluid,
    /// 3, or 2 for a plane model in x and z, a metre deep.
    #[serde(default = "three")]
    pub dimension: usize,
    #[serde(default)]
    pub symmetry: DropletSymmetry,
    #[serde(default)]
    pub placement: Placement,
    /// Body force a mass towards −z [m/s²].
    #[serde(default)]
    pub gravity: f64,
    #[serde(default)]
    pub kernel: Kernel,
    /// Support radius of the kernel over the distance of particles.
    #[serde(default = "default_support")]
    pub support: f64,
    #[serde(default)]
    pub precision: Precision,
    /// δ of the density diffusion.
    #[serde(default = "default_density_diffusion")]
    pub density_diffusion: f64,
    /// Whether renormalised gradients correct the density diffusion, so that it leaves a fluid at
    /// rest under gravity alone.
    #[serde(default = "yes")]
    pub corrected_diffusion: bool,
    /// Whether particles are moved from crowded places to empty ones. If nothing is said, they are not
    /// where surface tension rules (up to a Weber number of 1000).
    #[serde(default)]
    pub shifting: Option<bool>,
    /// A copy of the drop for each entry.
    #[serde(default = "one_arrival")]
    pub arrivals: Vec<Arrival>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DropletMethod {
    /// Weakly compressible smoothed particle hydrodynamics.
    #[default]
    Sph,
}

/// How much of the drops is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DropletSymmetry {
    /// A quarter, or half of a plane model, where all drops arrive at the origin on a lattice.
    #[default]
    Auto,
    None,
    Quarter,
}

/// A Newtonian fluid that conducts heat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// At rest [kg/m³].
    pub density: f64,
    /// Dynamic viscosity [Pa s].
    pub viscosity: f64,
    /// [J/(kg K)]
    pub specific_heat: f64,
    /// [W/(m K)]; 0 leaves heat out.
    pub conductivity: f64,
    /// [N/m]
    #[serde(default)]
    pub surface_tension: f64,
    /// Angle of contact with the wall [rad]; matters with surface tension only.
    #[serde(default = "right_angle")]
    pub contact_angle: f64,
    /// Speed of sound of the model [m/s]; ten times [`Droplet::governing_speed`] if left out.
    pub sound_speed: Option<f64>,
}

/// How particles are laid out at first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Placement {
    /// On a cubic lattice.
    #[default]
    Lattice,
    /// At random with a smallest distance (Poisson disk).
    BlueNoise,
}

/// Precision of what is computed for a pair of particles; positions and sums over time are always
/// double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    #[default]
    Single,
    Double,
}

/// When and where a drop is released.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arrival {
    /// Since the beginning of the run [s].
    #[serde(default)]
    pub time: f64,
    /// Place of the centre [m].
    #[serde(default)]
    pub x: f64,
    #[serde(default)]
    pub y: f64,
}

/// A wall below a droplet whose temperatures are inputs, and heat fluxes and tractions outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    pub name: String,
    /// Name of the droplet.
    pub under: String,
    /// Rings or tiles, centred on the origin.
    pub footprint: Footprint,
    /// √(kρc) of the solid to which a master takes the heat [W √s/(m² K)], which then bounds the heat of first
    /// contact by what the solid's surface can answer within a step; left out for a wall whose
    /// temperature is held.
    #[serde(default)]
    pub effusivity: Option<f64>,
    #[serde(default)]
    pub start: WallStart,
}

/// Start values of a wall's inputs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallStart {
    /// [K]; the droplet's own temperature if left out.
    pub temperature: Option<CellValues>,
}

/// Exchange of heat and momentum between a droplet and the top of a solid, or of heat between two solids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// Name of the droplet, or `SOLID.top` of the solid below.
    pub from: String,
    /// `SOLID.top` below a droplet, `SOLID.bottom` of the solid above another.
    pub to: String,
    /// Heat flux between two solids over the difference of their temperatures there [W/(m² K)].
    pub conductance: Option<f64>,
    /// Whether pressure and shear of the fluid load the solid, too.
    #[serde(default = "yes")]
    pub traction: bool,
    /// Longest time between two exchanges [s]; chosen from the fluid's motion and the contact's
    /// heat if left out, that of a communication step between solids.
    pub interval: Option<f64>,
    /// The solid's mesh is fine out to this distance from each arrival [m]; as far as the drop is
    /// expected to spread if left out.
    pub radius: Option<f64>,
}

fn three() -> usize {
    3
}

fn default_support() -> f64 {
    3.0
}

fn default_density_diffusion() -> f64 {
    0.1
}

fn right_angle() -> f64 {
    FRAC_PI_2
}

fn one_arrival() -> Vec<Arrival> {
    vec![Arrival::default()]
}

fn yes() -> bool {
    true
}

/// Speed of sound over the governing speed where the scene names none: density then stays within 1 %.
const SOUND_OVER_FLOW: f64 = 10.0;

/// Pressure of a drop that viscosity stops, over µU/D.
const VISCOUS_PRESSURE: f64 = 12.0;

/// What moves or presses a fluid most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Governing {
    Flow,
    Surface,
    Viscosity,
}

/// Weber number from which inertia rules.
const INERTIAL: f64 = 1000.0;

impl Droplet {
    /// Gap between a drop's lowest point and the wall at its release [m].
    pub fn gap(&self) -> f64 {
        self.height.unwrap_or(0.5 * self.spacing)
    }

    /// The larger of the speed of a drop that has fallen through its gap and its own height, and of
    /// capillary waves, √(σ/(ρR)) [m/s].
    pub fn fastest_flow(&self) -> f64 {
        let fall = 2.0 * self.gravity * (self.gap() + self.diameter);
        let capillary = self.fluid.surface_tension / (self.fluid.density * 0.5 * self.diameter);
        (self.impact_velocity.powi(2) + fall).max(capillary).sqrt()
    }

    /// √(2σ/(ρΔx)) [m/s], the speed that belongs to Laplace's pressure 2σ/Δx of the sharpest surface that
    /// particles can show; no less than √(σ/(ρΔx)) of the shortest waves and √(2σ/(ρR)) of the whole drop. Sound
    /// that is not much faster lets the outermost particles come loose, one after the other.
    pub fn surface_speed(&self) -> f64 {
        (2.0 * self.fluid.surface_tension / (self.fluid.density * self.spacing)).sqrt()
    }

    /// √(12 µU/(ρD)) [m/s], the speed that belongs to the pressure by which a drop of high viscosity stops:
    /// above that of the flow where Re < 12. Drops of Re 0.8 to 5 were seen to bear 12 to 14 µU/D.
    pub fn viscous_speed(&self) -> f64 {
        let Fluid { density, viscosity, .. } = self.fluid;
        (VISCOUS_PRESSURE * viscosity * self.impact_velocity / (density * self.diameter)).sqrt()
    }

    /// The speed beside which that of sound is to be large [m/s], and what it is the speed of.
    pub fn governing_speed(&self) -> (Governing, f64) {
        [(Governing::Surface, self.surface_speed()), (Governing::Viscosity, self.viscous_speed())]
            .into_iter()
            .fold((Governing::Flow, self.fastest_flow()), |largest, other| {
                if other.1 > largest.1 { other } else { largest }
            })
    }

    /// Speed of sound of the model [m/s].
    pub fn sound_speed(&self) -> f64 {
        self.fluid.sound_speed.unwrap_or_else(|| SOUND_OVER_FLOW * self.governing_speed().1)
    }

    /// Whether all drops arrive at the origin.
    pub fn is_centred(&self) -> bool {
        self.arrivals.iter().all(|arrival| arrival.x == 0.0 && arrival.y == 0.0)
    }

    /// Whether particles are shifted.
    pub fn shifts(&self) -> bool {
        let Fluid { density, surface_tension, .. } = self.fluid;
        let inertia = density * self.impact_velocity.powi(2) * self.diameter;
        self.shifting.unwrap_or(inertia > INERTIAL * surface_tension || surface_tension == 0.0)
    }

    /// Along which of x and y the half of the model stands for the whole.
    pub fn mirrors(&self) -> [bool; 2] {
        let halved = match self.symmetry {
            DropletSymmetry::Auto => self.is_centred() && self.placement == Placement::Lattice,
            symmetry => symmetry == DropletSymmetry::Quarter,
        };
        [halved, halved && self.dimension == 3]
    }

    /// Diameter over which a drop spreads at most [m], the drop's own where it does not fall.
    ///
    /// D_max/D = 0.87 Re^(1/5) − 0.40 Re^(2/5) We^(−1/2) with Re = ρUD/µ and We = ρU²D/σ
    /// (I. V. Roisman, Phys. Fluids 21 (2009) 052104, doi 10.1063/1.3129283), a fit for impacts
    /// much faster than their waves.
    pub fn spread_diameter(&self) -> f64 {
        let Fluid { density, viscosity, surface_tension, .. } = self.fluid;
        let reynolds = density * self.impact_velocity * self.diameter / viscosity;
        let weber = density * self.impact_velocity.powi(2) * self.diameter / surface_tension;
        let ratio = 0.87 * reynolds.powf(0.2) - 0.40 * reynolds.powf(0.4) / weber.sqrt();
        // Of a drop at rest the fit makes NaN, of which `max` takes the 1, too.
        ratio.max(1.0) * self.diameter
    }
}

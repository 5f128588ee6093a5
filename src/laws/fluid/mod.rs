//! Laws of fluids: the constants of a droplet's liquid, its viscosity, and the speeds that follow from them.

mod evaporation;
mod frozen;
pub mod viscosity;

pub use evaporation::{Evaporation, SphericalCap};
pub use frozen::Frozen;
pub use viscosity::Viscosity;

use std::f64::consts::{FRAC_PI_2, PI};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::heat::Melting;
use crate::limits::{plausible, temperature, within};

/// A fluid that conducts heat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// Mass density at rest [kg/m³].
    #[schemars(transform = within(1e-3, 1e6, "kg/m³", "the density").plausible(&plausible::FLUID_DENSITY))]
    pub density: f64,
    /// Dynamic viscosity: a number, a table over the temperature, or a law of the shear rate [Pa s].
    #[schemars(transform = within(1e-9, 1e6, "Pa s", "the viscosity").plausible(&plausible::VISCOSITY))]
    pub viscosity: Viscosity,
    /// Specific heat capacity [J/(kg K)].
    #[schemars(transform = within(1e-1, 1e7, "J/(kg K)", "the specific heat capacity")
        .plausible(&plausible::FLUID_SPECIFIC_HEAT))]
    pub specific_heat: f64,
    /// Thermal conductivity [W/(m K)]; 0 disables heat.
    #[schemars(transform = within(0.0, 1e6, "W/(m K)", "the thermal conductivity")
        .plausible(&plausible::FLUID_CONDUCTIVITY))]
    pub conductivity: f64,
    /// Surface tension [N/m].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e5, "N/m", "the surface tension")
        .plausible(&plausible::SURFACE_TENSION)
        .otherwise("0: no surface tension"))]
    pub surface_tension: f64,
    /// Contact angle at the wall [rad]; relevant only with surface tension.
    #[serde(default = "right_angle")]
    #[schemars(transform = within(0.0, PI, "rad", "")
        .says("the angle of contact is out of bounds", "0 to 3.14159 (rad)")
        .otherwise("π/2, which is 90°"))]
    pub contact_angle: f64,
    /// Artificial speed of sound of the model [m/s]; pressures of the first impact grow with it.
    #[schemars(transform = within(1e-6, 1e6, "m/s", "the speed of sound")
        .otherwise("ten times the fastest flow or √(2σ/(ρΔx))")
        .condition("at least five times these"))]
    pub sound_speed: Option<f64>,
    /// Freezing and melting. Without it the fluid stays liquid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend(
        "otherwise" = "none: the fluid stays liquid",
        "condition" = "with particles or a line and a `conductivity`; below the fluid's first temperature; with a latent heat \
                       of 4 % and more of the heat that warms the fluid from 0 K"
    ))]
    pub melting: Option<Melting>,
    /// Constants of the frozen fluid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend(
        "otherwise" = "those of the molten fluid",
        "condition" = "with `melting`; within a factor of 50 of those of the molten fluid"
    ))]
    pub frozen: Option<Frozen>,
    /// Freezing temperature of a fluid without `melting`, which stays liquid: a step below it warns [K].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = temperature().plausible(&plausible::FREEZING)
        .otherwise("none: no warning")
        .condition("below `boils_at`"))]
    pub freezes_at: Option<f64>,
    /// Boiling temperature, which the model ignores: a step above it warns [K].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = temperature().plausible(&plausible::BOILING)
        .otherwise("none: no warning"))]
    pub boils_at: Option<f64>,
    /// Evaporation, which the model ignores: scenes whose drops would dry are warned of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "none: no warning", "condition" = "with `boils_at`"))]
    pub evaporation: Option<Evaporation>,
}

/// Freezing of a fluid, with the constants of the frozen one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Freezing {
    pub melting: Melting,
    /// Specific heat capacity of the frozen fluid [J/(kg K)].
    pub specific_heat: f64,
    /// Its thermal conductivity [W/(m K)].
    pub conductivity: f64,
}

/// Pressure of a drop that viscosity stops, over µU/D.
const VISCOUS_PRESSURE: f64 = 12.0;

impl Fluid {
    /// Returns the freezing of the fluid; `None` if it stays liquid.
    pub fn freezing(&self) -> Option<Freezing> {
        let frozen = self.frozen.unwrap_or_default();
        self.melting.map(|melting| Freezing {
            melting,
            specific_heat: frozen.specific_heat.unwrap_or(self.specific_heat),
            conductivity: frozen.conductivity.unwrap_or(self.conductivity),
        })
    }

    /// Temperature below which the fluid begins to freeze [K].
    pub fn freezing_point(&self) -> Option<f64> {
        self.freezes_at.or(self.melting.map(|melting| melting.liquidus))
    }

    /// Thermal effusivity `e = √(k ρ c)` [W √s/(m² K)].
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.density * self.specific_heat).sqrt()
    }

    /// Square of the speed of capillary waves around a drop, `σ/(ρR)` [m²/s²], of a radius [m].
    pub fn capillary_speed_squared(&self, radius: f64) -> f64 {
        self.surface_tension / (self.density * radius)
    }

    /// √(2σ/(ρΔx)) [m/s], the speed equivalent to Laplace's pressure 2σ/Δx of the sharpest surface that particles at a
    /// distance Δx [m] resolve. It is no less than √(σ/(ρΔx)) of the shortest waves and √(2σ/(ρR)) of the whole drop.
    /// If sound is not much faster, the outermost particles detach one after the other.
    pub fn laplace_speed(&self, spacing: f64) -> f64 {
        (2.0 * self.surface_tension / (self.density * spacing)).sqrt()
    }

    /// The viscosity [Pa s] that stands for the fluid in dimensionless numbers, closed forms and estimates: that at a
    /// temperature [K] and, of a law of the shear rate, at a rate [1/s].
    pub fn reference_viscosity(&self, temperature: f64, rate: f64) -> f64 {
        self.viscosity.at(temperature).viscosity(rate)
    }

    /// √(12 µU/(ρD)) [m/s], the speed equivalent to the pressure at which a drop of high viscosity stops, of a
    /// reference viscosity µ [Pa s], an impact speed U [m/s] and a diameter D [m]; it exceeds that of the flow where Re
    /// < 12. Drops of Re 0.8 to 5 were measured at 12 to 14 µU/D. At Re 0.1 (asphalt, D/Δx 10 to 40) density stays
    /// within 0.5 % at communication points. Below that nothing was measured.
    pub fn viscous_speed(&self, viscosity: f64, speed: f64, diameter: f64) -> f64 {
        (VISCOUS_PRESSURE * viscosity * speed / (self.density * diameter)).sqrt()
    }
}

fn right_angle() -> f64 {
    FRAC_PI_2
}

//! Constants of a material at one temperature.

use serde::{Deserialize, Serialize};

use super::Thermoelastic;

/// Constants of an isotropic body as a scene names them. Those of elasticity may be left out where
/// nothing mechanical is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Constants {
    /// Mass density ρ [kg/m³].
    pub density: f64,
    /// Specific heat capacity c [J/(kg K)].
    pub specific_heat: f64,
    /// Thermal conductivity k [W/(m K)].
    pub conductivity: f64,
    /// Young's modulus E [Pa].
    pub young: Option<f64>,
    /// Poisson's ratio ν [1].
    pub poisson: Option<f64>,
    /// Coefficient of linear thermal expansion α [1/K].
    pub expansion: Option<f64>,
}

impl Constants {
    /// Volumetric heat capacity `ρ c` [J/(m³ K)].
    pub fn heat_capacity(&self) -> f64 {
        self.density * self.specific_heat
    }

    /// Thermal diffusivity `a = k / (ρ c)` [m²/s].
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / self.heat_capacity()
    }

    /// Thermal effusivity `e = √(k ρ c)` [W √s/(m² K)].
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.heat_capacity()).sqrt()
    }

    /// Returns the thermo-elastic law, if all of its constants are set.
    pub fn law(&self) -> Option<Thermoelastic> {
        let (young, poisson, expansion) = (self.young?, self.poisson?, self.expansion?);
        Some(Thermoelastic { young, poisson, expansion })
    }
}

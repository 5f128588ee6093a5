//! Conduction and storage of heat.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::enthalpy::Enthalpy;
use super::melting::{Melting, MeltingError};
use crate::laws::part::{Part, number_among};
use crate::laws::{AtStart, Curve, MaterialConstant, Property, PropertyError};
use crate::limits::{plausible, positive};
use crate::quantity::Quantity;

/// Fourier conduction `q = −k ∇T` and storage of heat, `Ḣ = −∇·q` with `H = ∫ ρ c dT + ρ L f`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Conduction {
    /// Mass density ρ [kg/m³]: a number, as mass is conserved.
    #[schemars(transform = positive("kg/m³", "the density").plausible(&plausible::DENSITY))]
    pub density: f64,
    /// Specific heat capacity c [J/(kg K)].
    #[schemars(transform = positive("J/(kg K)", "the specific heat capacity").plausible(&plausible::SPECIFIC_HEAT))]
    pub specific_heat: Property,
    /// Thermal conductivity k [W/(m K)].
    #[schemars(transform = positive("W/(m K)", "the thermal conductivity").plausible(&plausible::CONDUCTIVITY))]
    pub conductivity: Property,
    /// Solidus, liquidus and latent heat.
    #[schemars(extend("otherwise" = "does not melt"))]
    pub melting: Option<Melting>,
}

/// Reasons why constants of conduction are invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConductionError {
    #[error("density {0} kg/m³ (allowed: finite, above 0)")]
    Density(f64),
    #[error("specific heat capacity: {0}")]
    SpecificHeat(PropertyError),
    #[error("conductivity: {0}")]
    Conductivity(PropertyError),
    #[error("melting: {0}")]
    Melting(#[from] MeltingError),
}

impl Conduction {
    /// Refuses constants that are not positive, or whose tables are out of order.
    pub fn check(&self) -> Result<(), ConductionError> {
        if !(self.density > 0.0 && self.density.is_finite()) {
            return Err(ConductionError::Density(self.density));
        }
        self.specific_heat.check().map_err(ConductionError::SpecificHeat)?;
        self.conductivity.check().map_err(ConductionError::Conductivity)?;
        Ok(self.melting.as_ref().map_or(Ok(()), Melting::check)?)
    }

    /// Volumetric enthalpy `H = ∫ ρ c dT + ρ L f` above that of the solid at a reference temperature [K].
    pub fn enthalpy(&self, reference: f64) -> Enthalpy {
        Enthalpy::of_mixture(&[(1.0, self)], reference)
    }

    /// Conductivity and its integral (Kirchhoff) `θ = ∫ k dT` [W/m] from a reference temperature [K].
    pub fn kirchhoff(&self, reference: f64) -> Curve {
        self.conductivity.about(reference)
    }

    /// Returns true if heat obeys a linear equation.
    pub fn is_linear(&self) -> bool {
        self.specific_heat.is_constant()
            && self.conductivity.is_constant()
            && self.melting.is_none()
    }

    /// Returns the linear law at a temperature [K], without melting.
    pub fn linearised(&self, temperature: f64) -> Self {
        Self {
            density: self.density,
            specific_heat: self.specific_heat.at(temperature),
            conductivity: self.conductivity.at(temperature),
            melting: None,
        }
    }
}

impl Part for Conduction {
    fn parameters() -> &'static [MaterialConstant] {
        const {
            &[
                MaterialConstant {
                    key: "density",
                    description: "mass density",
                    quantity: Quantity::Density,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::Never,
                },
                MaterialConstant {
                    key: "specific_heat",
                    description: "specific heat capacity",
                    quantity: Quantity::SpecificHeat,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::Never,
                },
                MaterialConstant {
                    key: "conductivity",
                    description: "thermal conductivity",
                    quantity: Quantity::Conductivity,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::Never,
                },
            ]
        }
    }

    fn properties(&self) -> Vec<(&'static str, &Property)> {
        vec![("specific_heat", &self.specific_heat), ("conductivity", &self.conductivity)]
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        if key == "density" {
            return Some(&mut self.density);
        }
        let tables = [
            ("specific_heat", Some(&mut self.specific_heat)),
            ("conductivity", Some(&mut self.conductivity)),
        ];
        number_among(key, tables)
    }
}

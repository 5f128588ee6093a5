use super::enthalpy::Enthalpy;
use super::melting::{Melting, MeltingError};
use super::property::{Curve, Property, PropertyError};

/// What conducts and stores heat with constants that depend on the temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Substance {
    /// Mass density ρ [kg/m³]: a number, as mass is conserved where a body is at rest.
    pub density: f64,
    /// Specific heat capacity c [J/(kg K)].
    pub specific_heat: Property,
    /// Thermal conductivity k [W/(m K)].
    pub conductivity: Property,
    pub melting: Option<Melting>,
}

/// Why there is no such substance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SubstanceError {
    #[error("density {0} kg/m³ (allowed: finite, above 0)")]
    Density(f64),
    #[error("specific heat capacity: {0}")]
    SpecificHeat(PropertyError),
    #[error("conductivity: {0}")]
    Conductivity(PropertyError),
    #[error("melting: {0}")]
    Melting(#[from] MeltingError),
}

impl Substance {
    pub fn check(&self) -> Result<(), SubstanceError> {
        if !(self.density > 0.0 && self.density.is_finite()) {
            return Err(SubstanceError::Density(self.density));
        }
        self.specific_heat.check().map_err(SubstanceError::SpecificHeat)?;
        self.conductivity.check().map_err(SubstanceError::Conductivity)?;
        Ok(self.melting.as_ref().map_or(Ok(()), Melting::check)?)
    }

    /// Volumetric enthalpy `H = ∫ ρ c dT + ρ L f` above that of the solid at a reference temperature [K].
    pub fn enthalpy(&self, reference: f64) -> Enthalpy {
        Enthalpy::of_mixture(&[(1.0, self)], reference)
    }

    /// Conductivity and heat conductivity integral (Kirchhoff) `θ = ∫ k dT` [W/m] from a reference
    /// temperature [K].
    pub fn kirchhoff(&self, reference: f64) -> Curve {
        self.conductivity.about(reference)
    }
}

//! Melting between solidus and liquidus.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{plausible, positive, temperature};

/// Melting between two temperatures, or at one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Melting {
    /// Temperature at which melting begins [K].
    #[schemars(transform = temperature().plausible(&plausible::MELTING).guarded_from(plausible::MELTS_BESIDE_WARM))]
    pub solidus: f64,
    /// Temperature at which it is over [K]; it may be the solidus.
    #[schemars(transform = temperature().plausible(&plausible::MELTING).guarded_from(plausible::MELTS_BESIDE_WARM)
        .condition("from the solidus on"))]
    pub liquidus: f64,
    /// Heat that it takes, L [J/kg].
    #[schemars(transform = positive("J/kg", "the latent heat").plausible(&plausible::LATENT_HEAT))]
    pub latent_heat: f64,
}

/// Reasons why melting data are invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeltingError {
    #[error("solidus {0} K (allowed: finite, above 0 K)")]
    Solidus(f64),
    #[error("liquidus {liquidus} K (allowed: finite, at or above the solidus, {solidus} K)")]
    Liquidus { solidus: f64, liquidus: f64 },
    #[error("latent heat {0} J/kg (allowed: finite, above 0)")]
    LatentHeat(f64),
}

impl Melting {
    pub fn check(&self) -> Result<(), MeltingError> {
        let Self { solidus, liquidus, latent_heat } = *self;
        if !(solidus > 0.0 && solidus.is_finite()) {
            return Err(MeltingError::Solidus(solidus));
        }
        if !(liquidus >= solidus && liquidus.is_finite()) {
            return Err(MeltingError::Liquidus { solidus, liquidus });
        }
        match latent_heat > 0.0 && latent_heat.is_finite() {
            true => Ok(()),
            false => Err(MeltingError::LatentHeat(latent_heat)),
        }
    }

    /// Returns true if solidus and liquidus are one temperature to rounding.
    pub fn is_isothermal(&self) -> bool {
        const ROUNDING: f64 = 1e-12;
        self.liquidus - self.solidus <= ROUNDING * self.liquidus
    }
}

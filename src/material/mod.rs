//! Constitutive laws, one a file. The enum is also the parser of a scene's `material` table.

mod admissible;
mod constants;
mod elastoplastic;
mod enthalpy;
mod law;
mod melting;
mod parameters;
mod properties;
mod property;
mod radiation;
pub mod stress;
pub mod stress_rate;
mod substance;
mod thermoelastic;
mod viscoplastic;

pub use admissible::admissible;
pub use constants::Constants;
pub use elastoplastic::{Elastoplastic, OfTemperature, PointConstants, PointTangent, constant};
pub use enthalpy::{Enthalpy, EnthalpyPoint};
pub use law::{Elastic, FlowLaw, History, Law, Response};
pub use melting::{Melting, MeltingError};
pub use parameters::{AtStart, MaterialConstant};
pub use properties::Properties;
pub use property::{Curve, Property, PropertyError, Table};
pub use radiation::{radiative_coefficient, radiative_flux, radiative_slope};
pub use substance::{Substance, SubstanceError};
pub use thermoelastic::Thermoelastic;
pub use viscoplastic::{Creep, Overstress, Parted, Viscoplastic};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::tag;

/// A constitutive law with its constants.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "model", rename_all = "snake_case", deny_unknown_fields)]
#[schemars(transform = tag("model", "Constitutive law"))]
pub enum Material {
    /// Isotropic Fourier conduction and thermo-elasticity.
    Thermoelastic(Properties),
    /// The same, but the body yields: J₂ plasticity with linear hardening.
    Elastoplastic(Properties),
    /// The same, but flow takes time: creep, or viscoplasticity beyond a yield stress.
    Viscoplastic(Properties),
}

impl Material {
    pub fn properties(&self) -> &Properties {
        match self {
            Self::Thermoelastic(properties)
            | Self::Elastoplastic(properties)
            | Self::Viscoplastic(properties) => properties,
        }
    }

    /// Whether strain may stay.
    pub fn yields(&self) -> bool {
        !matches!(self, Self::Thermoelastic(_))
    }

    pub fn properties_mut(&mut self) -> &mut Properties {
        match self {
            Self::Thermoelastic(properties)
            | Self::Elastoplastic(properties)
            | Self::Viscoplastic(properties) => properties,
        }
    }
}

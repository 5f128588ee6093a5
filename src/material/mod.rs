//! Constitutive laws, one a file. The enum is also the parser of a scene's `material` table.

mod constants;
mod elastoplastic;
mod law;
pub mod stress;
pub mod stress_rate;
mod thermoelastic;

pub use constants::Constants;
pub use elastoplastic::{Elastoplastic, OfTemperature, PointConstants, PointTangent, constant};
pub use law::{Elastic, History, Law, Response};
pub use thermoelastic::Thermoelastic;

use serde::{Deserialize, Serialize};

/// A constitutive law with its constants.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case", deny_unknown_fields)]
pub enum Material {
    /// Isotropic Fourier conduction and linear thermo-elasticity.
    Thermoelastic(Constants),
}

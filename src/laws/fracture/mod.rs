//! Brittle fracture: statistics of flaws, which lead to a probability of failure, toughness, cracks that run,
//! and links that soften.

mod crack_growth;
mod crack_row;
mod cracking;
mod damage;
mod normal_average;
mod principal_axes;
mod quasi_brittle;
mod scatter;
mod slow_growth;
mod softening;
mod split;
mod weibull;

pub use crack_growth::CrackGrowth;
pub use crack_row::crack_row;
pub use cracking::Cracking;
pub use damage::{DEGRADED, Dissipation, GradientDamage, PointResponse, degradation};
pub use principal_axes::{InPlane, InSpace, PrincipalAxes};
pub use quasi_brittle::{QuasiBrittle, SofteningKeys, SofteningModel};
pub use scatter::scattered;
pub use slow_growth::SlowGrowth;
pub use softening::{Softening, SofteningLaw};
pub use split::{Principal, Split};
pub use weibull::{Directions, Extent, FlawStatistics, Weibull};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::part::Part;
use super::{AtStart, MaterialConstant};
use crate::limits::{Bounds, plausible, positive};
use crate::quantity::Quantity;

/// Constants of brittle fracture, all optional.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Brittleness {
    /// Weibull's distribution of flaws; the body then has a probability of failure as an output.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "no probability of failure"))]
    pub weibull: Option<Weibull>,
    /// Toughness K_Ic [Pa √m], for the safety of flaws, and for the energy of cracks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = positive("Pa √m", "the toughness")
        .plausible(&plausible::TOUGHNESS)
        .otherwise("none"))]
    pub toughness: Option<f64>,
    /// Cracks that run.
    #[serde(default, rename = "fracture", skip_serializing_if = "Option::is_none")]
    #[schemars(extend(
        "condition" = "of bodies of one thermoelastic material",
        "otherwise" = "nothing cracks"
    ))]
    pub cracking: Option<Cracking>,
}

impl Part for Brittleness {
    fn parameters() -> &'static [MaterialConstant] {
        const {
            &[
                MaterialConstant {
                    key: "weibull_modulus",
                    description: "Weibull modulus",
                    quantity: Quantity::Ratio,
                    bounds: Bounds::between(Weibull::LEAST_MODULUS, Weibull::MOST_MODULUS),
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "weibull_strength",
                    description: "Weibull strength",
                    quantity: Quantity::Stress,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "toughness",
                    description: "fracture toughness",
                    quantity: Quantity::StressIntensity,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "fracture_strength",
                    description: "tensile strength",
                    quantity: Quantity::Stress,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "fracture_length",
                    description: "length of damage",
                    quantity: Quantity::Length,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "fracture_energy",
                    description: "energy of cracks per area",
                    quantity: Quantity::EnergyPerArea,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
            ]
        }
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "weibull_modulus" => self.weibull.as_mut().map(|own| &mut own.modulus),
            "weibull_strength" => self.weibull.as_mut().map(|own| &mut own.strength),
            "toughness" => self.toughness.as_mut(),
            "fracture_strength" => self.cracking.as_mut().and_then(|own| own.strength.as_mut()),
            "fracture_length" => self.cracking.as_mut().and_then(|own| own.length.as_mut()),
            "fracture_energy" => self.cracking.as_mut().and_then(|own| own.energy.as_mut()),
            _ => None,
        }
    }
}

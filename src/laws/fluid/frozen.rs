//! Constants of a fluid once it is frozen.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{plausible, within};

/// Constants of a frozen fluid that differ from those of the molten one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Frozen {
    /// Specific heat capacity of the frozen fluid [J/(kg K)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = within(1e-1, 1e7, "J/(kg K)", "the specific heat capacity of the frozen fluid")
        .plausible(&plausible::FLUID_SPECIFIC_HEAT)
        .otherwise("that of the molten fluid"))]
    pub specific_heat: Option<f64>,
    /// Thermal conductivity of the frozen fluid [W/(m K)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = within(1e-9, 1e6, "W/(m K)", "the thermal conductivity of the frozen fluid")
        .plausible(&plausible::FLUID_CONDUCTIVITY)
        .otherwise("that of the molten fluid"))]
    pub conductivity: Option<f64>,
}

//! Keys of a yield stress that saturates.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::Part;
use crate::limits::{plausible, positive, within};

/// Constants of a yield stress that saturates.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Saturating {
    /// Saturation of the yield stress: `σ_∞ − (σ_∞ − σ_y) e^(−δα)` over the plastic strain α, beside
    /// `isotropic_hardening`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "none"))]
    pub hardening: Option<Saturation>,
}

/// Saturation of a yield stress.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Saturation {
    /// Yield stress σ_∞ after much plastic strain [Pa].
    #[schemars(transform = positive("Pa", "the saturated yield stress").plausible(&plausible::YIELD_STRESS))]
    pub saturation: f64,
    /// Rate δ at which it is reached [1].
    #[schemars(transform = within(1e-6, 1e6, "1", "the rate of saturation"))]
    pub rate: f64,
}

impl Part for Saturating {}

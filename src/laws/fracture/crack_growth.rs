//! Slow growth of a crack, as water does it in glass and oxide ceramics.
//!
//! Below the toughness a crack grows at the rate `ȧ = v₀ (K/K_Ic)^n` (S. M. Wiederhorn 1967, doi
//! 10.1111/j.1151-2916.1967.tb15145.x; A. G. Evans & S. M. Wiederhorn 1974, doi 10.1007/BF00035405).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::slow_growth::SlowGrowth;
use crate::limits::{plausible, positive, within};

/// Slow growth of a crack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ exponent = n, speed = v }`")]
pub struct CrackGrowth {
    /// Exponent n of the rate of growth over the stress intensity [1].
    #[schemars(transform = within(SlowGrowth::LEAST_EXPONENT, SlowGrowth::MOST_EXPONENT, "1", "the exponent of slow growth")
        .plausible(&plausible::GROWTH_EXPONENT))]
    pub exponent: f64,
    /// Speed v₀ of a crack whose stress intensity is the toughness [m/s].
    #[schemars(transform = positive("m/s", "the speed of slow growth").plausible(&plausible::GROWTH_SPEED))]
    pub speed: f64,
}

impl CrackGrowth {
    /// Rate of the depth [m/s] at a stress intensity over the toughness, which it does not exceed: at the toughness a
    /// crack runs. Closed cracks do not grow.
    pub fn rate(&self, ratio: f64) -> f64 {
        self.speed * ratio.clamp(0.0, 1.0).powf(self.exponent)
    }
}

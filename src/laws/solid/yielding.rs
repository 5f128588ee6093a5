//! Keys of a yield surface that hardens linearly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::part::{Part, number_among};
use crate::laws::{AtStart, MaterialConstant, Property};
use crate::limits::{not_negative, plausible, positive};
use crate::quantity::Quantity;

/// Constants of a yield surface that hardens linearly: numbers, or tables over the temperature.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Yielding {
    /// Stress at which the body yields (von Mises) [Pa].
    #[schemars(transform = positive("Pa", "the yield stress").plausible(&plausible::YIELD_STRESS)
        .otherwise("0 of `viscoplastic`; `elastoplastic` needs it"))]
    pub yield_stress: Option<Property>,
    /// Growth of that per plastic strain [Pa].
    #[schemars(transform = not_negative("Pa", "the hardening").low(SOFTENS, "0 to 1e60").otherwise("0"))]
    pub isotropic_hardening: Option<Property>,
    /// Motion of the middle of elasticity per plastic strain [Pa].
    #[schemars(transform = not_negative("Pa", "the hardening").low(SOFTENS, "0 to 1e60").otherwise("0"))]
    pub kinematic_hardening: Option<Property>,
}

const SOFTENS: &str = "a body that yields does not soften";

const fn stress(key: &'static str, description: &'static str) -> MaterialConstant {
    let (quantity, bounds) = (Quantity::Stress, MaterialConstant::ABOVE_ZERO);
    MaterialConstant { key, description, quantity, bounds, start: AtStart::Never }
}

impl Part for Yielding {
    fn parameters() -> &'static [MaterialConstant] {
        const {
            &[
                stress("yield_stress", "yield stress"),
                stress("isotropic_hardening", "growth of the yield stress per plastic strain"),
                stress(
                    "kinematic_hardening",
                    "motion of the middle of elasticity per plastic strain",
                ),
            ]
        }
    }

    fn properties(&self) -> Vec<(&'static str, &Property)> {
        let all = [
            ("yield_stress", &self.yield_stress),
            ("isotropic_hardening", &self.isotropic_hardening),
            ("kinematic_hardening", &self.kinematic_hardening),
        ];
        all.into_iter().filter_map(|(key, own)| Some((key, own.as_ref()?))).collect()
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        let all = [
            ("yield_stress", self.yield_stress.as_mut()),
            ("isotropic_hardening", self.isotropic_hardening.as_mut()),
            ("kinematic_hardening", self.kinematic_hardening.as_mut()),
        ];
        number_among(key, all)
    }
}

//! The Newtonian law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Shear, ShearLaw};
use crate::laws::Part;
use crate::limits::{plausible, within};

/// `τ = µ γ̇` with the viscosity µ [Pa s] (I. Newton, Principia, book II, 1687).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Newtonian {
    /// Viscosity µ of `newtonian` [Pa s]; the parameter of a unit is named `viscosity`.
    #[schemars(transform = within(1e-9, 1e6, "Pa s", "the viscosity").plausible(&plausible::VISCOSITY))]
    pub value: f64,
}

impl Part for Newtonian {
    /// The value is the parameter `viscosity`, as without a law.
    fn number(&mut self, key: &str) -> Option<&mut f64> {
        (key == "viscosity").then_some(&mut self.value)
    }
}

impl ShearLaw for Newtonian {
    #[inline]
    fn viscous(&self, _rate: f64) -> Shear {
        Shear { secant: self.value, tangent: self.value }
    }

    fn is_newtonian(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viscosity_is_the_value_at_any_rate() {
        let law = Newtonian { value: 1e-3 };
        for rate in [0.0, 1e-9, 1.0, 1e12] {
            assert_eq!(law.viscous(rate), Shear { secant: 1e-3, tangent: 1e-3 });
        }
        assert!(law.is_newtonian() && law.yield_stress() == 0.0);
    }
}

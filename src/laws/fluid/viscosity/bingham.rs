//! The Bingham law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Shear, ShearLaw};
use crate::laws::{AtStart, MaterialConstant, Part};
use crate::limits::{Limits, plausible, within};
use crate::quantity::Quantity;

/// `τ = τ_y + µ_p γ̇` with the yield stress τ_y [Pa] and the plastic viscosity µ_p [Pa s]; at rest τ ≤ τ_y (E. C.
/// Bingham, Fluidity and Plasticity, McGraw-Hill 1922).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Bingham {
    /// Yield stress, up to which fluid at rest stays at rest [Pa].
    #[schemars(transform = yield_stress())]
    pub yield_stress: f64,
    /// Viscosity beyond it, the slope of stress over shear rate [Pa s].
    #[schemars(transform = within(1e-9, 1e6, "Pa s", "the plastic viscosity").plausible(&plausible::VISCOSITY))]
    pub plastic_viscosity: f64,
}

/// Limits of the yield stress of a fluid.
pub const fn yield_stress() -> Limits {
    within(0.0, 1e9, "Pa", "the yield stress of a fluid").plausible(&plausible::FLUID_YIELD_STRESS)
}

/// Row of the parameter `yield_stress`.
pub const YIELD_STRESS: MaterialConstant = MaterialConstant {
    key: "yield_stress",
    description: "yield stress",
    quantity: Quantity::Stress,
    bounds: MaterialConstant::ABOVE_ZERO,
    start: AtStart::Never,
};

impl Part for Bingham {
    fn parameters() -> &'static [MaterialConstant] {
        const {
            &[
                YIELD_STRESS,
                MaterialConstant {
                    key: "plastic_viscosity",
                    description: "plastic viscosity",
                    quantity: Quantity::Viscosity,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::Never,
                },
            ]
        }
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "yield_stress" => Some(&mut self.yield_stress),
            "plastic_viscosity" => Some(&mut self.plastic_viscosity),
            _ => None,
        }
    }
}

impl ShearLaw for Bingham {
    #[inline]
    fn yield_stress(&self) -> f64 {
        self.yield_stress
    }

    #[inline]
    fn viscous(&self, _rate: f64) -> Shear {
        Shear { secant: self.plastic_viscosity, tangent: self.plastic_viscosity }
    }

    fn is_newtonian(&self) -> bool {
        self.yield_stress == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_yield_stress_it_is_newtonian() {
        let law = Bingham { yield_stress: 50.0, plastic_viscosity: 1.5 };
        assert!(!law.is_newtonian() && law.yield_stress() == 50.0);
        assert_eq!(law.viscous(7.0), Shear { secant: 1.5, tangent: 1.5 });
        assert!(Bingham { yield_stress: 0.0, ..law }.is_newtonian());
    }
}

//! The power law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Shear, ShearLaw};
use crate::laws::{AtStart, MaterialConstant, Part};
use crate::limits::{Limits, plausible, within};
use crate::quantity::Quantity;

/// `τ = k γ̇ⁿ` with the consistency k [Pa sⁿ] and the exponent n (W. Ostwald, Kolloid-Z. 36 (1925) 99; A. de Waele, J.
/// Oil Colour Chem. Assoc. 6 (1923) 33). Fluids with n < 1 thin under shear, those with n > 1 thicken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Power {
    /// Consistency k, whose unit has a power of s in it [Pa sⁿ].
    #[schemars(transform = consistency())]
    pub consistency: f64,
    /// Exponent n of the shear rate [1].
    #[schemars(transform = exponent())]
    pub exponent: f64,
}

/// Limits of a consistency, the stress at 1/s.
pub const fn consistency() -> Limits {
    within(1e-9, 1e9, "Pa sⁿ", "the consistency").plausible(&plausible::CONSISTENCY)
}

/// Limits of an exponent of the shear rate.
pub const fn exponent() -> Limits {
    let limits = within(0.0, 3.0, "1", "the exponent of a shear rate").low_open();
    limits.plausible(&plausible::SHEAR_EXPONENT).condition("up to 1 of `carreau_yasuda`")
}

/// Row of the parameter `consistency`. Its unit depends on the exponent, but as the stress at a rate of 1/s it is a
/// pressure.
pub const CONSISTENCY: MaterialConstant = MaterialConstant {
    key: "consistency",
    description: "consistency, the viscous stress at a shear rate of 1/s,",
    quantity: Quantity::Stress,
    bounds: MaterialConstant::ABOVE_ZERO,
    start: AtStart::Never,
};

/// Row of the parameter `exponent`.
pub const EXPONENT: MaterialConstant = MaterialConstant {
    key: "exponent",
    description: "exponent of the shear rate in the viscosity",
    quantity: Quantity::Ratio,
    bounds: exponent().bounds(),
    start: AtStart::Never,
};

impl Part for Power {
    fn parameters() -> &'static [MaterialConstant] {
        const { &[CONSISTENCY, EXPONENT] }
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "consistency" => Some(&mut self.consistency),
            "exponent" => Some(&mut self.exponent),
            _ => None,
        }
    }
}

impl ShearLaw for Power {
    #[inline]
    fn viscous(&self, rate: f64) -> Shear {
        let secant = self.consistency * rate.powf(self.exponent - 1.0);
        Shear { secant, tangent: self.exponent * secant }
    }

    fn is_newtonian(&self) -> bool {
        self.exponent == 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponent_one_is_newtonian() {
        let law = Power { consistency: 20.0, exponent: 1.0 };
        for rate in [0.0, 1e-9, 1.0, 1e12] {
            assert_eq!(law.viscous(rate), Shear { secant: 20.0, tangent: 20.0 });
        }
        assert!(law.is_newtonian());
    }

    #[test]
    fn viscosity_falls_with_the_exponent_minus_one() {
        let law = Power { consistency: 20.0, exponent: 0.6 };
        let ratio = law.viscous(1e3).secant / law.viscous(1.0).secant;
        assert!((ratio / 1e3_f64.powf(-0.4) - 1.0).abs() < 1e-14 && !law.is_newtonian());
        assert_eq!(law.viscous(0.0).secant, f64::INFINITY);
        let thick = Power { exponent: 1.5, ..law };
        assert_eq!(thick.viscous(0.0), Shear { secant: 0.0, tangent: 0.0 });
    }
}

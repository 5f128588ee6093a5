//! The Carreau–Yasuda law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Shear, ShearLaw};
use crate::laws::{AtStart, MaterialConstant, Part};
use crate::limits::{plausible, within};
use crate::quantity::Quantity;

/// `µ = µ_∞ + (µ₀ − µ_∞) [1 + (λγ̇)ᵃ]^((n−1)/a)` with the viscosities µ₀ at rest and µ_∞ at the highest rates [Pa s],
/// the time λ [s], the exponent n between them and the width a of the transition (P. J. Carreau, Trans. Soc. Rheol. 16
/// (1972) 99, doi 10.1122/1.549276, with a = 2; K. Yasuda, R. C. Armstrong and R. E. Cohen, Rheol. Acta 20 (1981) 163,
/// doi 10.1007/BF01513059).
///
/// With 0 < n ≤ 1 stress grows with the rate in either order of µ₀ and µ_∞. Beyond 1, µ_∞ would not be a limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct CarreauYasuda {
    /// Viscosity at low shear rates µ₀ [Pa s].
    #[schemars(transform = within(1e-9, 1e9, "Pa s", "the viscosity at low shear rates")
        .plausible(&plausible::ZERO_SHEAR_VISCOSITY))]
    pub zero_shear: f64,
    /// Viscosity at high shear rates µ_∞ [Pa s].
    #[schemars(transform = within(0.0, 1e6, "Pa s", "the viscosity at high shear rates")
        .plausible(&plausible::VISCOSITY))]
    pub infinite_shear: f64,
    /// Time λ, the inverse of the shear rate at which viscosity begins to change [s].
    #[schemars(transform = within(1e-15, 1e9, "s", "the time of a law of viscosity")
        .plausible(&plausible::SHEAR_TIME))]
    pub time: f64,
    /// Exponent n of the shear rate [1].
    #[schemars(transform = within(0.0, 1.0, "1", "the exponent between two plateaus of viscosity").low_open())]
    pub exponent: f64,
    /// Width a of the transition from the viscosity at low shear rates [1].
    #[serde(default = "carreau")]
    #[schemars(transform = within(0.01, 100.0, "1", "the width of the transition").otherwise("2: Carreau's law"))]
    pub transition: f64,
}

fn carreau() -> f64 {
    2.0
}

impl Part for CarreauYasuda {
    fn parameters() -> &'static [MaterialConstant] {
        const fn row(
            key: &'static str,
            description: &'static str,
            quantity: Quantity,
        ) -> MaterialConstant {
            let (bounds, start) = (MaterialConstant::ABOVE_ZERO, AtStart::Never);
            MaterialConstant { key, description, quantity, bounds, start }
        }
        const {
            &[
                row("zero_shear", "viscosity at low shear rates", Quantity::Viscosity),
                row("infinite_shear", "viscosity at high shear rates", Quantity::Viscosity),
                row("time", "inverse of the shear rate at which viscosity changes", Quantity::Time),
                row("exponent", "exponent of the shear rate in the viscosity", Quantity::Ratio),
                row("transition", "width of the transition of viscosity", Quantity::Ratio),
            ]
        }
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "zero_shear" => Some(&mut self.zero_shear),
            "infinite_shear" => Some(&mut self.infinite_shear),
            "time" => Some(&mut self.time),
            "exponent" => Some(&mut self.exponent),
            "transition" => Some(&mut self.transition),
            _ => None,
        }
    }
}

impl ShearLaw for CarreauYasuda {
    #[inline]
    fn viscous(&self, rate: f64) -> Shear {
        let Self { zero_shear, infinite_shear, time, exponent, transition } = *self;
        // The logarithm of x = (λγ̇)ᵃ, as x itself may overflow.
        let logarithm = transition * (time * rate).ln();
        let of_sum = logarithm.max(0.0) + (-logarithm.abs()).exp().ln_1p();
        let change = (zero_shear - infinite_shear) * ((exponent - 1.0) / transition * of_sum).exp();
        // (1 + n x)/(1 + x)
        let bend = exponent + (1.0 - exponent) / (1.0 + logarithm.exp());
        Shear { secant: infinite_shear + change, tangent: infinite_shear + change * bend }
    }

    fn is_newtonian(&self) -> bool {
        self.exponent == 1.0 || self.zero_shear == self.infinite_shear
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MELT: CarreauYasuda = CarreauYasuda {
        zero_shear: 10.0,
        infinite_shear: 1e-3,
        time: 0.5,
        exponent: 0.4,
        transition: 2.0,
    };

    #[test]
    fn plateaus_and_the_power_law_between_them() {
        assert_eq!(MELT.viscous(0.0), Shear { secant: 10.0, tangent: 10.0 });
        let close = |value: f64, wanted: f64| (value / wanted - 1.0).abs() < 1e-3;
        assert!(close(MELT.viscous(1e-2).secant, 10.0));
        let between = MELT.viscous(1e3);
        assert!(close(between.secant - 1e-3, 9.999 * 500_f64.powf(-0.6)));
        assert!(close(between.tangent - 1e-3, 0.4 * (between.secant - 1e-3)));
        assert!(close(MELT.viscous(1e13).secant, 1e-3) && close(MELT.viscous(1e13).tangent, 1e-3));
        // The sharpest transition, whose powers of the rate overflow.
        let sharp = CarreauYasuda { infinite_shear: 0.0, transition: 100.0, ..MELT };
        assert!(close(sharp.viscous(2e12).secant, 10.0 * 1e12_f64.powf(-0.6)));
    }

    #[test]
    fn one_rate_against_the_formula() {
        let law = CarreauYasuda { transition: 1.7, ..MELT };
        let bracket: f64 = 1.0 + (0.5_f64 * 3.0).powf(1.7);
        let wanted = 1e-3 + 9.999 * bracket.powf(-0.6 / 1.7);
        assert!((law.viscous(3.0).secant / wanted - 1.0).abs() < 1e-14);
    }

    #[test]
    fn equal_plateaus_or_exponent_one_are_newtonian() {
        let flat = CarreauYasuda { exponent: 1.0, ..MELT };
        let equal = CarreauYasuda { infinite_shear: 10.0, ..MELT };
        for law in [flat, equal] {
            assert!(law.is_newtonian());
            for rate in [0.0, 1.0, 1e9] {
                assert_eq!(law.viscous(rate), Shear { secant: 10.0, tangent: 10.0 });
            }
        }
        assert!(!MELT.is_newtonian());
    }
}

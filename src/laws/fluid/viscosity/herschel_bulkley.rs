//! The Herschel–Bulkley law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::bingham::{YIELD_STRESS, yield_stress};
use super::power::{CONSISTENCY, EXPONENT, Power, consistency, exponent};
use super::{Shear, ShearLaw};
use crate::laws::{MaterialConstant, Part};

/// `τ = τ_y + k γ̇ⁿ` with the yield stress τ_y [Pa], the consistency k [Pa sⁿ] and the exponent n; at rest τ ≤ τ_y (W.
/// H. Herschel and R. Bulkley, Kolloid-Z. 39 (1926) 291, doi 10.1007/BF01432034).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct HerschelBulkley {
    /// Yield stress, up to which fluid at rest stays at rest [Pa].
    #[schemars(transform = yield_stress())]
    pub yield_stress: f64,
    /// Consistency k, whose unit has a power of s in it [Pa sⁿ].
    #[schemars(transform = consistency())]
    pub consistency: f64,
    /// Exponent n of the shear rate [1].
    #[schemars(transform = exponent())]
    pub exponent: f64,
}

impl Part for HerschelBulkley {
    fn parameters() -> &'static [MaterialConstant] {
        const { &[YIELD_STRESS, CONSISTENCY, EXPONENT] }
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        match key {
            "yield_stress" => Some(&mut self.yield_stress),
            "consistency" => Some(&mut self.consistency),
            "exponent" => Some(&mut self.exponent),
            _ => None,
        }
    }
}

impl HerschelBulkley {
    /// The law without yield stress.
    fn power(&self) -> Power {
        Power { consistency: self.consistency, exponent: self.exponent }
    }
}

impl ShearLaw for HerschelBulkley {
    #[inline]
    fn yield_stress(&self) -> f64 {
        self.yield_stress
    }

    #[inline]
    fn viscous(&self, rate: f64) -> Shear {
        self.power().viscous(rate)
    }

    fn is_newtonian(&self) -> bool {
        self.yield_stress == 0.0 && self.power().is_newtonian()
    }

    /// Thickening fluids yield at `τ_y/γ̇` and thicken with `k γ̇^(n−1)`: the sum is least at `γ̇ⁿ = τ_y/((n − 1) k)`.
    fn thinnest_rate(&self, factor: f64) -> Option<f64> {
        let growth = (self.exponent - 1.0) * factor * self.consistency;
        (growth > 0.0 && self.yield_stress > 0.0)
            .then(|| (self.yield_stress / growth).powf(1.0 / self.exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::fluid::viscosity::Bingham;

    const PASTE: HerschelBulkley =
        HerschelBulkley { yield_stress: 0.5, consistency: 0.5, exponent: 0.5 };

    #[test]
    fn exponent_one_is_bingham() {
        let paste = HerschelBulkley { exponent: 1.0, ..PASTE };
        let bingham = Bingham { yield_stress: 0.5, plastic_viscosity: 0.5 };
        assert_eq!(paste.yield_stress(), bingham.yield_stress());
        for rate in [0.0, 1e-6, 3.0, 1e9] {
            assert_eq!(paste.viscous(rate), bingham.viscous(rate));
        }
        assert!(HerschelBulkley { yield_stress: 0.0, ..paste }.is_newtonian());
    }

    #[test]
    fn thickening_fluid_is_thinnest_where_its_slope_vanishes() {
        assert_eq!(PASTE.thinnest_rate(1.0), None);
        let thick = HerschelBulkley { exponent: 1.8, ..PASTE };
        let rate = thick.thinnest_rate(2.0).unwrap();
        let secant = |rate: f64| thick.yield_stress / rate + 2.0 * thick.viscous(rate).secant;
        assert!(secant(rate) < secant(0.99 * rate) && secant(rate) < secant(1.01 * rate));
    }
}

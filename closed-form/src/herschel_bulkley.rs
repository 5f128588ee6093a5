//! Law of Herschel and Bulkley for fluids with a yield stress: `τ = τ₀ + k γ̇ⁿ` where the fluid flows, `|τ| ≤ τ₀`
//! where it does not. n = 1 is Bingham's law, τ₀ = 0 a power law, both a Newtonian fluid.
//!
//! Computations often regularise it by two viscosities (R. I. Tanner and J. F. Milthorpe 1983): below a rate γ̇₀ the
//! apparent viscosity `τ/γ̇` keeps its value at γ̇₀.
//!
//! Source: W. H. Herschel and R. Bulkley (1926), Kolloid-Z. 39, 291–300, doi 10.1007/BF01432034.

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HerschelBulkley {
    /// Yield stress τ₀ [Pa].
    pub yield_stress: f64,
    /// Consistency k [Pa sⁿ].
    pub consistency: f64,
    /// Exponent n [1].
    pub exponent: f64,
}

impl HerschelBulkley {
    /// Shear stress τ [Pa] at a positive shear rate [1/s].
    pub fn stress(&self, rate: f64) -> f64 {
        self.yield_stress + self.consistency * rate.powf(self.exponent)
    }

    /// Shear rate γ̇ [1/s] at a shear stress of 0 or above [Pa]: 0 up to the yield stress.
    pub fn rate(&self, stress: f64) -> f64 {
        let excess = (stress - self.yield_stress).max(0.0);
        (excess / self.consistency).powf(1.0 / self.exponent)
    }

    /// Apparent viscosity τ/γ̇ [Pa s] at a positive shear rate.
    pub fn viscosity(&self, rate: f64) -> f64 {
        self.stress(rate) / rate
    }

    /// Shear rate [1/s] of the law regularised below the rate γ̇₀ `least`.
    pub fn regularised_rate(&self, stress: f64, least: f64) -> f64 {
        if stress < self.stress(least) {
            return stress / self.viscosity(least);
        }
        self.rate(stress)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::*;

    /// Fluid of Park §2.6.
    const PASTE: HerschelBulkley =
        HerschelBulkley { yield_stress: 0.5, consistency: 0.5, exponent: 0.5 };

    #[test]
    fn rate_inverts_stress() {
        for rate in [1e-3, 0.7, 40.0] {
            assert_close(PASTE.rate(PASTE.stress(rate)), rate, 1e-12);
        }
        assert_eq!(PASTE.rate(0.5), 0.0);
        assert_eq!(PASTE.rate(0.2), 0.0);
    }

    #[test]
    fn park_largest_viscosity() {
        assert_close(PASTE.viscosity(1e-3), 515.81, 1e-5);
    }

    #[test]
    fn regularised_law_is_linear_below_and_the_law_above() {
        let joint = PASTE.stress(1e-3);
        let below = derivative(|stress| PASTE.regularised_rate(stress, 1e-3), 0.5 * joint, 1e-3);
        assert_close(below, 1.0 / PASTE.viscosity(1e-3), 1e-9);
        assert_close(PASTE.regularised_rate(joint.next_down(), 1e-3), 1e-3, 1e-12);
        assert_eq!(PASTE.regularised_rate(2.5, 1e-3), PASTE.rate(2.5));
    }
}

//! The Arrhenius factor of viscosities over the temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::laws::{GAS_CONSTANT, Part};
use crate::limits::{knot, plausible, within};

/// Factor `exp(E/R (1/T − 1/T_r))` of the viscous stress at a temperature T [K], 1 at the reference temperature T_r
/// [K], with the activation energy E of flow [J/mol] (E. N. da C. Andrade, Nature 125 (1930) 309; H. Eyring, J. Chem.
/// Phys. 4 (1936) 283).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, `{ energy = E, reference = T }`")]
pub struct Arrhenius {
    /// Activation energy of flow E [J/mol].
    #[schemars(transform = within(-1e7, 1e7, "J/mol", "the activation energy").plausible(&plausible::ACTIVATION_ENERGY))]
    pub energy: f64,
    /// Temperature T_r at which the law's constants hold [K].
    #[schemars(transform = knot())]
    pub reference: f64,
}

impl Arrhenius {
    #[inline]
    pub fn factor(&self, temperature: f64) -> f64 {
        (self.energy / GAS_CONSTANT * (1.0 / temperature - 1.0 / self.reference)).exp()
    }
}

/// Keys that every law of viscosity takes besides its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Thermal {
    /// Change of the viscous stress with the temperature; the yield stress is constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("otherwise" = "none: the same at every temperature"))]
    pub arrhenius: Option<Arrhenius>,
}

impl Part for Thermal {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_is_one_at_the_reference_and_falls_beyond_it() {
        let law = Arrhenius { energy: 50e3, reference: 400.0 };
        assert_eq!(law.factor(400.0), 1.0);
        // d ln µ/d(1/T) = E/R
        let slope = (law.factor(410.0) / law.factor(390.0)).ln() / (1.0 / 410.0 - 1.0 / 390.0);
        assert!((slope * GAS_CONSTANT / 50e3 - 1.0).abs() < 1e-12);
        assert!(law.factor(500.0) < 1.0 && law.factor(300.0) > 1.0);
    }
}

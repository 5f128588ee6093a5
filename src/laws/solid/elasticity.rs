//! Keys of isotropic thermo-elasticity, which all laws of deformation share.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::law::Need;
use crate::laws::part::{Part, number_among};
use crate::laws::{AtStart, MaterialConstant, Property};
use crate::limits::{Bounds, own_temperature, plausible, positive, signed, within};
use crate::quantity::Quantity;

/// Constants of isotropic thermo-elasticity: numbers, or tables over the temperature. Where nothing mechanical is asked
/// for they may be left out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Elasticity {
    /// Young's modulus E [Pa].
    #[schemars(transform = positive("Pa", "Young's modulus").plausible(&plausible::YOUNG).otherwise(NO_STRESS))]
    pub young: Option<Property>,
    /// Poisson's ratio ν [1].
    #[schemars(transform = within(-1.0 + POISSON_MARGIN, 0.5 - POISSON_MARGIN, "1", "")
        .low("Poisson's ratio must stay above minus one", "-0.999999999 to 0.499999999")
        .high("Poisson's ratio must stay below one half", "-0.999999999 to 0.499999999")
        .condition("without these ends")
        .otherwise(NO_STRESS))]
    pub poisson: Option<Property>,
    /// Mean coefficient of linear thermal expansion α from `expansion_reference` on [1/K].
    #[schemars(transform = signed("1/K", "the coefficient of expansion")
        .plausible(&plausible::EXPANSION)
        .otherwise(NO_STRESS))]
    pub expansion: Option<Property>,
    /// Temperature T₀ from which the mean coefficient is measured [K]: the thermal strain at T of a body without stress
    /// at T_f is α(T) (T − T₀) − α(T_f) (T_f − T₀). Data sheets mostly have 293.15 K.
    #[schemars(transform = own_temperature()
        .otherwise("the temperature without stress")
        .condition("matters to tables only"))]
    pub expansion_reference: Option<f64>,
}

/// Default of a constant of elasticity, in words.
const NO_STRESS: &str = "none: no stress";
/// At −1 and ½ resistance to shear or to compression vanishes, and close to these it is lost in rounding.
const POISSON_MARGIN: f64 = 1e-9;

impl Elasticity {
    /// All keys, with the reason why they are needed.
    pub const fn needs(why: &'static str) -> [Need; 3] {
        [
            Need { key: "young", why, allowed: "a positive number (Pa)" },
            Need { key: "poisson", why, allowed: "-1 < poisson < 0.5" },
            Need { key: "expansion", why, allowed: "a number (1/K)" },
        ]
    }

    /// Returns the constants at a temperature [K].
    pub fn linearised(&self, temperature: f64) -> Self {
        let at = |property: &Option<Property>| property.as_ref().map(|own| own.at(temperature));
        Self {
            young: at(&self.young),
            poisson: at(&self.poisson),
            expansion: at(&self.expansion),
            expansion_reference: None,
        }
    }
}

impl Part for Elasticity {
    fn parameters() -> &'static [MaterialConstant] {
        const {
            &[
                MaterialConstant {
                    key: "young",
                    description: "Young's modulus",
                    quantity: Quantity::Modulus,
                    bounds: MaterialConstant::ABOVE_ZERO,
                    start: AtStart::PoleAtZero,
                },
                MaterialConstant {
                    key: "poisson",
                    description: "Poisson's ratio",
                    quantity: Quantity::Ratio,
                    bounds: Bounds::between(-1.0, 0.5),
                    start: AtStart::PolesAt([-1.0, 0.5]),
                },
                MaterialConstant {
                    key: "expansion",
                    description: "coefficient of linear thermal expansion",
                    quantity: Quantity::Expansion,
                    bounds: Bounds { low: None, high: None },
                    start: AtStart::Polynomial,
                },
            ]
        }
    }

    fn properties(&self) -> Vec<(&'static str, &Property)> {
        let all =
            [("young", &self.young), ("poisson", &self.poisson), ("expansion", &self.expansion)];
        all.into_iter().filter_map(|(key, own)| Some((key, own.as_ref()?))).collect()
    }

    fn number(&mut self, key: &str) -> Option<&mut f64> {
        let all = [
            ("young", self.young.as_mut()),
            ("poisson", self.poisson.as_mut()),
            ("expansion", self.expansion.as_mut()),
        ];
        number_among(key, all)
    }
}

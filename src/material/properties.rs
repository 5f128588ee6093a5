use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{not_negative, plausible, positive, signed, within};

use super::{
    Constants, Creep, Elastoplastic, FlowLaw, Melting, OfTemperature, Property, Substance,
    Viscoplastic, constant,
};

/// Constants of an isotropic body as a scene names them: numbers, or tables over the temperature. Those of elasticity
/// may be left out where nothing mechanical is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Properties {
    /// Mass density ρ [kg/m³]: a number, as mass is conserved.
    #[schemars(transform = positive("kg/m³", "the density").plausible(&plausible::DENSITY))]
    pub density: f64,
    /// Specific heat capacity c [J/(kg K)].
    #[schemars(transform = positive("J/(kg K)", "the specific heat capacity").plausible(&plausible::SPECIFIC_HEAT))]
    pub specific_heat: Property,
    /// Thermal conductivity k [W/(m K)].
    #[schemars(transform = positive("W/(m K)", "the thermal conductivity").plausible(&plausible::CONDUCTIVITY))]
    pub conductivity: Property,
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
    /// Mean coefficient of linear thermal expansion α from the temperature without stress [1/K].
    #[schemars(transform = signed("1/K", "the coefficient of expansion")
        .plausible(&plausible::EXPANSION)
        .otherwise(NO_STRESS))]
    pub expansion: Option<Property>,
    /// What melting takes.
    #[schemars(extend("otherwise" = "does not melt"))]
    pub melting: Option<Melting>,
    /// Stress at which the body yields (von Mises) [Pa]; of `elastoplastic` and `viscoplastic`.
    #[schemars(transform = positive("Pa", "the yield stress").plausible(&plausible::YIELD_STRESS).otherwise(""))]
    pub yield_stress: Option<Property>,
    /// Growth of that per plastic strain [Pa]; of `elastoplastic` and `viscoplastic`.
    #[schemars(transform = not_negative("Pa", "").says(SOFTENS, "0 to 1e60").otherwise("0"))]
    pub isotropic_hardening: Option<Property>,
    /// Motion of the middle of elasticity per plastic strain [Pa]; of `elastoplastic` and `viscoplastic`.
    #[schemars(transform = not_negative("Pa", "").says(SOFTENS, "0 to 1e60").otherwise("0"))]
    pub kinematic_hardening: Option<Property>,
    /// How fast the body flows; of `viscoplastic`.
    #[schemars(extend("otherwise" = ""))]
    pub creep: Option<Creep>,
}

/// What holds where a constant of elasticity is left out.
const NO_STRESS: &str = "none: no stress";
/// At −1 and ½ resistance to shear or to compression is lost, and close to these lost in rounding.
const POISSON_MARGIN: f64 = 1e-9;
const SOFTENS: &str = "a body that yields does not soften";

impl Properties {
    /// The numbers that hold at a temperature [K], without what melting takes.
    pub fn at(&self, temperature: f64) -> Constants {
        let value = |property: &Property| property.value(temperature);
        Constants {
            density: self.density,
            specific_heat: value(&self.specific_heat),
            conductivity: value(&self.conductivity),
            young: self.young.as_ref().map(value),
            poisson: self.poisson.as_ref().map(value),
            expansion: self.expansion.as_ref().map(value),
        }
    }

    /// All that may be a table: its key, and what it is where it is given.
    pub fn tables(&self) -> [(&'static str, Option<&Property>); 8] {
        [
            ("specific_heat", Some(&self.specific_heat)),
            ("conductivity", Some(&self.conductivity)),
            ("young", self.young.as_ref()),
            ("poisson", self.poisson.as_ref()),
            ("expansion", self.expansion.as_ref()),
            ("yield_stress", self.yield_stress.as_ref()),
            ("isotropic_hardening", self.isotropic_hardening.as_ref()),
            ("kinematic_hardening", self.kinematic_hardening.as_ref()),
        ]
    }

    /// What conducts and stores heat.
    pub fn substance(&self) -> Substance {
        Substance {
            density: self.density,
            specific_heat: self.specific_heat.clone(),
            conductivity: self.conductivity.clone(),
            melting: self.melting,
        }
    }

    /// How the body deforms, free of stress at a temperature [K]; without a yield stress it never yields.
    ///
    /// # Panics
    /// If constants of elasticity are missing, which checked scenes that ask for mechanics have.
    pub fn elastoplastic(&self, stress_free_temperature: f64) -> Elastoplastic {
        let given = |property: &Option<Property>| -> OfTemperature {
            let property = property.clone().expect("mechanics has its constants");
            Arc::new(move |temperature| property.value(temperature))
        };
        let or = |property: &Option<Property>, other: f64| match property {
            Some(_) => given(property),
            None => constant(other),
        };
        // What creeps does so under any stress.
        let never = if self.creep.is_some() { 0.0 } else { f64::INFINITY };
        Elastoplastic {
            young: given(&self.young),
            poisson: given(&self.poisson),
            expansion: given(&self.expansion),
            yield_stress: or(&self.yield_stress, never),
            isotropic: or(&self.isotropic_hardening, 0.0),
            kinematic: or(&self.kinematic_hardening, 0.0),
            stress_free_temperature,
        }
    }

    /// The law by which the body deforms, as [`Self::elastoplastic`].
    pub fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        let plastic = self.elastoplastic(stress_free_temperature);
        match self.creep {
            Some(creep) => Arc::new(Viscoplastic { plastic, creep }),
            None => Arc::new(plastic),
        }
    }

    /// Whether heat obeys a linear equation.
    pub fn conducts_linearly(&self) -> bool {
        let is_number = |property: &Property| matches!(property, Property::Constant(_));
        is_number(&self.specific_heat) && is_number(&self.conductivity) && self.melting.is_none()
    }

    /// Whether stress follows from deformation and temperature alone, and linearly.
    pub fn deforms_linearly(&self) -> bool {
        let [_, _, rest @ ..] = self.tables();
        let is_table = |property: &Property| matches!(property, Property::Table(_));
        self.yield_stress.is_none()
            && self.creep.is_none()
            && !rest.iter().any(|(_, property)| property.is_some_and(is_table))
    }
}

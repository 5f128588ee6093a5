//! The forms in which a scene sets a viscosity.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use super::arrhenius::Thermal;
use super::over_temperature::interpolated;
use super::{FlowCurve, FluidLaw, ShearLaw};
use crate::laws::{MaterialConstant, PartVisitor, Table};

/// Viscosity of a fluid: a number, a table over the temperature, or a law of the shear rate.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Viscosity {
    /// [Pa s]
    Constant(f64),
    /// [Pa s] over [K]; its logarithm is linear between, and constant beyond the ends.
    Table(Table),
    Law(Rheology),
}

/// A law of viscosity, and its change with the temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rheology {
    #[serde(flatten)]
    pub law: FluidLaw,
    #[serde(flatten)]
    pub thermal: Thermal,
}

impl Rheology {
    /// Visits the types of the keys of the law with this name.
    pub fn visit_parts(law: &str, visitor: &mut impl PartVisitor) {
        FluidLaw::visit_keys(law, visitor);
        visitor.part::<Thermal>();
    }

    fn factor(&self, temperature: f64) -> f64 {
        self.thermal.arrhenius.map_or(1.0, |arrhenius| arrhenius.factor(temperature))
    }
}

impl Viscosity {
    /// Returns the flow curve at a temperature [K].
    #[inline]
    pub fn at(&self, temperature: f64) -> FlowCurve {
        match self {
            Self::Constant(value) => FlowCurve::newtonian(*value),
            Self::Table(table) => FlowCurve::newtonian(interpolated(table, temperature)),
            Self::Law(rheology) => FlowCurve::new(rheology.law, rheology.factor(temperature)),
        }
    }

    /// Returns true if the viscosity does not depend on the shear rate.
    pub fn is_newtonian(&self) -> bool {
        match self {
            Self::Constant(_) | Self::Table(_) => true,
            Self::Law(rheology) => rheology.law.is_newtonian(),
        }
    }

    /// Returns true if the viscosity depends on the temperature.
    pub fn depends_on_temperature(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Table(_) => true,
            Self::Law(rheology) => rheology.thermal.arrhenius.is_some_and(|own| own.energy != 0.0),
        }
    }

    /// The viscosity [Pa s], if it depends on nothing.
    pub fn constant(&self) -> Option<f64> {
        let is_constant = self.is_newtonian() && !self.depends_on_temperature();
        // At any temperature and rate.
        is_constant.then(|| self.at(1.0).viscosity(1.0))
    }

    /// Yield stress, the same at all temperatures [Pa].
    pub fn yield_stress(&self) -> f64 {
        match self {
            Self::Constant(_) | Self::Table(_) => 0.0,
            Self::Law(rheology) => rheology.law.yield_stress(),
        }
    }

    /// Smallest and largest secant viscosity [Pa s] between two temperatures [K] and two shear rates [1/s], each pair
    /// in ascending order; infinite at rest beyond a yield stress.
    pub fn range(&self, temperatures: [f64; 2], rates: [f64; 2]) -> [f64; 2] {
        let between = |[low, high]: [f64; 2], value: &f64| low < *value && *value < high;
        let knots = match self {
            Self::Table(table) => &table.temperature[..],
            Self::Constant(_) | Self::Law(_) => &[],
        };
        let knots = knots.iter().copied().filter(|knot| between(temperatures, knot));
        let curves = temperatures.into_iter().chain(knots).map(|knot| self.at(knot));
        let viscosities = curves.flat_map(|curve| {
            let inner = curve.thinnest_rate().filter(|rate| between(rates, rate));
            rates.into_iter().chain(inner).map(move |rate| curve.viscosity(rate))
        });
        viscosities
            .fold([f64::INFINITY, 0.0], |[low, high], value| [low.min(value), high.max(value)])
    }

    /// Rows of the constants of its law that units offer as parameters, besides `viscosity`.
    pub fn parameters(&self) -> &'static [MaterialConstant] {
        match self {
            Self::Constant(_) | Self::Table(_) => &[],
            Self::Law(rheology) => rheology.law.parameters(),
        }
    }

    /// The number of a parameter, for modification: `viscosity`, or a constant of the law.
    pub fn number(&mut self, key: &str) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => (key == "viscosity").then_some(value),
            Self::Table(_) => None,
            Self::Law(rheology) => rheology.law.number(key),
        }
    }
}

impl From<f64> for Viscosity {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl From<FluidLaw> for Viscosity {
    /// The law with the same constants at every temperature.
    fn from(law: FluidLaw) -> Self {
        Self::Law(Rheology { law, thermal: Thermal { arrhenius: None } })
    }
}

/// The forms that are tables of a scene.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a table of `temperature` and `value`, or of a `law` and its constants"
)]
enum Tables {
    Table(Table),
    Law(Rheology),
}

impl<'de> Deserialize<'de> for Viscosity {
    /// Implemented by hand, so that a value of another type is reported with all forms.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = Viscosity;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a finite number, a table of `temperature` and `value`, or a table of a `law`",
                )
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(Viscosity::Constant(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(Viscosity::Constant(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Self::Value, E> {
                Ok(Viscosity::Constant(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let read = Tables::deserialize(MapAccessDeserializer::new(map))?;
                Ok(match read {
                    Tables::Table(table) => Viscosity::Table(table),
                    Tables::Law(rheology) => Viscosity::Law(rheology),
                })
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

/// The schema is a table of keys for each law; all of them include those of its change with the temperature.
impl JsonSchema for Rheology {
    fn schema_name() -> Cow<'static, str> {
        "ViscosityLaw".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let common = Thermal::json_schema(generator);
        let common = common.get("properties").and_then(Value::as_object).cloned();
        let mut schema = FluidLaw::json_schema(generator);
        let laws = schema.get_mut("oneOf").and_then(Value::as_array_mut);
        for law in laws.into_iter().flatten() {
            if let Some(own) = law["properties"].as_object_mut() {
                own.extend(common.clone().unwrap_or_default());
            }
            law["additionalProperties"] = false.into();
        }
        schema.insert("description".into(), "A law of viscosity, with its constants.".into());
        schema
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::fluid::viscosity::{Arrhenius, HerschelBulkley, Newtonian};

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Holder {
        viscosity: Viscosity,
    }

    fn read(text: &str) -> Viscosity {
        toml::from_str::<Holder>(&format!("viscosity = {text}")).unwrap().viscosity
    }

    const PASTE: &str = r#"{ law = "herschel_bulkley", yield_stress = 50.0, consistency = 20, exponent = 0.6, arrhenius = { energy = 50e3, reference = 400.0 } }"#;

    #[test]
    fn every_form_is_read_and_written() {
        assert_eq!(read("1e-3"), Viscosity::Constant(1e-3));
        assert_eq!(read("3"), Viscosity::Constant(3.0));
        for text in [
            "1e-3",
            "{ temperature = [505.0, 600], value = [1.9e-3, 1.5e-3] }",
            r#"{ law = "newtonian", value = 1e-3 }"#,
            r#"{ law = "power", consistency = 20.0, exponent = 0.6 }"#,
            r#"{ law = "bingham", yield_stress = 50.0, plastic_viscosity = 1.0 }"#,
            r#"{ law = "carreau_yasuda", zero_shear = 10.0, infinite_shear = 1e-3, time = 0.5, exponent = 0.4 }"#,
            PASTE,
        ] {
            let viscosity = read(text);
            let written = toml::to_string(&Holder { viscosity: viscosity.clone() }).unwrap();
            assert_eq!(
                toml::from_str::<Holder>(&written).unwrap().viscosity,
                viscosity,
                "{written}"
            );
        }
        assert_eq!(
            toml::to_string(&Holder { viscosity: 1e-3.into() }).unwrap(),
            "viscosity = 0.001\n"
        );
        for text in ["true", "{ law = \"powder\" }", "{ value = [1.0, 2.0] }"] {
            assert!(toml::from_str::<Holder>(&format!("viscosity = {text}")).is_err());
        }
    }

    #[test]
    fn arrhenius_multiplies_the_viscous_stress_alone() {
        let paste = read(PASTE);
        let [cold, warm] = [380.0, 400.0].map(|temperature| paste.at(temperature));
        let arrhenius = Arrhenius { energy: 50e3, reference: 400.0 };
        let viscous = |curve: FlowCurve| curve.stress(3.0) - 50.0;
        assert!((viscous(cold) / viscous(warm) / arrhenius.factor(380.0) - 1.0).abs() < 1e-13);
        assert_eq!([cold.yield_stress(), paste.yield_stress()], [50.0; 2]);
        assert!(paste.depends_on_temperature() && !paste.is_newtonian());
    }

    #[test]
    fn constants_depend_on_nothing() {
        let constant = |text: &str| read(text).constant();
        assert_eq!(constant("1.7e-3"), Some(1.7e-3));
        assert_eq!(constant(r#"{ law = "newtonian", value = 1.7e-3 }"#), Some(1.7e-3));
        assert_eq!(
            constant(r#"{ law = "power", consistency = 20.0, exponent = 1.0 }"#),
            Some(20.0)
        );
        assert_eq!(constant(r#"{ law = "power", consistency = 20.0, exponent = 0.9 }"#), None);
        assert_eq!(constant("{ temperature = [300.0, 400.0], value = [2.0, 1.0] }"), None);
        assert_eq!(constant(PASTE), None);
    }

    #[test]
    fn ranges_hold_every_viscosity_within() {
        let thick = HerschelBulkley { yield_stress: 50.0, consistency: 20.0, exponent: 1.8 };
        let bent = Viscosity::Table(Table {
            temperature: vec![300.0, 350.0, 400.0],
            value: vec![1.0, 5.0, 0.5],
        });
        for viscosity in [bent, FluidLaw::HerschelBulkley(thick).into(), read(PASTE), 1e-3.into()] {
            let (temperatures, rates) = ([310.0, 390.0], [1e-2, 1e3]);
            let [low, high] = viscosity.range(temperatures, rates);
            let samples = (0..=400).flat_map(|i| (0..=400).map(move |j| (i, j)));
            let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
            for (i, j) in samples {
                let temperature = 310.0 + 0.2 * f64::from(i);
                let rate = 10_f64.powf(-2.0 + 5.0 * f64::from(j) / 400.0);
                let value = viscosity.at(temperature).viscosity(rate);
                assert!(value >= low * (1.0 - 1e-12) && value <= high * (1.0 + 1e-12));
                (least, most) = (least.min(value), most.max(value));
            }
            assert!(least < 1.001 * low && most > 0.999 * high, "{viscosity:?}");
        }
    }

    #[test]
    fn parameters_are_the_constants_of_the_law() {
        let mut paste = read(PASTE);
        let keys: Vec<_> = paste.parameters().iter().map(|row| row.key).collect();
        assert_eq!(keys, ["yield_stress", "consistency", "exponent"]);
        keys.iter().for_each(|key| *paste.number(key).unwrap() = 0.25);
        assert_eq!(paste.at(400.0).stress(16.0), 0.25 + 0.25 * 2.0);
        assert_eq!(paste.number("viscosity"), None);
        let mut newtonian = Viscosity::from(FluidLaw::Newtonian(Newtonian { value: 1.0 }));
        *newtonian.number("viscosity").unwrap() = 2.0;
        assert_eq!(newtonian.constant(), Some(2.0));
        assert_eq!(Viscosity::from(3.0).number("viscosity"), Some(&mut 3.0));
    }
}

//! Materials: a law of heat joined with a law of deformation and constants of fracture.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::solid::{Elasticity, FlowLaw};
use super::{Brittleness, Conduction, Constants, Part, PartVisitor, Property, SolidLaw};
use crate::substances;

/// Thermal and mechanical law of a solid, and constants of its fracture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    #[serde(flatten)]
    pub heat: Conduction,
    #[serde(flatten)]
    pub law: SolidLaw,
    #[serde(flatten)]
    pub fracture: Brittleness,
}

impl Material {
    /// Visits the types of the parts that the table of a model consists of.
    pub fn visit_parts(model: &str, visitor: &mut impl PartVisitor) {
        visitor.part::<Conduction>();
        SolidLaw::visit_parts(model, visitor);
        visitor.part::<Brittleness>();
    }

    /// Returns the constants at a temperature [K], without latent heat.
    pub fn at(&self, temperature: f64) -> Constants {
        let value = |property: &Property| property.value(temperature);
        let Elasticity { young, poisson, expansion, .. } = self.law.deformation().elasticity();
        Constants {
            density: self.heat.density,
            specific_heat: value(&self.heat.specific_heat),
            conductivity: value(&self.heat.conductivity),
            young: young.as_ref().map(value),
            poisson: poisson.as_ref().map(value),
            expansion: expansion.as_ref().map(value),
        }
    }

    /// The given constants that may be tables over the temperature, each with its key.
    pub fn properties(&self) -> Vec<(&'static str, &Property)> {
        let of_law = self.law.deformation().properties();
        self.heat.properties().into_iter().chain(of_law).collect()
    }

    /// The number that the scene gives for a key; `None` if there is none, or a table.
    pub fn number(&mut self, key: &str) -> Option<&mut f64> {
        let Self { heat, law, fracture } = self;
        let of_law = law.parts_mut().into_iter().find_map(|part| part.number(key));
        heat.number(key).or(of_law).or_else(|| fracture.number(key))
    }

    /// Returns true if the law allows permanent strain.
    pub fn yields(&self) -> bool {
        self.law.deformation().yields()
    }

    /// Returns the flow law of the body, stress-free at a temperature [K].
    ///
    /// # Panics
    /// If constants of elasticity are missing; checked scenes with mechanics have them.
    pub fn flow_law(&self, stress_free_temperature: f64) -> Arc<dyn FlowLaw> {
        self.law.deformation().flow_law(stress_free_temperature)
    }

    /// Returns the material with constants at a temperature [K], without melting and fracture. A law with a history is
    /// kept unless `elastic` is set.
    pub fn linearised(&self, temperature: f64, elastic: bool) -> Self {
        let heat = self.heat.linearised(temperature);
        let law = match elastic {
            true => self.law.deformation().elasticity().linearised(temperature).into(),
            false => self.law.clone(),
        };
        Self { heat, law, fracture: Brittleness::default() }
    }
}

/// The schema is a table of keys for each model; all of them include those of heat.
impl JsonSchema for Material {
    fn schema_name() -> Cow<'static, str> {
        "Material".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let heat = Conduction::json_schema(generator);
        let fracture = Brittleness::json_schema(generator);
        let mut schema = SolidLaw::json_schema(generator);
        let models = schema.get_mut("oneOf").and_then(Value::as_array_mut);
        models.into_iter().flatten().for_each(|model| {
            join(model, heat.as_value());
            append(model, fracture.as_value());
        });
        if let Some(models) = schema.get_mut("oneOf").and_then(Value::as_array_mut) {
            models.push(substances::schema());
        }
        schema.insert(
            "description".into(),
            "Conduction, a constitutive law and fracture, with their constants.".into(),
        );
        schema
    }
}

/// Adds the keys of another table, all optional, at the end of a table.
fn append(table: &mut Value, other: &Value) {
    let Some(own) = table.get_mut("properties").and_then(Value::as_object_mut) else { return };
    let other = other.get("properties").and_then(Value::as_object);
    own.extend(other.cloned().unwrap_or_default());
}

/// Inserts the keys of another table behind the first key of a table, the tag, and forbids any others.
fn join(table: &mut Value, other: &Value) {
    let of = |value: &Value| {
        value.get("properties").and_then(Value::as_object).cloned().unwrap_or_default()
    };
    let mut own = of(table).into_iter();
    table["properties"] =
        Value::Object(own.next().into_iter().chain(of(other)).chain(own).collect());
    if let (Some(Value::Array(needed)), Some(Value::Array(own))) =
        (other.get("required"), table.get_mut("required"))
    {
        own.extend(needed.clone());
    }
    table["additionalProperties"] = false.into();
}

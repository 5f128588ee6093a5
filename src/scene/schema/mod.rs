//! The JSON schema of scenes: what each key is, in one place, for editors, checks, messages and tables.
//!
//! It follows from the scene's types: doc comments are descriptions, and [`crate::limits`] says what numbers may be.

mod number;
mod place;
mod tables;
mod walk;

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Map, Value};

use super::locate::{Path, Step};
use super::types::Scene;
use crate::limits::keyword;

pub use number::Number;
pub use place::Place;
pub use tables::{SECTIONS, table};

/// The schema of a scene, draft 2020-12.
pub struct Schema {
    root: Value,
}

impl Schema {
    pub fn of_scenes() -> Self {
        let settings = SchemaSettings::draft2020_12();
        let settings = settings.with_transform(RecursiveTransform(simplify));
        Self { root: settings.into_generator().into_root_schema_for::<Scene>().to_value() }
    }

    pub fn json(&self) -> &Value {
        &self.root
    }

    /// The schema that a reference leads to, or the schema itself.
    fn resolved<'s>(&'s self, mut schema: &'s Value) -> &'s Value {
        while let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
            match self.root.pointer(reference.trim_start_matches('#')) {
                Some(definition) => schema = definition,
                None => break,
            }
        }
        schema
    }

    /// The schemas of which a value may follow one, those that references lead to among them.
    fn alternatives<'s>(&'s self, schema: &'s Value) -> Vec<&'s Value> {
        let schema = self.resolved(schema);
        match choices(schema) {
            None => vec![schema],
            Some(list) => list.iter().flat_map(|choice| self.alternatives(choice)).collect(),
        }
    }

    /// What numbers at a place are measured in, or those of the list that it is an element of.
    pub fn unit_at(&self, path: &Path) -> Option<&str> {
        let mut schemas = self.alternatives(&self.root);
        let mut unit = None;
        for step in path.steps() {
            let below = schemas.iter().filter_map(|schema| match step {
                Step::Key(key) => of_key(schema, key),
                Step::Index(_) => schema.get("items"),
            });
            let below: Vec<&Value> = below.collect();
            if let Step::Key(_) = step {
                unit = below.iter().find_map(|schema| schema.get(keyword::UNIT)?.as_str());
            }
            schemas = below.into_iter().flat_map(|schema| self.alternatives(schema)).collect();
        }
        unit.filter(|unit| *unit != "1")
    }
}

/// The schemas of which a value must follow one.
fn choices(schema: &Value) -> Option<&Vec<Value>> {
    schema.get("oneOf").or_else(|| schema.get("anyOf"))?.as_array()
}

/// The schema of what stands under a key of a table.
fn of_key<'s>(table: &'s Value, key: &str) -> Option<&'s Value> {
    let own = table.get("properties").and_then(|properties| properties.get(key));
    own.or_else(|| table.get("additionalProperties").filter(|other| other.is_object()))
}

/// Leaves out what TOML and readers of scenes do without: null, formats of numbers, lines of doc comments.
fn simplify(schema: &mut schemars::Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    object.remove("format");
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
    if let Some(Value::String(text)) = object.get_mut("description") {
        *text = text.replace('\n', " ");
    }
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            object.insert("type".into(), only);
        }
    }
    let Some(Value::Array(choices)) = object.get_mut("anyOf") else { return };
    choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
    if let [Value::Object(only)] = &mut choices[..] {
        let only: Map<String, Value> = std::mem::take(only);
        object.remove("anyOf");
        object.extend(only);
    }
}

//! The schema derived from the types, in its stored form.

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Map, Value, json};

use crate::limits::keyword;
use crate::scene::shorthand::is_convertible;
use crate::scene::types::Scene;

/// The JSON schema derived from the scene's types: [`super::SCHEMA`] must equal it.
pub fn derived_schema() -> Schema {
    let settings = SchemaSettings::draft2020_12();
    let settings = settings.with_transform(RecursiveTransform(simplify));
    settings.into_generator().into_root_schema_for::<Scene>()
}

/// Pattern of texts with units, as in `"90 °C"`.
const QUANTITY: &str = r"^\s*[-+−]?\.?[0-9]";

/// Lets texts with units stand for numbers whose unit can be converted.
fn take_texts(object: &mut Map<String, Value>) {
    let is_number = object.get("type").is_some_and(|kind| kind == "number");
    let unit = object.get(keyword::UNIT).and_then(Value::as_str);
    if is_number && unit.is_some_and(is_convertible) {
        object.insert("type".into(), json!(["number", "string"]));
        object.insert("pattern".into(), json!(QUANTITY));
    }
}

/// Removes what TOML and readers of scenes do not need: null, formats of numbers, line breaks of doc comments.
fn simplify(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    object.remove("format");
    match object.get_mut("default") {
        Some(Value::Null) => drop(object.remove("default")),
        Some(Value::Object(keys)) => keys.retain(|_, value| !value.is_null()),
        _ => {}
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
    take_texts(object);
    let Some(Value::Array(choices)) = object.get_mut("anyOf") else { return };
    choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
    if let [Value::Object(only)] = &mut choices[..] {
        let only = std::mem::take(only);
        object.remove("anyOf");
        // The description of a key precedes that of its type.
        for (key, value) in only {
            object.entry(key).or_insert(value);
        }
    }
}

//! Solids of large strain are `kind = "solid"` with `strain = "finite"`; inside the program they are a kind of their
//! own.

use std::borrow::Cow;

use schemars::Schema;
use serde_json::json;
use toml::de::DeValue;

use crate::scene::locate::{Path, Source};

/// Name of the kind within the program.
pub const KIND: &str = "solid of large strain";

/// Gives solids with `strain = "finite"` the name of their own kind while `work` reads the scene.
pub fn with_names<R>(source: &mut Source, work: impl FnOnce(&Source) -> R) -> R {
    let bodies = Path::default().key("body");
    let names = match source.value(&bodies) {
        Some(DeValue::Table(table)) => {
            table.keys().map(|name| bodies.key(name.get_ref())).collect()
        }
        _ => Vec::new(),
    };
    let is_one = |path: &Path| {
        let says = |key: &str| source.value(&path.key(key)).and_then(DeValue::as_str);
        says("kind") == Some("solid") && says("strain") == Some("finite")
    };
    let own: Vec<Path> = names.into_iter().filter(is_one).map(|path| path.key("kind")).collect();
    own.iter().for_each(|path| source.replace(path, DeValue::String(Cow::Borrowed(KIND))));
    let result = work(source);
    own.iter().for_each(|path| source.replace(path, DeValue::String(Cow::Borrowed("solid"))));
    result
}

/// Names the kind of solids of large strain in the schema as scenes do, `kind = "solid"`; both kinds of solids differ by
/// their measure of `strain`.
pub fn name_kind(schema: &mut Schema) {
    let kinds = schema.get_mut("oneOf").and_then(serde_json::Value::as_array_mut);
    for kind in kinds.into_iter().flatten() {
        let keys = &mut kind["properties"];
        let strain = match keys["kind"]["const"].as_str() {
            Some(KIND) => "finite",
            Some("solid") => "small",
            _ => continue,
        };
        keys["kind"]["const"] = json!("solid");
        if let Some(table) = keys["strain"].as_object_mut() {
            table.remove("$ref");
            table.remove("anyOf");
            table.insert("type".to_owned(), json!("string"));
            table.insert("const".to_owned(), json!(strain));
        }
    }
}

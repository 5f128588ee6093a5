//! Words of a scene for reports.

use serde::Serialize;

use crate::units::engineering;

pub fn metres(value: f64) -> String {
    engineering(value, "m")
}

/// The word for a value in the scene.
pub fn key(value: &impl Serialize) -> String {
    match toml::Value::try_from(value) {
        Ok(toml::Value::String(word)) => word,
        _ => String::new(),
    }
}

pub fn keys(values: &[impl Serialize]) -> String {
    values.iter().map(key).collect::<Vec<_>>().join(", ")
}

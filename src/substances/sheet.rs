//! The data sheet of a substance.

use serde::Deserialize;

/// The data sheet of a substance.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Name in words, with grade and condition.
    pub title: String,
    /// Further names of it.
    #[serde(default)]
    pub aliases: Vec<String>,
    /// Temperatures between which the constants hold [K].
    pub valid: [f64; 2],
    /// Works that the constants are from.
    pub sources: Vec<String>,
    /// Scatter, grade, anisotropy.
    pub note: Option<String>,
    /// Constants under the keys of a scene.
    pub constants: toml::Table,
}

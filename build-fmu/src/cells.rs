//! `resources/cells.json`: positions of the cells and points of arrays of variables.

use impinge::scene::Scene;
use impinge::variables::CellFamily;
use serde_json::{Map, json};

/// The families of a checked scene by their names, as JSON.
pub fn json(scene: &Scene) -> String {
    let named = |family: CellFamily| (family.name.clone(), json!(family));
    let families: Map<_, _> = CellFamily::all(scene).into_iter().map(named).collect();
    format!("{:#}\n", json!({ "families": families }))
}

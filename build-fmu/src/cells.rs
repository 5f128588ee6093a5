//! `resources/cells.json`: where the cells and points lie that arrays of variables belong to.

use impinge::scene::Scene;
use impinge::variables::CellFamily;

/// The families of a checked scene as JSON.
pub fn json(scene: &Scene) -> String {
    let families = serde_json::json!({ "families": CellFamily::all(scene) });
    format!("{families:#}\n")
}

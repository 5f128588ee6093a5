//! Names of outputs.

use impinge::scene::{Naming, Scene};

/// Name of an output of a body, in the style of the scene's names.
pub fn name(scene: &Scene, body: &str, key: &str) -> String {
    match scene.naming {
        Naming::Structured => format!("{body}.{key}"),
        Naming::Flat => format!("{body}_{key}"),
    }
}

//! JSON schema of a scene's table that names a substance.

use serde_json::{Value, json};

use crate::limits::TEMPERATURE;

/// Schema of a table that takes the constants of a substance, and replaces some.
pub fn schema() -> Value {
    json!({
        "description": "Constants of a substance of the library; other keys replace them.",
        "type": "object",
        "properties": {
            "substance": {
                "description": "Name of the substance: see `impinge substances`.",
                "type": "string"
            },
            "at": {
                "description": "Temperature at which constants are taken, so that they do not depend on it [K].",
                "type": ["number", "string"],
                "unit": "K",
                "noun": TEMPERATURE,
                "exclusiveMinimum": 0
            }
        },
        "required": ["substance"]
    })
}

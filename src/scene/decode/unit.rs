//! Units of the numbers in messages.

use crate::scene::locate::Path;
use crate::scene::schema::Schema;

/// Appends the unit at a position to the description of what is allowed there.
pub fn with_unit(allowed: String, schema: &Schema, place: &Path) -> String {
    let Some(unit) = schema.unit_at(place) else { return allowed };
    for kind in ["a finite number", "a list of 2 values", "a list of 3 values"] {
        if let Some(rest) = allowed.strip_prefix(kind) {
            return format!("{kind} in {unit}{rest}");
        }
    }
    allowed
}

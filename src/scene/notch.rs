//! Cracks that sections have before time starts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::within;

/// A straight crack that a section has at time zero, from one point to another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Notch {
    /// One end: x, or the radius of a disc, and z [m].
    #[schemars(transform = within(-1e6, 1e6, "m", "a place in a section"))]
    pub from: [f64; 2],
    /// The other end [m].
    #[schemars(transform = within(-1e6, 1e6, "m", "a place in a section"))]
    pub to: [f64; 2],
}

//! How much finer than usual the mesh of a solid is.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{not_negative, within};

/// How much finer than usual a mesh is; packing writes what follows from the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshFactors {
    /// Elements along the surface over those that follow from the other keys [1].
    #[schemars(transform = within(0.02, 100.0, "1", "").says(FACTOR, "0.02 to 100"))]
    pub along: f64,
    /// Elements through the thickness over those that follow from the other keys [1].
    #[schemars(transform = within(0.02, 100.0, "1", "").says(FACTOR, "0.02 to 100"))]
    pub through: f64,
    /// Largest relative error of the body's outputs that was estimated on this mesh [1].
    #[schemars(transform = not_negative("1", "an error").otherwise("estimated when it is read"))]
    pub estimated_error: Option<f64>,
    /// Whether heat that is linear goes through linear elements, as that does which is not: estimates ask for it.
    #[serde(skip)]
    pub linear_heat: bool,
}

const FACTOR: &str = "a mesh is finer or coarser than usual by a factor";

impl MeshFactors {
    /// Of a mesh whose error is not known.
    pub fn of([along, through]: [f64; 2]) -> Self {
        Self { along, through, estimated_error: None, linear_heat: false }
    }

    /// Along the surface and through the thickness.
    pub fn factors(&self) -> [f64; 2] {
        [self.along, self.through]
    }
}

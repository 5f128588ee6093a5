//! Refinement of a solid's mesh relative to the default.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{not_negative, within};

/// Refinement of a mesh relative to the default; packing writes the factors that follow from the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshFactors {
    /// Elements along the surface over those that follow from the other keys [1].
    #[schemars(transform = within(0.02, 100.0, "1", "").says(FACTOR, "0.02 to 100"))]
    pub along: f64,
    /// Elements through the thickness over those that follow from the other keys [1].
    #[schemars(transform = within(0.02, 100.0, "1", "").says(FACTOR, "0.02 to 100"))]
    pub through: f64,
    /// Largest relative error of the body's outputs, estimated on this mesh [1].
    #[schemars(transform = not_negative("1", "an error").otherwise("estimated when it is read"))]
    pub estimated_error: Option<f64>,
    /// True if linear heat uses linear elements, as nonlinear heat does; error estimates need it.
    #[serde(skip)]
    pub linear_heat: bool,
    /// True if the mechanics of the body is left out; estimates of the temperatures of bodies that crack need it.
    #[serde(skip)]
    pub heat_alone: bool,
}

const FACTOR: &str = "a mesh is refined or coarsened by a factor";

impl MeshFactors {
    /// Factors of a mesh with unknown error.
    pub fn of([along, through]: [f64; 2]) -> Self {
        Self { along, through, estimated_error: None, linear_heat: false, heat_alone: false }
    }

    /// Factors along the surface and through the thickness.
    pub fn factors(&self) -> [f64; 2] {
        [self.along, self.through]
    }
}

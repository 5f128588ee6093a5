//! Probes and fields, which read solids at places.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::types::{Footprint, IDENTIFIER};
use crate::limits::{any, count, length};

/// A point whose values become outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// First part of the outputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The body.
    #[serde(rename = "in")]
    #[schemars(extend("condition" = "a solid"))]
    pub body: String,
    /// The position `[x, y, z]` [m].
    #[schemars(transform = any("m").condition("in the body"))]
    pub at: [f64; 3],
    /// Side of an interface between layers at which the probe reads.
    #[schemars(extend("otherwise" = "`above`", "condition" = "at an interface of small strain only"))]
    pub side: Option<Side>,
    /// List of outputs.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub gives: Vec<Gives>,
}

/// A side of an interface between layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The side of the layer above.
    #[default]
    Above,
    /// The side of the layer below.
    Below,
}

/// Points on a regular grid, in the middle of equal cells, over a face or a plane section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// First part of the outputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The face, `BODY.FACE`.
    #[schemars(extend("condition" = "a plane face", "otherwise" = "`in` and `plane`"))]
    pub on: Option<String>,
    /// The body of a section.
    #[serde(rename = "in")]
    #[schemars(extend("condition" = "a solid, with `plane`", "otherwise" = "`on`"))]
    pub body: Option<String>,
    /// The section: `{ x = X }`, `{ y = Y }` or `{ z = Z }` [m].
    #[schemars(transform = any("m").condition("through the body").otherwise("`on`"))]
    pub plane: Option<Plane>,
    /// Number of points along the two axes of the face or section.
    #[schemars(transform = count().otherwise("`footprint`"))]
    pub grid: Option<[usize; 2]>,
    /// Footprint on a face over whose cells means are taken, as loads on the same footprint deposit their amounts.
    #[schemars(extend("condition" = "on its face, `top` or `bottom` of a solid", "otherwise" = "`grid`"))]
    pub footprint: Option<Footprint>,
    /// Position of the footprint's centre [m].
    #[schemars(transform = any("m").otherwise("the centre of the face").condition("with `footprint`; not on a disc"))]
    pub at: Option<[f64; 2]>,
    /// Extent of the grid along its axes [m], centred.
    #[schemars(transform = length("the extent of a grid").otherwise("the whole").condition("up to the full extent; with `grid`"))]
    pub size: Option<[f64; 2]>,
    /// List of outputs.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub gives: Vec<Gives>,
}

/// A section through a body at a constant coordinate [m].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Plane {
    X(#[schemars(transform = any("m"))] f64),
    Y(#[schemars(transform = any("m"))] f64),
    Z(#[schemars(transform = any("m"))] f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gives {
    /// Temperature [K].
    Temperature,
    /// The six components of the stress tensor and its von Mises value.
    Stress,
    /// The von Mises stress.
    VonMises,
    /// The largest principal stress, which opens cracks in brittle solids.
    MaxPrincipal,
    /// The three components.
    Displacement,
    /// Accumulated plastic strain, for bodies that yield.
    PlasticStrain,
    /// Damage, 0 to 1, for bodies that crack.
    Damage,
    /// Density of the failure risk over the volume [1/m³], for materials with `weibull` and a `volume`.
    FailureDensity,
    /// The same over the faces of the body [1/m²], for an `area`.
    SurfaceFailureDensity,
}

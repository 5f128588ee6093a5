//! Shapes of solids of large strain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Quadrilateral, Strand};
use crate::limits::{length, plausible};
use crate::scene::part::Part;
use crate::scene::types::Disc;

/// The shape of a solid of large strain. The origin of a box and of a disc is the centre of their top, that of a ball
/// its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SolidShape {
    /// Extents along x, y and z [m].
    Box(
        #[schemars(transform = length("the extent of a body").plausible(&plausible::EXTENT))]
        [f64; 3],
    ),
    /// A round plate or cylinder.
    Disc(Disc),
    /// A ball; in a plane model a circle.
    Ball(Ball),
    /// Four corners in x and z; its faces are those of a box, `left` and `right` between the corners there.
    Quadrilateral(Quadrilateral),
    /// A round strand along a path; in a plane model a strip.
    Strand(Strand),
    /// Cells or points from a file.
    Part(Part),
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Radius [m].
    #[schemars(transform = length("the radius of a body").plausible(&plausible::EXTENT))]
    pub radius: f64,
}

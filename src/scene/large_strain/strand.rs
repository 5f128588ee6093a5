//! Round strands along a path.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{length, plausible, signed};
use crate::scene::types::FaceName;
use crate::space::{Form, Sweep};

/// A round strand along a path of straight pieces, in a plane model a strip; its coordinates are those of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strand {
    /// Points `[x, y, z]` of its axis, in order; `left` is the face at the first, `right` at the last [m].
    #[schemars(length(min = 2, max = 1000))]
    #[schemars(transform = signed("m", "a point of a path"))]
    pub path: Vec<[f64; 3]>,
    /// Radius, of a strip half of its width [m].
    #[schemars(transform = length("the radius of a strand").plausible(&plausible::EXTENT))]
    pub radius: f64,
}

impl Strand {
    /// The circle, in a plane the interval, that the path moves.
    pub fn sweep(&self, form: Form) -> Sweep {
        Sweep::new(form, &self.path, self.radius)
    }

    /// Returns true if a face is an end whose normal is the axis of its name.
    pub fn is_along(&self, face: FaceName) -> bool {
        let ends = match (face, &self.path[..]) {
            (FaceName::Left, [first, second, ..]) => [first, second],
            (FaceName::Right, [.., before, last]) => [before, last],
            _ => return false,
        };
        let [from, to] = ends;
        (0..3).all(|axis| Some(axis) == face.normal() || from[axis] == to[axis])
    }
}

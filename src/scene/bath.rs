//! Baths into which solids sink.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::types::{FaceName, PlaneSection, Solid};
use crate::limits::{ambient, not_negative, plausible, within};

/// A bath into which a body sinks, bottom first, at a constant speed. What is below its surface exchanges the heat flux
/// `q = h (T∞ − T)` with it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bath {
    /// Heat transfer coefficient h [W/(m² K)]; a parameter.
    #[schemars(transform = not_negative("W/(m² K)", "a heat transfer coefficient")
        .plausible(&plausible::HEAT_TRANSFER))]
    pub coefficient: f64,
    /// Temperature T∞ of the bath [K]; a parameter.
    #[schemars(transform = ambient())]
    pub ambient: f64,
    /// Speed at which the body sinks [m/s], negative where it is drawn out; a parameter.
    #[schemars(transform = within(-1e3, 1e3, "m/s", "the speed of a body"))]
    pub speed: f64,
    /// Immersed height at time zero [m], negative for a bottom above the surface; a parameter.
    #[serde(default)]
    #[schemars(transform = within(-1e6, 1e6, "m", "an immersed height"))]
    pub depth: f64,
}

impl Solid {
    /// The faces that a bath wets: those without a thermal condition of their own. Front and back of a section in plane
    /// strain are no faces.
    pub fn wetted_faces(&self) -> Vec<FaceName> {
        let is_plane = self.section == Some(PlaneSection::PlaneStrain);
        let is_open = |&name: &FaceName| {
            let face = self.face(name);
            let is_across = matches!(name, FaceName::Front | FaceName::Back);
            face.thermal().is_empty() && face.radiation.is_none() && !(is_plane && is_across)
        };
        self.shape.faces().iter().copied().filter(is_open).collect()
    }
}

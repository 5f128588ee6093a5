//! Baths into which solids sink.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::types::{FaceName, PlaneSection, Shape, Solid};
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
    /// Largest Biot number through its thickness at which a plate counts as evenly warm: its middle and surfaces then
    /// differ by 5 % of the difference to the bath.
    pub const THIN: f64 = 0.1;

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

    /// Biot number `h L/k` through the thickness of a section in plane stress in its bath: L is half of it where front
    /// and back are wetted, and all of it where one is.
    pub fn biot_in_bath(&self) -> Option<f64> {
        let is_thin = self.section == Some(PlaneSection::PlaneStress);
        let (Some(bath), Shape::Box([_, thickness, _]), true) = (self.bath, self.shape, is_thin)
        else {
            return None;
        };
        let is_across = |name: &FaceName| matches!(name, FaceName::Front | FaceName::Back);
        let wetted = self.wetted_faces().into_iter().filter(is_across).count();
        let conductivity = self.strata().first()?.constants.conductivity;
        (wetted > 0).then(|| bath.coefficient * thickness / wetted as f64 / conductivity)
    }
}

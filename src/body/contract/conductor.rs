//! Faces that answer to what others give.

use crate::body::BodyError;
use crate::body::contract::{Acts, Memo};
use crate::port::{Surface, SurfaceResponse, WallCells};
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;

/// A body whose faces answer to heat and force that others give.
pub trait Conductor {
    /// How a face answers to heat that is uniform along an area of it [m²].
    fn response(&self, face: FaceName, area: f64) -> SurfaceResponse;

    /// Thermal diffusivity beside a face [m²/s].
    fn diffusivity(&self, face: FaceName) -> f64;

    /// What temperatures may err by from step to step [K]; nothing where they are exact.
    fn tolerance(&self) -> f64;

    /// The cells through which others exchange with a face; nothing of a body that is the same all over, which takes
    /// those of what it touches.
    fn cells(&self, face: FaceName) -> Option<WallCells>;

    /// Each face over a step if nothing is received, and how it answers to heat.
    fn surfaces(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError>;

    /// Temperatures of the cells of faces at the end of what acts [K].
    fn temperatures_after(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Vec<f64>>, BodyError>;
}

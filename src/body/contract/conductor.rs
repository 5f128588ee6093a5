//! Faces that respond to heat from other bodies.

use crate::body::BodyError;
use crate::body::contract::{Acts, Memo};
use crate::port::{Surface, SurfaceResponse, WallCells};
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;

/// A body whose faces respond to heat and force from other bodies.
pub trait Conductor {
    /// Returns the response of a face to heat that is uniform over an area of it [m²].
    fn response(&self, face: FaceName, area: f64) -> SurfaceResponse;

    /// Returns the thermal diffusivity at a face [m²/s].
    fn diffusivity(&self, face: FaceName) -> f64;

    /// Returns the error of temperatures from step to step [K]; zero where they are exact.
    fn tolerance(&self) -> f64;

    /// Returns the cells through which other bodies exchange with a face. A body of uniform temperature has none and
    /// adopts those of its partner.
    fn cells(&self, face: FaceName) -> Option<WallCells>;

    /// Returns each face over a step without received heat, and its response to heat.
    fn surfaces(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError>;

    /// Returns the temperatures of the cells of faces at the end of a step [K].
    fn temperatures_after(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Vec<f64>>, BodyError>;
}

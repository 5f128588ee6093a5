//! Conditions on faces of solids of large strain, and their inputs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{Limits, heat_flux, own_temperature, signed, traction};
use crate::scene::types::{Convection, Face, FaceName};

/// Conditions on a face of a solid of large strain: at most one thermal one, and a mechanical one, or `roller` with
/// `displacement`, or `pressure` with `traction`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeldFace {
    /// No displacement.
    #[serde(default)]
    pub clamped: bool,
    /// No displacement along the normal; with `displacement`, that one along it, and none is held across.
    #[serde(default)]
    pub roller: bool,
    /// Displacement along x, y and z at the start; inputs [m].
    #[schemars(transform = displacement().otherwise("free"))]
    pub displacement: Option<[f64; 3]>,
    /// Pressure on the deformed face, into the body, at the start; an input [Pa].
    #[schemars(transform = traction().otherwise("free"))]
    pub pressure: Option<f64>,
    /// Force per area of the undeformed face along x, y and z at the start; inputs [Pa].
    #[schemars(transform = traction().otherwise("free"))]
    pub traction: Option<[f64; 3]>,
    /// Prescribed temperature [K]; an input.
    #[schemars(transform = own_temperature().otherwise("insulated"))]
    pub temperature: Option<f64>,
    /// Heat flux into the body per present area [W/m²]; an input.
    #[schemars(transform = heat_flux().otherwise("insulated"))]
    pub flux: Option<f64>,
    /// Heat flux by convection to a fluid, per present area.
    #[schemars(extend("otherwise" = "insulated"))]
    pub convection: Option<Convection>,
}

/// A component of the load on a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadComponent {
    Pressure,
    /// Along an axis.
    Traction(usize),
}

impl HeldFace {
    /// Keys of the mechanical conditions that are set.
    pub fn conditions(&self) -> Vec<&'static str> {
        let given = [
            ("clamped", self.clamped),
            ("roller", self.roller),
            ("displacement", self.displacement.is_some()),
            ("pressure", self.pressure.is_some()),
            ("traction", self.traction.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
    }

    /// Thermal conditions as those of other solids.
    pub fn heated(&self) -> Face {
        let Self { temperature, flux, convection, .. } = *self;
        Face { temperature, flux, convection, ..Face::default() }
    }

    /// Returns true if the face is held or moved.
    pub fn is_held(&self) -> bool {
        self.clamped || self.roller || self.displacement.is_some()
    }

    /// Returns true if a load acts on the face, which is not held then.
    pub fn is_loaded(&self) -> bool {
        self.pressure.is_some() || self.traction.is_some()
    }
}

/// Displacement of a face [m].
pub(super) const fn displacement() -> Limits {
    signed("m", "a displacement")
}

impl HeldFace {
    /// Returns true if the face is neither moved nor drawn along x or y at the start.
    pub(super) fn is_straight(&self) -> bool {
        let along = [self.displacement, self.traction];
        along.into_iter().flatten().all(|by| by[0] == 0.0 && by[1] == 0.0)
    }

    /// Returns true if no input moves or draws the face along x or y in a model of the whole body.
    pub(super) fn stays_straight(&self, face: FaceName) -> bool {
        let is_moved = self.displacement.is_some() && !(self.roller && face.normal() == Some(2));
        !is_moved && self.traction.is_none()
    }
}

/// Last part of the name of an input of a face.
macro_rules! face_key {
    ($face:expr, $suffix:literal) => {
        match $face {
            FaceName::Top => concat!("top.", $suffix),
            FaceName::Bottom => concat!("bottom.", $suffix),
            FaceName::Sides => concat!("sides.", $suffix),
            FaceName::Left => concat!("left.", $suffix),
            FaceName::Right => concat!("right.", $suffix),
            FaceName::Front => concat!("front.", $suffix),
            FaceName::Back => concat!("back.", $suffix),
        }
    };
}

pub(super) fn displacement_key(face: FaceName, axis: usize) -> &'static str {
    match axis {
        0 => face_key!(face, "displacement_x"),
        1 => face_key!(face, "displacement_y"),
        _ => face_key!(face, "displacement_z"),
    }
}

pub(super) fn load_key(face: FaceName, component: LoadComponent) -> &'static str {
    match component {
        LoadComponent::Pressure => face_key!(face, "pressure"),
        LoadComponent::Traction(0) => face_key!(face, "traction_x"),
        LoadComponent::Traction(1) => face_key!(face, "traction_y"),
        LoadComponent::Traction(_) => face_key!(face, "traction_z"),
    }
}

//! Faces of solids and the conditions on them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{ambient, heat_flux, not_negative, own_temperature, plausible, within};

#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum FaceName {
    Top,
    Bottom,
    /// All lateral faces.
    Sides,
    /// x = −Lx/2 of a box.
    Left,
    /// x = +Lx/2 of a box.
    Right,
    /// y = −Ly/2 of a box.
    Front,
    /// y = +Ly/2 of a box.
    Back,
}

/// Conditions on one face: at most one thermal and at most one mechanical.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Face {
    /// Prescribed temperature [K]; an input.
    #[schemars(transform = own_temperature().otherwise("insulated"))]
    pub temperature: Option<f64>,
    /// Uniform heat flux into the body [W/m²]; an input.
    #[schemars(transform = heat_flux().otherwise("insulated"))]
    pub flux: Option<f64>,
    /// Heat flux by convection to a fluid.
    #[schemars(extend("otherwise" = "insulated"))]
    pub convection: Option<Convection>,
    /// Heat flux by radiation, alone or in addition to `flux` or `convection`.
    pub radiation: Option<Radiation>,
    /// Zero displacement.
    #[serde(default)]
    pub clamped: bool,
    /// Zero displacement along the normal.
    #[serde(default)]
    pub roller: bool,
    /// Role of the face's value: an input or a tunable parameter.
    #[serde(default)]
    #[schemars(extend("condition" = "of `temperature`, `flux`, `convection`"))]
    pub role: Role,
}

/// Role of a variable in coupled simulations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Can be connected.
    #[default]
    Input,
    /// Keeps its value until it is set, also between steps; it cannot be connected.
    Parameter,
}

/// Heat flux into the body `q = h (T∞ − T)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Heat transfer coefficient h [W/(m² K)]; a parameter.
    #[schemars(transform = not_negative("W/(m² K)", "a heat transfer coefficient")
        .plausible(&plausible::HEAT_TRANSFER))]
    pub coefficient: f64,
    /// Temperature T∞ of the fluid [K]; an input.
    #[schemars(transform = ambient())]
    pub ambient: f64,
}

/// Heat flux into the body `q = ε σ (T∞⁴ − T⁴)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Emissivity ε [1].
    #[schemars(transform = within(0.0, 1.0, "1", "").says("an emissivity is a part", "0 to 1"))]
    pub emissivity: f64,
    /// Temperature of the surroundings T∞ [K].
    #[schemars(transform = ambient())]
    pub ambient: f64,
}

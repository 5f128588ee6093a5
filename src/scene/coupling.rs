//! Walls below bodies that fall, and couplings of bodies with solids.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::types::{CellValues, Footprint, IDENTIFIER};
use crate::limits::{Limits, above_zero, length, own_temperature, plausible, within};

/// Conductance of a contact [W/(m² K)].
const fn conductance() -> Limits {
    let limits = within(1e-12, 1e15, "W/(m² K)", "the conductance of the contact");
    limits.plausible(&plausible::CONDUCTANCE)
}

/// A wall below a droplet or a solid of large strain, whose temperatures are inputs, and heat fluxes and tractions
/// outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// First part of the variables' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The droplet or solid of large strain that falls.
    #[schemars(extend("condition" = "a droplet, or a solid of large strain with explicit motion, without coupling"))]
    pub under: String,
    /// Cells of the wall, centred on the origin.
    #[schemars(extend("condition" = "`rings` (bodies that fall at the centre), `tiles`"))]
    pub footprint: Footprint,
    /// √(kρc) of the solid that a master couples [W √s/(m² K)]. It limits the heat of first contact by the response of
    /// the solid's surface within a step.
    #[serde(default)]
    #[schemars(transform = above_zero("W √s/(m² K)")
        .low("the effusivity √(kρc) of what lies below is positive", "> 0 (W √s/(m² K))")
        .otherwise("none: prescribed wall temperature")
        .condition("below droplets"))]
    pub effusivity: Option<f64>,
    /// Heat flux over the difference of the temperatures of the surfaces of body and wall [W/(m² K)].
    #[serde(default)]
    #[schemars(transform = conductance()
        .otherwise("perfect contact of a droplet; no heat from a solid of large strain"))]
    pub conductance: Option<f64>,
    /// Start values.
    #[serde(default)]
    #[schemars(extend("otherwise" = ""))]
    pub start: WallStart,
}

/// Start values of a wall's inputs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallStart {
    /// Temperature of all cells, or a list for each [K].
    #[schemars(transform = own_temperature().otherwise("that of the body"))]
    pub temperature: Option<CellValues>,
}

/// Exchange of heat and momentum between a droplet and the top of a solid, or of heat between two solids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// The droplet or solid of large strain that falls, the filament that is laid, or the top face of the lower solid.
    #[schemars(extend("condition" = "a droplet or a solid of large strain with explicit motion, without wall; a filament; `SOLID.top`"))]
    pub from: String,
    /// The face.
    #[schemars(extend(
        "condition" = "`SOLID.top` without prescribed temperature, below a droplet or filament; `SOLID.bottom` of the upper solid"
    ))]
    pub to: String,
    /// Heat flux over the difference of the temperatures of both surfaces [W/(m² K)].
    #[schemars(transform = conductance()
        .otherwise("perfect contact of a droplet or filament; no heat from a solid of large strain; needed between solids"))]
    pub conductance: Option<f64>,
    /// Load of the fluid's pressure and shear on the solid.
    #[serde(default = "crate::scene::defaults::yes")]
    pub traction: bool,
    /// Longest time between two exchanges [s]; of a filament at most `0.1 D²/a` of nozzle and fluid.
    #[schemars(transform = within(1e-30, 1e12, "s", "the time between exchanges")
        .otherwise("from the flow and the contact; for solids the communication step"))]
    pub interval: Option<f64>,
    /// Distance from each arrival, or from the path of a nozzle, within which the solid's mesh is fine [m].
    #[schemars(transform = length("the radius of the fine mesh")
        .otherwise("the expected spread of the drop; two diameters of the nozzle"))]
    pub radius: Option<f64>,
}

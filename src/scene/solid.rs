//! Thermo-elastic solids: their shapes, layers and meshes.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::large_strain::SmallStrain;
use super::materials::MaterialChoice;
use super::types::{Bath, Face, FaceName, Notch};
use crate::kernel::Kernel;
use crate::limits::{
    Keys, above_zero, length, not_negative, own_temperature, plausible, whole, within,
};

/// A solid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Measure of deformation; solids of large strain have other keys.
    #[serde(default)]
    pub strain: SmallStrain,
    /// `{ box = [LX, LY, LZ] }` or `{ disc = { radius = R, thickness = T } }`.
    pub shape: Shape,
    /// Material of the body: a table, or the name of a `[material.NAME]`.
    #[schemars(extend("otherwise" = "`layers`"))]
    pub material: Option<MaterialChoice>,
    /// Layers from the top, instead of `material`.
    #[schemars(
        length(min = 1, max = 100),
        extend("condition" = "total thickness equal to that of the shape (relative 1e-9)", "otherwise" = "one material")
    )]
    pub layers: Option<Vec<Layer>>,
    /// Uniform temperature at time zero [K].
    #[schemars(transform = own_temperature())]
    pub initial_temperature: f64,
    /// Temperature at which the body is free of thermal stress [K].
    #[schemars(transform = own_temperature().otherwise("that at time zero"))]
    pub stress_free_temperature: Option<f64>,
    /// Method of heat conduction: finite elements or particles.
    #[serde(default)]
    pub heat: HeatMethod,
    /// Settings of conduction by particles.
    #[schemars(extend("condition" = "with `heat = \"sph\"` only"))]
    pub sph: Option<SphSettings>,
    /// Meshed part of the body; it represents all loads exactly.
    #[serde(default)]
    #[schemars(extend("condition" = "a box is not `axisymmetric`, a disc is"))]
    pub symmetry: Symmetry,
    /// The mesh.
    #[serde(default)]
    #[schemars(extend("otherwise" = "automatic"))]
    pub mesh: Mesh,
    /// Plane section x–z that represents a box: nothing varies along y.
    #[schemars(extend("condition" = "of boxes that crack (`fracture`)", "otherwise" = "cracks in space"))]
    pub section: Option<PlaneSection>,
    /// Conditions on faces.
    #[serde(default)]
    #[schemars(
        extend("otherwise" = "insulated and free"),
        transform = Keys(FaceName::ALL.map(FaceName::as_str))
    )]
    pub faces: BTreeMap<FaceName, Face>,
    /// A bath into which the body sinks, bottom first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend(
        "condition" = "with `mesh.depth_spacing` and `mesh.growth = 1.0` unless the body cracks",
        "otherwise" = "none"
    ))]
    pub bath: Option<Bath>,
    /// Cracks at time zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("condition" = "of discs and plane sections that crack (`fracture`)", "otherwise" = "none"))]
    pub notches: Vec<Notch>,
    /// Running maxima of the body as outputs, each with its time and position.
    #[serde(default)]
    #[schemars(extend("uniqueItems" = true))]
    pub peaks: Vec<PeakOf>,
}

/// State of a plane section along its normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlaneSection {
    /// No strain along y: long bodies, which heat stresses along y, cracked or not.
    PlaneStrain,
    /// No stress along y: thin plates.
    PlaneStress,
}

/// Quantity of a running maximum over a body and over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PeakOf {
    /// Temperature.
    Temperature,
    /// The von Mises stress.
    VonMises,
    /// The largest principal stress, which opens cracks in brittle solids.
    MaxPrincipal,
}

/// A layer of a body, which covers it from side to side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Material of the layer: the name of a `[material.NAME]`, or a table as in a solid.
    pub material: MaterialChoice,
    /// Thickness [m].
    #[schemars(transform = length("the thickness of a layer").plausible(&plausible::LAYER))]
    pub thickness: f64,
    /// Thermal resistance of the contact with the layer above [m² K/W]; a parameter.
    #[schemars(transform = not_negative("m² K/W", "a contact resistance")
        .plausible(&plausible::CONTACT)
        .otherwise("0: perfect contact")
        .condition("not on the top layer"))]
    pub contact_resistance: Option<f64>,
}

/// The shape of a body. The origin is the centre of its top face; z points out of the body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// Extents along x, y and z [m].
    Box(
        #[schemars(transform = length("the extent of a body").plausible(&plausible::EXTENT))]
        [f64; 3],
    ),
    /// A round plate, modelled axisymmetric.
    Disc(Disc),
}

/// A round plate with its axis along z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Radius [m].
    #[schemars(transform = length("the radius of a body").plausible(&plausible::EXTENT))]
    pub radius: f64,
    /// Extent along z [m].
    #[schemars(transform = length("the thickness of a body").plausible(&plausible::EXTENT))]
    pub thickness: f64,
}

impl Shape {
    /// Extent along z [m].
    pub fn thickness(&self) -> f64 {
        match self {
            Shape::Box(extents) => extents[2],
            Shape::Disc(disc) => disc.thickness,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HeatMethod {
    /// Finite elements on the mesh of the mechanics.
    #[default]
    Fem,
    /// Smoothed particles on the nodes of the mesh.
    Sph,
}

/// Settings of heat conduction by particles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SphSettings {
    /// Operator: exact for quadratics on any mesh, or conservative pair by pair.
    #[schemars(extend("condition" = "`plain` on a box with equal distances"))]
    pub operator: SphOperator,
    /// Smoothing kernel.
    pub kernel: Kernel,
    /// Support radius of the kernel.
    #[schemars(transform = within(1.0, 5.0, "distances of particles", "").low_open().says(
        "the support radius, in distances of particles, reaches too few or too many",
        "1 < support <= 5",
    ))]
    pub support: f64,
}

impl Default for SphSettings {
    fn default() -> Self {
        Self { operator: SphOperator::default(), kernel: Kernel::default(), support: 3.0 }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SphOperator {
    /// Exact for quadratics on any set of particles (Fatehi & Manzari 2011).
    #[default]
    Corrected,
    /// Conserves heat pair by pair; for equal distances (Cleary & Monaghan 1999).
    Plain,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Symmetry {
    /// All symmetries of shape and faces.
    #[default]
    Auto,
    /// Mesh the whole body (boxes only).
    None,
    /// Mesh a quarter of a box. Loads at any position are split into symmetric and antisymmetric parts about the two
    /// planes, so nothing is neglected.
    Quarter,
    /// Mesh a meridian section of a disc.
    Axisymmetric,
}

/// The mesh; defaults follow from loads, material and the shorter of step and stop time.
///
/// It is fine near loads and heat fluxes: along x and y at loads and at sides that exchange heat, along z below tops
/// and bottoms with loads or any thermal condition.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Distance of nodes along x and y at loads and at heated sides [m]; everywhere if there are none.
    #[schemars(transform = above_zero("m").condition("up to half of the width; at least 12 elements from the centre to a side unless `growth` is 1").otherwise("from the loads"))]
    pub spacing: Option<f64>,
    /// Distance of nodes along z at loaded or heated faces [m]; everywhere if there are none.
    #[schemars(transform = above_zero("m")
        .condition("up to the thickness")
        .otherwise("from the penetration depth of heat in a step; `spacing` if set alone"))]
    pub depth_spacing: Option<f64>,
    /// Ratio of the sizes of neighbouring elements outside the fine region [1].
    #[schemars(transform = within(1.0, 2.0, "1", "")
        .says("neighbouring elements grow by a modest ratio", "1 <= growth <= 2")
        .otherwise("automatic, about 1.4"))]
    pub growth: Option<f64>,
    /// Order of the shape functions: linear or quadratic.
    #[schemars(transform = whole(1, 2, "no shape functions of this order", "1 (linear), 2 (quadratic)")
        .condition("with `heat = \"sph\"` 1")
        .otherwise("2; with `heat = \"sph\"` 1"))]
    pub order: Option<usize>,
}

impl Mesh {
    /// Smallest number of elements from the centre to a side, where elements may grow.
    pub const LATERAL_ELEMENTS: f64 = 12.0;
}

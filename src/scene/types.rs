//! Types of a scene: solids, their meshes and faces, probes, fields and settings.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::droplet::{Coupling, Droplet, Wall};
use super::filament::{Filament, Target};
use super::flaw::Flaw;
use super::large_strain::{LargeStrain, SmallStrain, name_kind};
use super::lattice::Lattice;
use super::materials::MaterialChoice;
use super::refinement::MeshFactors;
use super::reservoir::Reservoir;
use super::shorthand::NamedSubstance;
use crate::kernel::Kernel;
use crate::laws::Material;
use crate::limits::{
    Keys, above_zero, ambient, any, count, heat_flux, length, not_negative, own_temperature,
    plausible, tag, time, whole, within,
};

pub use super::load::{Carries, CellShape, CellValues, Footprint, Load, LoadRange, LoadStart};

/// Pattern of scene names; variable names begin with them.
pub(super) const IDENTIFIER: &str = "^[A-Za-z_][A-Za-z0-9_]*$";

/// Contents of a `scene.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Name of the model and of its folder `out/NAME`; a C identifier.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "letters, digits and `_`, no digit first"))]
    pub name: String,
    /// One-line description.
    #[serde(default)]
    #[schemars(extend("condition" = "no control characters", "otherwise" = "empty"))]
    pub description: String,
    /// End of the default experiment [s].
    #[schemars(transform = time("the stop time"))]
    pub stop_time: f64,
    /// Communication step of the default experiment [s].
    #[schemars(transform = time("the step").condition("up to `stop_time`, at most 1e9 steps"))]
    pub step: f64,
    /// Style of the unit's variable names: `a.b[1,2]` or `a_b_1_2`.
    #[serde(default)]
    pub naming: Naming,
    /// Marks an intentionally cold scene. In other scenes temperatures below 200 K, or below 250 K alongside warmer
    /// ones, raise a warning that they may be in °C.
    #[serde(default, skip_serializing_if = "is_false")]
    #[schemars(extend("otherwise" = "false"))]
    pub cryogenic: bool,
    /// Substances of the library that the text names.
    #[serde(skip)]
    #[schemars(skip)]
    pub substances: Vec<NamedSubstance>,
    /// Tables `[material.NAME]` that solids and layers name.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// Tables `[body.NAME]`, each a solid, a droplet, a filament, a lattice or a reservoir.
    #[schemars(extend("minProperties" = 1, "condition" = "at least one"))]
    pub body: BTreeMap<String, Body>,
    /// Tables `[[load]]`: loads on faces, whose amounts become inputs.
    #[serde(default)]
    pub load: Vec<Load>,
    /// Tables `[[probe]]`: points whose values become outputs.
    #[serde(default)]
    pub probe: Vec<Probe>,
    /// Tables `[[field]]`: points of grids and means over cells, whose values become arrays of outputs.
    #[serde(default)]
    pub field: Vec<Field>,
    /// Tables `[[flaw]]`: cracks that are assumed in solids, whose stress intensity becomes an output.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flaw: Vec<Flaw>,
    /// Tables `[[wall]]`: walls below droplets, whose temperatures become inputs; their heat and momentum become
    /// outputs.
    #[serde(default)]
    pub wall: Vec<Wall>,
    /// Tables `[[coupling]]`: droplets and filaments on solids of the same scene, and solids on solids.
    #[serde(default)]
    pub coupling: Vec<Coupling>,
    /// Tables `[[target]]`: lines that filaments are meant to follow.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub target: Vec<Target>,
    /// Level of detail of the model.
    #[serde(default)]
    #[schemars(extend("otherwise" = ""))]
    pub fidelity: Fidelity,
    /// Settings of the solver.
    #[serde(default)]
    #[schemars(extend("otherwise" = ""))]
    pub solver: Solver,
    /// Tables `[refinement.BODY]`: refinement of a solid's mesh relative to the default.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("condition" = "of solids", "otherwise" = "from `fidelity.tolerance`"))]
    pub refinement: BTreeMap<String, MeshFactors>,
    /// Tables `[resolved.BODY]`: the level that `fidelity.level = "auto"` selected for a solid; packing writes them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend(
        "condition" = "of solids, where the level is `auto`",
        "otherwise" = "`reduced` where possible"
    ))]
    pub resolved: BTreeMap<String, ResolvedLevel>,
    /// Texts of the files that the scene names, by their names. They are added when the scene is read, so that it is
    /// whole wherever it goes.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("condition" = "names of files in the scene", "otherwise" = "read from the files"))]
    pub files: BTreeMap<String, String>,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// Choice for a solid where a scene leaves it open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResolvedLevel {
    /// Level of detail of the solid.
    pub level: SolidLevel,
}

/// Levels of detail of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SolidLevel {
    Full,
    /// Some tens of unknowns, with an error bound.
    Reduced,
}

/// Names of a unit's variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Naming {
    /// `spot.heat_flux[1,2]`
    #[default]
    Structured,
    /// `spot_heat_flux_1_2`, for tools that accept only identifiers.
    Flat,
}

impl Naming {
    /// Name of the convention in a model description.
    pub fn name(self) -> &'static str {
        match self {
            Naming::Structured => "structured",
            Naming::Flat => "flat",
        }
    }
}

/// A body by kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
#[schemars(transform = tag("kind", "What the body is"), transform = name_kind)]
pub enum Body {
    /// A solid that conducts heat and deforms elastically.
    Solid(Box<Solid>),
    /// Drops of a fluid.
    Droplet(Box<Droplet>),
    /// A body of one temperature.
    Reservoir(Reservoir),
    /// A solid whose strains and rotations may be of any size.
    #[serde(rename(serialize = "solid", deserialize = "solid of large strain"))]
    LargeStrain(Box<LargeStrain>),
    /// A fluid that a moving nozzle lays as a strand.
    Filament(Box<Filament>),
    /// A strip of concrete as a lattice of links that soften and break.
    Lattice(Box<Lattice>),
}

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
    #[schemars(extend("condition" = "of boxes that crack (`fracture`)"))]
    pub section: Option<PlaneSection>,
    /// Conditions on faces.
    #[serde(default)]
    #[schemars(
        extend("otherwise" = "insulated and free"),
        transform = Keys(FaceName::ALL.map(FaceName::as_str))
    )]
    pub faces: BTreeMap<FaceName, Face>,
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

/// A point whose values become outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// First part of the outputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The body.
    #[serde(rename = "in")]
    #[schemars(extend("condition" = "a solid"))]
    pub body: String,
    /// The position `[x, y, z]` [m].
    #[schemars(transform = any("m").condition("in the body"))]
    pub at: [f64; 3],
    /// Side of an interface between layers at which the probe reads.
    #[schemars(extend("otherwise" = "`above`", "condition" = "at an interface of small strain only"))]
    pub side: Option<Side>,
    /// List of outputs.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub gives: Vec<Gives>,
}

/// A side of an interface between layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The side of the layer above.
    #[default]
    Above,
    /// The side of the layer below.
    Below,
}

/// Points on a regular grid, in the middle of equal cells, over a face or a plane section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// First part of the outputs' names.
    #[schemars(extend("pattern" = IDENTIFIER, "condition" = "as that of the scene"))]
    pub name: String,
    /// The face, `BODY.FACE`.
    #[schemars(extend("condition" = "a plane face", "otherwise" = "`in` and `plane`"))]
    pub on: Option<String>,
    /// The body of a section.
    #[serde(rename = "in")]
    #[schemars(extend("condition" = "a solid, with `plane`", "otherwise" = "`on`"))]
    pub body: Option<String>,
    /// The section: `{ x = X }`, `{ y = Y }` or `{ z = Z }` [m].
    #[schemars(transform = any("m").condition("through the body").otherwise("`on`"))]
    pub plane: Option<Plane>,
    /// Number of points along the two axes of the face or section.
    #[schemars(transform = count().otherwise("`footprint`"))]
    pub grid: Option<[usize; 2]>,
    /// Footprint on a face over whose cells means are taken, as loads on the same footprint deposit their amounts.
    #[schemars(extend("condition" = "on its face, `top` or `bottom` of a solid", "otherwise" = "`grid`"))]
    pub footprint: Option<Footprint>,
    /// Position of the footprint's centre [m].
    #[schemars(transform = any("m").otherwise("the centre of the face").condition("with `footprint`; not on a disc"))]
    pub at: Option<[f64; 2]>,
    /// Extent of the grid along its axes [m], centred.
    #[schemars(transform = length("the extent of a grid").otherwise("the whole").condition("up to the full extent; with `grid`"))]
    pub size: Option<[f64; 2]>,
    /// List of outputs.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub gives: Vec<Gives>,
}

/// A section through a body at a constant coordinate [m].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Plane {
    X(#[schemars(transform = any("m"))] f64),
    Y(#[schemars(transform = any("m"))] f64),
    Z(#[schemars(transform = any("m"))] f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gives {
    /// Temperature [K].
    Temperature,
    /// The six components of the stress tensor and its von Mises value.
    Stress,
    /// The von Mises stress.
    VonMises,
    /// The largest principal stress, which opens cracks in brittle solids.
    MaxPrincipal,
    /// The three components.
    Displacement,
    /// Accumulated plastic strain, for bodies that yield.
    PlasticStrain,
    /// Damage, 0 to 1, for bodies that crack.
    Damage,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fidelity {
    /// Level of detail.
    #[serde(default)]
    pub level: FidelityLevel,
    /// Relative tolerance of outputs, over their range in the default experiment [1]. Times 10 K, it is the tolerance
    /// of an inner step of nonlinear heat; a tenth of it, times the largest elastic strain, that of a
    /// step of creep or relaxation.
    #[serde(default = "default_tolerance")]
    #[schemars(transform = within(0.0, 1.0, "1", "")
        .open()
        .says("the tolerance is relative", "0 < tolerance < 1"))]
    pub tolerance: f64,
}

impl Default for Fidelity {
    fn default() -> Self {
        Self { level: FidelityLevel::default(), tolerance: default_tolerance() }
    }
}

fn default_tolerance() -> f64 {
    1e-2
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FidelityLevel {
    #[default]
    Full,
    /// Solids reduced to some tens of unknowns, with an error bound.
    Reduced,
    /// The cheapest level within the tolerance.
    Auto,
}

/// Largest number of threads of a unit.
pub const MOST_THREADS: usize = 1024;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Number of threads that a unit may use; results do not depend on it.
    #[serde(default)]
    #[schemars(transform = whole(0, MOST_THREADS as u32, "too many threads", "0 to 1024 (0 lets the program choose)")
        .otherwise("0: the program chooses"))]
    pub threads: usize,
    /// Time integration of the heat of solids: exact in time by modes, or inner steps by Newton's method.
    #[serde(default)]
    #[schemars(extend("otherwise" = "`auto`: modes wherever heat is linear"))]
    pub method: SolverMethod,
    /// Memory that the scene may use [B]; a scene with a larger forecast is refused.
    #[serde(default, deserialize_with = "super::whole::optional")]
    #[schemars(transform = within(1e6, 1e15, "B", "the memory of a scene").otherwise("all available memory"))]
    pub memory: Option<usize>,
}

/// Time integration of the heat of solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SolverMethod {
    /// Exact in time wherever constants and faces allow it, Newton's method elsewhere.
    #[default]
    Auto,
    /// Exact in time, by modes; refused where that is impossible.
    Modal,
    /// Inner steps by Newton's method, everywhere.
    Newton,
}

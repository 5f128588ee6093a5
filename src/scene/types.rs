use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::droplet::{Coupling, Droplet, Wall};
use super::materials::MaterialChoice;
use super::reservoir::Reservoir;
use crate::kernel::Kernel;
use crate::material::Material;

/// Everything that a `scene.toml` says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// FMI model name and identifier; a C identifier.
    pub name: String,
    /// One line for people.
    #[serde(default)]
    pub description: String,
    /// End of the default experiment [s].
    pub stop_time: f64,
    /// Communication step of the default experiment [s].
    pub step: f64,
    /// How the unit's variables are named.
    #[serde(default)]
    pub naming: Naming,
    /// Materials by name, for bodies and their layers.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// The bodies by name.
    pub body: BTreeMap<String, Body>,
    /// Loads on faces; their amounts become FMI inputs.
    #[serde(default)]
    pub load: Vec<Load>,
    /// Points whose values become FMI outputs.
    #[serde(default)]
    pub probe: Vec<Probe>,
    /// Grids of points whose values become arrays of FMI outputs.
    #[serde(default)]
    pub field: Vec<Field>,
    /// Walls below droplets; their temperatures become FMI inputs, what they get FMI outputs.
    #[serde(default)]
    pub wall: Vec<Wall>,
    /// Droplets on solids of the same scene.
    #[serde(default)]
    pub coupling: Vec<Coupling>,
    /// How much model the scene wants.
    #[serde(default)]
    pub fidelity: Fidelity,
    /// Settings of the solver that change cost but not results.
    #[serde(default)]
    pub solver: Solver,
}

/// Names of a unit's variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Naming {
    /// `spot.heat_flux[1,2]`
    #[default]
    Structured,
    /// `spot_heat_flux_1_2`, for tools that take nothing but identifiers.
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Body {
    /// A solid that conducts heat and deforms elastically.
    Solid(Box<Solid>),
    /// Drops of a fluid.
    Droplet(Droplet),
    /// What has one temperature.
    Reservoir(Reservoir),
}

/// A solid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    pub shape: Shape,
    /// What the body is made of, unless it has layers.
    pub material: Option<MaterialChoice>,
    /// From the top; together as thick as the shape.
    pub layers: Option<Vec<Layer>>,
    /// Uniform temperature at time zero [K].
    pub initial_temperature: f64,
    /// Temperature at which the body is free of thermal stress [K]; that at time zero if left out.
    pub stress_free_temperature: Option<f64>,
    /// Discretisation of the heat equation.
    #[serde(default)]
    pub heat: HeatMethod,
    /// How particles conduct heat; only with `heat = "sph"`.
    pub sph: Option<SphSettings>,
    #[serde(default)]
    pub symmetry: Symmetry,
    #[serde(default)]
    pub mesh: Mesh,
    /// Conditions on faces; a face that is left out is insulated and free.
    #[serde(default)]
    pub faces: BTreeMap<FaceName, Face>,
}

/// A layer of a body, which covers it from side to side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    pub material: MaterialChoice,
    /// [m]
    pub thickness: f64,
    /// Thermal resistance of the contact with the layer above [m² K/W]; perfect contact if left out.
    pub contact_resistance: Option<f64>,
}

/// The shape of a body. The origin is the centre of its top face; z points out of the body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// Extents along x, y and z [m].
    Box([f64; 3]),
    /// A round plate.
    Disc(Disc),
}

/// A round plate with its axis along z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// [m]
    pub radius: f64,
    /// [m]
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HeatMethod {
    /// Finite elements on the mesh of the mechanics.
    #[default]
    Fem,
    /// Smoothed particles on the nodes of the mesh.
    Sph,
}

/// How particles conduct heat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SphSettings {
    pub operator: SphOperator,
    pub kernel: Kernel,
    /// Support radius of the kernel in distances of particles.
    pub support: f64,
}

impl Default for SphSettings {
    fn default() -> Self {
        Self { operator: SphOperator::default(), kernel: Kernel::default(), support: 3.0 }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SphOperator {
    /// Exact for quadratics on any set of particles (Fatehi & Manzari 2011).
    #[default]
    Corrected,
    /// Conserves heat pair by pair; for equal distances (Cleary & Monaghan 1999).
    Plain,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Symmetry {
    /// Use whatever symmetry shape and faces have.
    #[default]
    Auto,
    /// Mesh the whole body (boxes only).
    None,
    /// Mesh a quarter of a box; loads of any place are split into parts even and odd about the two
    /// planes, so nothing is neglected.
    Quarter,
    /// Mesh a meridian section of a disc.
    Axisymmetric,
}

/// The mesh; whatever is left out is chosen from loads, material and the shorter of step and stop time.
///
/// It is fine where something acts: along x and y at loads and at sides that heat passes, along z
/// below tops and bottoms that are loaded or that heat passes, by whatever kind of condition.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Distance of nodes along x and y at loads and at heated sides [m], everywhere where there are
    /// neither.
    pub spacing: Option<f64>,
    /// Distance of nodes along z at loaded or heated faces [m], everywhere where there are none;
    /// `spacing` if only that is given.
    pub depth_spacing: Option<f64>,
    /// Ratio of the sizes of neighbouring elements away from there.
    pub growth: Option<f64>,
    /// Order of the shape functions: 1 (linear) or 2 (quadratic).
    pub order: Option<usize>,
}

impl Mesh {
    /// Fewest elements from the centre to a side, where elements may grow.
    pub const LATERAL_ELEMENTS: f64 = 12.0;
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Face {
    /// Prescribed temperature [K].
    pub temperature: Option<f64>,
    /// Prescribed uniform heat flux into the body [W/m²].
    pub flux: Option<f64>,
    pub convection: Option<Convection>,
    /// Beside a flux or convection, or alone.
    pub radiation: Option<Radiation>,
    /// No displacement at all.
    #[serde(default)]
    pub clamped: bool,
    /// No displacement along the normal.
    #[serde(default)]
    pub roller: bool,
}

/// Heat flux into the body `q = h (T∞ − T)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Heat transfer coefficient h [W/(m² K)].
    pub coefficient: f64,
    /// Ambient temperature T∞ [K].
    pub ambient: f64,
}

/// Heat flux into the body `q = ε σ (T∞⁴ − T⁴)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Emissivity ε [1].
    pub emissivity: f64,
    /// Temperature of the surroundings T∞ [K].
    pub ambient: f64,
}

/// Heat and traction on a part of a face.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    pub name: String,
    /// `BODY.top` or `BODY.bottom`.
    pub on: String,
    pub footprint: Footprint,
    pub carries: Vec<Carries>,
    #[serde(default)]
    pub start: LoadStart,
    /// Bounds of the inputs that move the footprint; the mesh is fine wherever they let it go.
    #[serde(default)]
    pub range: LoadRange,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Footprint {
    /// Uniform inside `radius` [m].
    Disc { radius: f64 },
    /// Peak value at the centre, 1/e² of it at `radius` [m].
    Gaussian { radius: f64 },
    /// Uniform between two radii [m].
    Ring { inner: f64, outer: f64 },
    /// `count` concentric rings of equal width out to `radius` [m], a value each.
    Rings { count: usize, radius: f64 },
    /// `count` rectangles over `size` [m], a value each.
    Tiles { count: [usize; 2], size: [f64; 2] },
}

/// Index ranges of a footprint of many values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellShape {
    Rings(usize),
    Tiles([usize; 2]),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Carries {
    /// Heat flux into the body [W/m²].
    HeatFlux,
    /// Pressure that acts into the body [Pa].
    Pressure,
    /// Shear traction [Pa]: along x and y; radial on rings.
    Shear,
}

/// Start values of a load's inputs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadStart {
    pub heat_flux: Option<CellValues>,
    pub pressure: Option<CellValues>,
    pub shear_x: Option<CellValues>,
    pub shear_y: Option<CellValues>,
    pub shear_r: Option<CellValues>,
    /// Place of the footprint's centre [m].
    pub x: Option<f64>,
    pub y: Option<f64>,
    /// Radius of round footprints [m]; the footprint's own if left out.
    pub radius: Option<f64>,
}

/// One value for all cells, or one for each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "a finite number, a list of them (rings) or a list of lists of them (tiles)"
)]
pub enum CellValues {
    Uniform(f64),
    Rings(Vec<f64>),
    /// Row i holds the values of the tiles `[i, 1]`, `[i, 2]` …
    Tiles(Vec<Vec<f64>>),
}

/// Bounds `[lowest, highest]` of the inputs that move a footprint [m].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadRange {
    pub x: Option<[f64; 2]>,
    pub y: Option<[f64; 2]>,
    pub radius: Option<[f64; 2]>,
}

/// A point whose values become outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    pub name: String,
    /// Name of the body.
    #[serde(rename = "in")]
    pub body: String,
    /// Place [m].
    pub at: [f64; 3],
    /// The side that is read of an interface between layers; above if left out.
    pub side: Option<Side>,
    pub gives: Vec<Gives>,
}

/// A side of an interface between layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    #[default]
    Above,
    Below,
}

/// Points on a regular grid, in the middle of equal cells, over a face or a plane section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    pub name: String,
    /// A face, `BODY.FACE`.
    pub on: Option<String>,
    /// A body, together with `plane`.
    #[serde(rename = "in")]
    pub body: Option<String>,
    pub plane: Option<Plane>,
    /// Number of points along the two axes of the face or section.
    pub grid: [usize; 2],
    /// Extent of the grid along its axes [m], centred; the whole face or section if left out.
    pub size: Option<[f64; 2]>,
    pub gives: Vec<Gives>,
}

/// A section through a body at a constant coordinate [m].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Plane {
    X(f64),
    Y(f64),
    Z(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gives {
    Temperature,
    /// The six components of the stress tensor and its von Mises value.
    Stress,
    VonMises,
    /// The largest principal stress, which opens cracks in brittle solids.
    MaxPrincipal,
    /// The three components.
    Displacement,
    /// Accumulated plastic strain, of bodies that yield.
    PlasticStrain,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fidelity {
    #[serde(default)]
    pub level: FidelityLevel,
    /// Relative.
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
}

impl Default for Fidelity {
    fn default() -> Self {
        Self { level: FidelityLevel::default(), tolerance: default_tolerance() }
    }
}

fn default_tolerance() -> f64 {
    1e-3
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FidelityLevel {
    #[default]
    Full,
    /// The cheapest level within the tolerance.
    Auto,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Threads a unit may use; 0 lets the program choose.
    #[serde(default)]
    pub threads: usize,
    /// How the heat of solids is advanced.
    #[serde(default)]
    pub method: SolverMethod,
}

/// How the heat of solids is advanced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SolverMethod {
    /// Exactly in time wherever constants and faces allow it, by Newton's method elsewhere.
    #[default]
    Auto,
    /// Exactly in time, by modes; refused where that cannot be.
    Modal,
    /// In steps that Newton's method solves, everywhere.
    Newton,
}

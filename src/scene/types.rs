//! Contents of a scene, and the types of which they are made.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::coupling::{Coupling, Wall};
use super::droplet::Droplet;
use super::filament::{Filament, Target};
use super::flaw::Flaw;
use super::large_strain::{LargeStrain, name_kind};
use super::lattice::Lattice;
use super::locate::Path;
use super::refinement::MeshFactors;
use super::reservoir::Reservoir;
use super::shorthand::NamedSubstance;
use crate::laws::Material;
use crate::limits::{tag, time};

pub use super::bath::Bath;
pub use super::face::{Convection, Face, FaceName, Radiation, Role};
pub use super::load::{Carries, CellShape, CellValues, Footprint, Load, LoadRange, LoadStart};
pub use super::notch::Notch;
pub use super::reading::{Field, Gives, Plane, Probe, Side};
pub use super::settings::{Fidelity, FidelityLevel, MOST_THREADS, Naming, Solver, SolverMethod};
pub use super::solid::{
    Disc, HeatMethod, Layer, Mesh, PeakOf, PlaneSection, Shape, Solid, SphOperator, SphSettings,
    Symmetry,
};

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
    /// ones, raise a warning that they may be in °C unless they are written so.
    #[serde(default, skip_serializing_if = "is_false")]
    #[schemars(extend("otherwise" = "false"))]
    pub cryogenic: bool,
    /// Substances of the library that the text names.
    #[serde(skip)]
    #[schemars(skip)]
    pub substances: Vec<NamedSubstance>,
    /// Temperatures that the text has in degrees Celsius or Fahrenheit [K].
    #[serde(skip)]
    #[schemars(skip)]
    pub in_degrees: BTreeMap<Path, f64>,
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
    /// Tables `[[wall]]`: walls below droplets and solids of large strain. Their temperatures become inputs; their heat
    /// and momentum become outputs.
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

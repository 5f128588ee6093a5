//! Settings of a whole scene: names of variables, tolerance and solver.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{whole, within};

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

//! Discretisations of solids of large strain, and their settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{above_zero, length, plausible, whole, within};

/// Discretisation of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mechanics {
    /// Finite elements.
    #[default]
    Fem,
    /// Reproducing kernels: cubic splines.
    Rkpm,
    /// The element-free Galerkin method: moving least squares with quartic splines.
    Efg,
    /// Total-Lagrangian smoothed particles: neighbours of the undeformed body, with corrected gradients.
    Sph,
}

impl Mechanics {
    /// The key of a scene.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Fem => "fem",
            Self::Rkpm => "rkpm",
            Self::Efg => "efg",
            Self::Sph => "sph",
        }
    }
}

/// Settings of smoothed particles of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleSettings {
    /// Radius of supports, in distances of particles.
    #[schemars(transform = within(1.5, 6.0, "distances of particles", "").says(
        "the support, in distances of particles, reaches too few or too many",
        "1.5 to 6",
    ))]
    pub support: f64,
}

impl Default for ParticleSettings {
    fn default() -> Self {
        Self { support: 2.2 }
    }
}

/// Settings of reproducing kernels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct KernelSettings {
    /// Order of the polynomials that the functions reproduce.
    #[schemars(transform = whole(1, 2, "no basis of this order", "1 (linear), 2 (quadratic)"))]
    pub basis: usize,
    /// Half of the width of supports, in distances of nodes.
    #[schemars(transform = within(1.0, 6.0, "distances of nodes", "").low_open().says(
        "the support, in distances of nodes, reaches too few or too many",
        "above `basis`, up to 6",
    ).otherwise("`basis` + 0.75"))]
    pub support: Option<f64>,
    /// Points at which the mechanics is integrated.
    pub integration: KernelIntegration,
    /// Radius over which gradients are averaged once more, a length of the material on which strain localises [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("the radius of smoothing")
        .plausible(&plausible::EXTENT)
        .condition("with `integration = \"nsni\"`, four distances of nodes or more")
        .otherwise("none"))]
    pub smoothing: Option<f64>,
}

impl Default for KernelSettings {
    fn default() -> Self {
        Self { basis: 1, support: None, integration: KernelIntegration::default(), smoothing: None }
    }
}

/// Integration of reproducing kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum KernelIntegration {
    /// Naturally stabilised: as exact as the basis, at a few points about each node.
    #[default]
    Nsni,
    /// Stabilised conforming: one point a node with the mean gradient of its cell; soft in bending.
    Scni,
    /// Gauss points of the cells between nodes; fails the patch test.
    Gauss,
}

/// Mesh of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LargeStrainMesh {
    /// Distance of nodes [m].
    #[schemars(transform = above_zero("m")
        .condition("up to the smallest extent")
        .otherwise("a tenth of the smallest extent; with `order = 2` a sixth"))]
    pub spacing: Option<f64>,
    /// Order of the shape functions: linear, or quadratic between nodes two distances apart.
    #[schemars(transform = whole(1, 2, "no shape functions of this order", "1 (linear), 2 (quadratic)")
        .condition("2 with `mechanics = \"fem\"`, without heat flow, on no part")
        .otherwise("1"))]
    pub order: Option<usize>,
}

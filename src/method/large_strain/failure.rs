//! Reasons why a body of large strain could not be advanced.

use crate::runtime::allowance::Halt;
use crate::space::Refused;

/// A step without physical meaning; the state is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error(
        "the material is turned inside out at x = {:.3e}, y = {:.3e}, z = {:.3e} m of its reference shape, where the volume would \
         become {dilatation:.3e} of what it was: the load is too large for this mesh (allowed: smaller loads or speeds, a \
         stiffer material, another `mesh.spacing`)", .at[0], .at[1], .at[2]
    )]
    Inverted { at: [f64; 3], dilatation: f64 },
    #[error(
        "the body would pass through its own plane of symmetry, or its axis, at x = {:.3e}, y = {:.3e}, z = {:.3e} m of its \
         reference shape (allowed: shorter communication steps, or inputs that change less in a step)",
        .at[0], .at[1], .at[2]
    )]
    Mirrored { at: [f64; 3] },
    #[error(
        "at {temperature} K the body would shrink to {stretch:.3} of its length (allowed: temperatures at which `expansion` \
         leaves it one)"
    )]
    Shrunk { temperature: f64, stretch: f64 },
    #[error("a displacement is not finite")]
    NotFinite,
    #[error(
        "no equilibrium was found: forces of {residual:.1e} of the largest remain unbalanced (allowed: shorter communication \
         steps, or loads that change less in a step)"
    )]
    NotConverged { residual: f64 },
    /// Without inertia, before it is known what was prescribed.
    #[error("no equilibrium was found: forces of {residual:.1e} of the largest remain unbalanced")]
    NoEquilibrium { residual: f64 },
    /// The same, with the inputs that change after the last equilibrium.
    #[error(
        "no equilibrium was found {change}, in the shortest part of the step: forces of {residual:.1e} of the largest \
         remain unbalanced. The body may have reached the largest load that it bears, buckle, or soften faster than its \
         own elasticity gives way (snap-back) (allowed: smaller values; `inertia = true` with `motion = \"implicit\"`, \
         as inertia carries a body over these)"
    )]
    NoEquilibriumThere { change: String, residual: f64 },
    #[error(
        "{energy:.1e} J of the body's energy would have no cause: its stress changes too much in a step (allowed: shorter \
         communication steps, or loads that change less in a step)"
    )]
    Unbalanced { energy: f64 },
    #[error(
        "the stiffness is singular: the body is held by too little, or has lost its stability (allowed: `clamped` or \
         `roller` faces that hold it, or `inertia = true`)"
    )]
    Singular,
    /// The nodes carry no functions.
    #[error(transparent)]
    Functions(#[from] Refused),
    #[error("{0}")]
    Halted(#[from] Halt),
}

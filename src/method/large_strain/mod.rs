//! Solids of large strain, in their reference configuration (total Lagrangian), on any [`Space`](crate::space::Space).
//!
//! Nodes have displacements u, points of the volume the deformation gradient `F = 1 + Σ u_I ⊗ ∇Ψ_I` with the functions
//! Ψ of the space. Internal forces `f_I = −Σ V P ∇Ψ_I` are the derivative of the stored energy, with P the first
//! Piola–Kirchhoff stress of the law. The points of a group share a dilatation, so that nearly incompressible bodies do
//! not lock. [`motion`] advances bodies with inertia, [`statics`] finds equilibria without.

mod contact;
mod friction;
mod course;
mod deformable;
mod dilatation;
mod eight_nodes;
mod element;
mod failure;
mod fragments;
mod heat;
mod implicit;
mod iteration;
mod load;
mod lower;
mod mirrors;
mod motion;
mod newton;
mod path;
mod pattern;
mod relaxation;
mod response;
mod state;
mod statics;
mod tangent;

pub use contact::{Plane, Spot, Touch};
pub use course::{Course, Courses};
pub use deformable::{Deformable, LayerOfBody, Stresses};
pub use failure::Failure;
pub use fragments::Fragments;
pub use friction::{Friction, Shear};
pub use heat::{
    Conduction, Contacts, Film, HEAT_STEPS, HEAT_WORK, HeatDrive, HeatOfLayer, Passed, Place,
    Warmth,
};
pub use implicit::{Drive, IMPLICIT_STEPS, IMPLICIT_WORK, ImplicitDynamics, Stepped};
pub use load::{FaceLoad, LoadedFaces, present_area};
pub use mirrors::through_mirror;
pub use motion::{Acting, CoursesOver, Dynamics};
pub use state::{Ledger, Motion};
pub use statics::{Conditions, Equilibrium, Found, Rest, STEPS, WORK};
pub use tangent::TOGETHER;

#[cfg(test)]
mod tests;

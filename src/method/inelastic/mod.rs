//! Quasi-static equilibrium of bodies with history-dependent stress, by Newton's method.
//!
//! Meshes and elements are those of [`crate::method::fem`], and so are displacements without yielding. The histories of
//! points are part of a flat state, which a step without equilibrium leaves unchanged.

mod element;
mod grid;
mod halves;
mod kept;
mod locking;
mod missed_flow;
mod newton;
mod nodal;
mod problem;
mod reading;
mod ring;
mod shapes;
mod substeps;
mod tangent;

pub use missed_flow::Look;
pub use newton::Progress;
pub use problem::{InelasticError, InelasticProblem, PointState, StateLayout};
pub use reading::NodalValues;
pub use substeps::Increment;
pub use tangent::{MOST_KEPT, MOST_POISSON};

//! Quasi-static equilibrium of bodies whose stress depends on what they went through, by Newton's method.
//!
//! Meshes and elements are those of [`crate::method::fem`]; where nothing yields, so are displacements. What points
//! remember is part of a flat state, and a step that finds no equilibrium leaves it as it was.

mod element;
mod grid;
mod locking;
mod newton;
mod nodal;
mod problem;
mod reading;
mod ring;
mod shapes;
mod substeps;
mod tangent;

pub use newton::Progress;
pub use problem::{InelasticError, InelasticProblem, PointState, StateLayout};
pub use reading::NodalValues;
pub use substeps::Increment;

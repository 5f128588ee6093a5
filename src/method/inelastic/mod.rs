//! Quasi-static equilibrium of bodies whose stress depends on what they went through, by Newton's method.
//!
//! Meshes and elements are those of [`crate::method::fem`]; where nothing yields, so are displacements. What points
//! remember is part of a flat state, and a step that finds no equilibrium leaves it as it was.

mod course;
mod element;
mod grid;
mod newton;
mod nodal;
mod problem;
mod remedy;
mod ring;
mod shapes;
mod tangent;

pub use course::Course;
pub use newton::Progress;
pub use problem::{InelasticError, InelasticProblem, PointState, StateLayout};

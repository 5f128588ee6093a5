//! Conduction of heat by smoothed particles in a solid at rest.
//!
//! The particles form a lattice and do not move. So the heat equation is one sparse matrix (`rows`, from `operators`),
//! with mirror images of the particles beyond the faces (`lattice`).

mod edges;
mod lattice;
pub mod operators;
mod problem;
mod rows;

pub use lattice::{End, LatticeAxis};
pub use problem::{Condition, Cost, Face, ParticleHeat, Setup, Sources};
pub use rows::{Lattice, Operator, Row, Settings};

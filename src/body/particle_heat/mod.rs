//! Conduction of heat by smoothed particles in a solid at rest.

pub mod operators;

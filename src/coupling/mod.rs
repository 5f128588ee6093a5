//! Transfer to and from faces that keeps integrals: what leaves one side arrives at the other.

mod footprint;
mod symmetry;

pub use footprint::{Pattern, Placement};
pub use symmetry::split_load;

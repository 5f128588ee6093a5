//! Transfer to and from faces that keeps integrals: what leaves one side arrives at the other.

mod footprint;
mod symmetry;
mod top_face;

pub use footprint::{Pattern, Placement};
pub use symmetry::split_load;
pub use top_face::TopFace;

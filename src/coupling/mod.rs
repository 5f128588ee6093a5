//! Conservative transfer to and from faces: the integral on one side equals that on the other.

mod face_cells;
mod face_means;
mod face_rings;
mod footprint;
mod symmetry;
mod transfer;

pub use face_cells::FaceCells;
pub use face_means::FaceMeans;
pub use face_rings::FaceRings;
pub use footprint::{Pattern, Placement};
pub use symmetry::split_load;
pub use transfer::Transfer;

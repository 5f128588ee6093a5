//! Transfer to and from faces that keeps integrals: what leaves one side arrives at the other.

mod common_cells;
mod face_cells;
mod face_means;
mod face_rings;
mod footprint;
mod lateral_modes;
mod symmetry;

pub use common_cells::CommonCells;
pub use face_cells::FaceCells;
pub use face_means::FaceMeans;
pub use face_rings::FaceRings;
pub use footprint::{Pattern, Placement};
pub use lateral_modes::LateralModes;
pub use symmetry::split_load;

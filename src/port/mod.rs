//! Where bodies meet: a face cut into cells, what passes through these, and how a face answers to it. Every kind of body
//! exchanges by these alone, whatever its method.

mod cells;
mod common_cells;
mod cover;
mod lateral_modes;
mod surface;

pub use cells::{Domain, WallCells, WallExchange};
pub use common_cells::CommonCells;
pub use cover::Cover;
pub use lateral_modes::LateralModes;
pub use surface::{CellHeat, Surface, SurfaceMemory, SurfaceResponse};

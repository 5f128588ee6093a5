//! Exchange between bodies: the cells of a face, the heat and momentum through these, and the
//! response of a face to heat. Bodies of every kind exchange through these alone, whatever their
//! method.

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

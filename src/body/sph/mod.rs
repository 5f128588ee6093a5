//! Droplets by weakly compressible smoothed particle hydrodynamics.
//!
//! The wall is the plane z = 0, the fluid lies above it. A plane model (two dimensions) lives in
//! x and z and counts everything per metre of depth along y.

mod droplet;
mod failure;
mod plan;
mod wall;

pub use droplet::{DropletSph, DropletTotals, ParticleFields};
pub use failure::Failure;
pub use plan::{DropletPlan, Fluid, Release, Wall};
pub use wall::{WallCells, WallExchange, WallShare};

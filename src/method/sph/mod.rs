//! Droplets by weakly compressible smoothed particle hydrodynamics.
//!
//! The wall is the plane z = 0; the fluid lies above it. A plane model (two dimensions) uses x and
//! z, and all its totals are per metre of depth along y. In an axisymmetric model particles are
//! rings about the z axis, see [`rings`]. Further planes and periods may bound a model; all of them
//! act by images of the particles.

mod acceptance;
mod arrest;
mod blue_noise;
mod candidates;
mod cloud;
mod contact_law;
mod continuity;
mod cooling;
mod dispatch;
mod droplet;
mod effort;
mod exposure;
mod failure;
mod feed;
mod field;
mod fractions;
mod free_surface;
mod freezing_curve;
mod freezing_flux;
mod freezing_law;
mod frozen;
mod grid;
mod images;
mod kick;
mod lanes;
mod loops;
mod lumps;
mod means;
mod method;
mod moment;
mod momentum;
mod neighbours;
mod order;
mod phases;
mod placement;
mod plan;
mod pulls;
mod requests;
mod resistive_law;
mod resting_heat;
mod rings;
mod shifting;
mod smoothing;
mod spread;
mod stepper;
mod tension;
mod units;
mod viscous;
mod wall_heat;
mod wall_points;

pub use crate::scene::Precision;
pub use cloud::UNKNOWNS;
pub use droplet::{DropletSph, DropletTotals, Laid, ParticleFields, WarmPlace};
pub use effort::{Effort, RunSettings};
pub use failure::Failure;
pub use method::StepShares;
pub use phases::Phases;
pub use plan::{
    Demand, DropletPlan, Extent, Feed, Fluid, Freezing, Placement, Release, Viscous, Wall,
};

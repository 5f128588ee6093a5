//! The bodies of a scene behind one interface: they start, advance, exchange and are read.
//!
//! Each kind of body is a folder. Only this module and `scene` distinguish kinds.

mod build;
mod contract;
mod droplet;
mod error;
mod exchanges;
mod filament;
mod lattice;
mod forecast;
mod large_strain;
mod link;
mod read;
mod reduced;
mod reservoir;
mod solid;
mod wall;

pub use build::{Assembly, Readings, build, reductions};
pub use contract::{
    Acts, Advice, Approach, Body, Conductor, Events, Fields, Given, Giver, Linear, Maxima, Memo,
    Occasion, Received, Resources, Structured,
};
pub use droplet::{
    Kept, fine_radius, forget_unused_records, keep_record, notes_on_walls, records, to_be_recorded,
    warnings_on_landing,
};
pub use error::BodyError;
pub use exchanges::ExchangeForecast;
pub use filament::{FilamentForecast, warnings_on_strands};
pub use forecast::{BodyForecast, DropletForecast, Forecast, Need, ParticleForecast, forecast};
pub use large_strain::{LargeStrainForecast, SmallTrials};
pub use lattice::LatticeForecast;
pub use link::{Joint, Link, MOST_PARTS, Side};
pub use read::{
    Descriptor, Direct, PeakPart, Reading, direct_of_point, flaw_quantities, peaks, totals,
};
pub use reduced::{KeptReduction, forget_unused_reductions, keep_reduction};
pub use solid::{PointQuantity, point_quantities};
pub use wall::{WallQuantity, wall_quantities};

pub use crate::method::fem::Extreme;
use build::threads_for;

//! Replayed drops: the heat and momentum of one drop are recorded over rings and time, from
//! particles or from closed forms, and applied again for each drop.
//!
//! The flow does not depend on temperatures, and heat conduction is linear. So the heat of a drop
//! is proportional to `T_drop − T_wall`, where T_wall is the temperature that the wall would have
//! without this drop. This is exact where T_wall is uniform, and approximate where other drops have
//! warmed the wall. Films that share a place transfer heat as one drop of their total volume does
//! (`sharing`), and none brings a place beyond its own temperature (`limit`): surplus heat stays in
//! the drop and is transferred later. Momentum is transferred as if each drop were alone.

mod bytes;
mod course;
mod film;
mod footprint;
mod footprints;
mod lateral;
mod limit;
mod profile;
mod recorder;
mod replay;
mod sharing;
mod state;
mod surface;
mod tail;

pub use course::{Course, turns_of_film};
pub use film::{Film, film_profile};
pub use profile::{Amounts, Profile};
pub use recorder::{Recorder, record_profile};
pub use replay::{Falling, NEAR, Replay, ReplayPlan, ReplayTotals};

//! Drops that are not computed anew: what one of them gives to a wall is known over rings and time, from particles or
//! from closed forms, and is given again for each drop.
//!
//! What flows does not depend on temperatures, and heat conduction is linear. So the heat that a drop gives is in
//! proportion to `T_drop − T_wall`, where T_wall is the temperature that the wall would have without this drop: to the
//! bit of the record where that is uniform, and approximately where other drops have warmed it. Films that share a place
//! give heat as one drop of all their volumes does (`sharing`), and none brings a place beyond its own temperature
//! (`limit`): heat that cannot be given stays in the drop and is given later. Momentum is given as if alone.

mod bytes;
mod course;
mod film;
mod footprint;
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

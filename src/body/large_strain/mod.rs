//! Solids of large strain: moving freely above a plane or another body, or in equilibrium under the displacements of
//! their faces.

mod forecast;
mod moving;
mod plan;
mod resting;
mod snapshot;
mod totals;

pub use forecast::{LargeStrainForecast, contact_interval};
pub use moving::MovingBody;
pub use plan::refinement;
pub use resting::RestingBody;
pub use totals::offered_totals;

use crate::body::Memo;
use snapshot::Snapshot;
use totals::Sums;

/// Memo of a solid of large strain: what is read of its state.
#[derive(Default)]
pub struct LargeStrainMemo(Option<(Snapshot, Sums)>);

impl LargeStrainMemo {
    fn of_mut(memo: &mut Memo) -> &mut Self {
        let memo: &mut (dyn std::any::Any + Send + Sync) = memo.as_mut();
        memo.downcast_mut().expect("a memo is that of the body that made it")
    }
}

/// Elements from which on more than one thread is worthwhile.
const POINTS_WORTH_THREADS: usize = 4_000;

/// Returns true if more than one thread is worthwhile.
fn is_large(points: usize) -> bool {
    points >= POINTS_WORTH_THREADS
}

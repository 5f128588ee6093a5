//! Solids of large strain: moving freely above a plane or another body by explicit steps, moving by implicit steps, or in
//! equilibrium under the displacements of their faces.

mod faces;
mod forecast;
mod moving;
mod plan;
mod probes;
mod resting;
mod snapshot;
mod swinging;
mod totals;

pub use forecast::{LargeStrainForecast, contact_interval};
pub use moving::MovingBody;
pub use plan::refinement;
pub use resting::RestingBody;
pub use swinging::SwingingBody;
pub use totals::offered_totals;

use crate::body::{BodyError, Memo, Reading};
use probes::Probed;
use snapshot::Snapshot;
use totals::Sums;

/// What is read of a state of a solid of large strain.
struct View {
    snapshot: Snapshot,
    sums: Sums,
    /// Forces on the faces that are moved [N].
    forces: Vec<[f64; 3]>,
    probed: Vec<Probed>,
}

impl View {
    fn read(&self, reading: &Reading) -> Result<f64, BodyError> {
        match *reading {
            Reading::Total(place) => Ok(match totals::force(place) {
                Some((face, axis)) => self.forces[face][axis],
                None => totals::read(&self.snapshot, &self.sums, place),
            }),
            Reading::Point { quantity, at, .. } => Probed::find(&self.probed, at, quantity),
            _ => Err(BodyError::NoSuchReading),
        }
    }
}

/// Memo of a solid of large strain with inertia: what is read of its state.
#[derive(Default)]
struct LargeStrainMemo(Option<View>);

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

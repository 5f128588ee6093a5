//! Solids of large strain: moving freely above a plane or another body by explicit steps, moving by implicit steps, or
//! in equilibrium under the displacements of their faces.

mod advised;
mod bends;
mod faces;
mod forecast;
mod moving;
mod plan;
mod probes;
mod relaxing;
mod resting;
mod snapshot;
mod swinging;
mod totals;
mod trials;
mod warming;

pub use forecast::{LargeStrainForecast, contact_interval};
pub use moving::MovingBody;
pub use plan::refinement;
pub use resting::RestingBody;
pub use swinging::SwingingBody;
pub use totals::offered_totals;
pub use trials::SmallTrials;

use crate::body::{BodyError, Reading};
use crate::method::large_strain::{Deformable, Failure, through_mirror};
use crate::warning::{self, Warning};
use probes::Probed;
use snapshot::Snapshot;
use totals::Sums;

/// Results of a state of a solid of large strain.
pub struct View {
    snapshot: Snapshot,
    sums: Sums,
    /// Forces on the faces that are held or moved [N].
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

/// Gives a failure the name of its body.
fn named(body: &str, failure: Failure) -> BodyError {
    let body = body.to_owned();
    match failure {
        Failure::Halted(halt) => BodyError::Halted { body, halt },
        failure => BodyError::LargeStrain { body, failure },
    }
}

/// Warns of nodes of a body that lie within its mirror image, from displacements of its nodes [m].
fn warning_on_mirrors(
    (name, body): (&str, &Deformable),
    displacement: &[[f64; 3]],
) -> Option<Warning> {
    let [x, y, z] = through_mirror(body, displacement)?;
    let finding = warning::body_is_through_its_mirror(format!("{x:.2e}, {y:.2e}, {z:.2e}"));
    Some(finding.at(name).whatever_its_numbers())
}

/// Elements from which on more than one thread is worthwhile.
const POINTS_WORTH_THREADS: usize = 4_000;

/// Returns true if more than one thread is worthwhile.
fn is_large(points: usize) -> bool {
    points >= POINTS_WORTH_THREADS
}

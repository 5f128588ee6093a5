//! Drops that are released on demand.

use super::DropletSph;
use crate::method::sph::cloud::{Cloud, cloud_of, flatten, ledger_of};
use crate::method::sph::failure::Failure;
use crate::method::sph::kick::FARTHEST;
use crate::method::sph::plan::{Demand, Release};
use crate::runtime::parallel::Team;
use crate::state::store;

/// Distance over Δx that particles have at least from the surface of a drop that starts.
const CLEARANCE: f64 = 0.5;
/// Part of the distance beyond which places are lost at which drops may start.
const NEAR: f64 = 0.5;

impl DropletSph {
    /// Drops asked for so far.
    pub fn asked(&self, state: &[f64]) -> f64 {
        ledger_of(state, self.head()).requests.map_or(0.0, |requests| requests.asked)
    }

    /// How far from the origin drops may start along each axis [m].
    pub fn farthest_start(&self) -> f64 {
        NEAR * FARTHEST * self.method.units.length
    }

    /// Asks for further drops, each like one that is given, and releases those that wait and whose places are free:
    /// no particle nearer to the drop than half a distance of particles, and no drop that waits for longer. All others
    /// go on waiting. A failure leaves the state as it was. Of more drops than there may be, the last are left out.
    ///
    /// # Panics
    /// If the plan has no drops on demand.
    pub fn ask(
        &self,
        state: &mut Vec<f64>,
        further: usize,
        release: &Release,
    ) -> Result<(), Failure> {
        let demand = self.plan.demand.as_ref().expect("a plan of drops on demand");
        let mut ledger = ledger_of(state, self.head());
        let mut requests = ledger.requests.take().expect("the state of drops on demand");
        let further = further.min(demand.most - (requests.asked as usize).min(demand.most));
        if further == 0 && requests.waiting(ledger.released) == 0 {
            return Ok(());
        }
        let mut drops = requests.drops(ledger.released, &demand.expected);
        drops.extend((0..further).map(|_| self.as_expected(release, demand)));
        requests.asked += further as f64;
        let mut cloud = cloud_of(state, self.head(), &Team::new(1));
        let before = cloud.len();
        let mut waiting: Vec<Release> = Vec::new();
        for drop in drops {
            if waiting.iter().all(|first| are_apart(first, &drop)) && self.is_free(&cloud, &drop) {
                self.add(&drop, &mut ledger, &mut cloud);
                ledger.released += 1.0;
            } else {
                waiting.push(drop);
            }
        }
        requests.wait(&waiting);
        ledger.requests = Some(requests);
        if cloud.len() == before {
            store(&mut ledger, state);
            return Ok(());
        }
        self.prime(&mut ledger, &mut cloud)?;
        flatten(state, &mut ledger, &mut cloud, &Team::new(1));
        Ok(())
    }

    /// All drops are as large, and start as high, as the plan expects.
    fn as_expected(&self, release: &Release, demand: &Demand) -> Release {
        let [x, y, _] = release.centre;
        let Release { time, centre: [_, _, z], diameter, .. } = demand.expected;
        Release { time, centre: [x, y, z], diameter, ..*release }
    }

    /// Whether there is no particle where a drop would start. Images at mirrors are as far from it as the particles
    /// themselves, as it stands on these.
    fn is_free(&self, cloud: &Cloud, drop: &Release) -> bool {
        let length = self.method.units.length;
        let radius = (0.5 * drop.diameter + CLEARANCE * self.plan.spacing) / length;
        let centre = drop.centre.map(|x| x / length);
        let is_apart = |x: &[f64; 3]| {
            let square: f64 = x.iter().zip(centre).map(|(x, c)| (x - c).powi(2)).sum();
            square >= radius * radius
        };
        cloud.position.iter().all(is_apart)
    }
}

/// Whether two drops do not overlap at their start.
fn are_apart(one: &Release, other: &Release) -> bool {
    let square: f64 = one.centre.iter().zip(other.centre).map(|(a, b)| (a - b).powi(2)).sum();
    square >= (0.5 * (one.diameter + other.diameter)).powi(2)
}

//! Drops that are released on demand.

use super::DropletSph;
use crate::method::sph::cloud::{Cloud, cloud_of, flatten, ledger_of};
use crate::method::sph::failure::Failure;
use crate::method::sph::kick::FARTHEST;
use crate::method::sph::plan::{Demand, Release};
use crate::runtime::parallel::Team;
use crate::state::store;

/// Smallest distance, over Δx, of particles from the surface of a drop that starts.
const CLEARANCE: f64 = 0.5;
/// Fraction of [`FARTHEST`] within which drops may start.
const NEAR: f64 = 0.5;

impl DropletSph {
    /// Number of drops requested so far.
    pub fn asked(&self, state: &[f64]) -> f64 {
        ledger_of(state, self.head()).requests.map_or(0.0, |requests| requests.asked)
    }

    /// Largest start coordinates of drops from the origin along each axis [m].
    pub fn farthest_start(&self) -> f64 {
        NEAR * FARTHEST * self.method.units.length
    }

    /// Requests further drops, each like `release`, and releases all waiting drops whose place is
    /// free. A place is free if no particle is nearer to the drop than half a particle distance,
    /// and no earlier waiting drop overlaps it. The other drops continue to wait. Requests beyond
    /// the largest number of drops are ignored. A failure leaves the state unchanged.
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

    /// The drop with the size and start height that the plan expects of all drops.
    fn as_expected(&self, release: &Release, demand: &Demand) -> Release {
        let [x, y, _] = release.centre;
        let Release { time, centre: [_, _, z], diameter, .. } = demand.expected;
        Release { time, centre: [x, y, z], diameter, ..*release }
    }

    /// Returns true if no particle occupies the start position of a drop. Images need no check: the
    /// drop stands on the mirrors, so they are as far from it as their originals.
    fn is_free(&self, cloud: &Cloud, drop: &Release) -> bool {
        self.is_apart(cloud, drop, CLEARANCE * self.plan.spacing)
    }

    /// Returns true if no particle is within a drop at its start: drops of a plan may touch there.
    pub(super) fn is_clear(&self, cloud: &Cloud, drop: &Release) -> bool {
        self.is_apart(cloud, drop, 0.0)
    }

    /// Returns true if no particle is nearer to the surface of a drop that starts than a distance [m], or within it.
    fn is_apart(&self, cloud: &Cloud, drop: &Release, distance: f64) -> bool {
        let length = self.method.units.length;
        let radius = (0.5 * drop.diameter + distance) / length;
        let centre = drop.centre.map(|x| x / length);
        let is_apart = |x: &[f64; 3]| {
            let square: f64 = x.iter().zip(centre).map(|(x, c)| (x - c).powi(2)).sum();
            square >= radius * radius
        };
        cloud.position.iter().all(is_apart)
    }
}

/// Returns true if two drops do not overlap at their start.
fn are_apart(one: &Release, other: &Release) -> bool {
    let square: f64 = one.centre.iter().zip(other.centre).map(|(a, b)| (a - b).powi(2)).sum();
    square >= (0.5 * (one.diameter + other.diameter)).powi(2)
}

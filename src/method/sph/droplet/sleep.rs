//! Fluid of a strand that rests, and takes no part in steps.
//!
//! Fluid with a yield stress comes to rest for good, and so does what freezes. In cubes as wide as the kernel reaches,
//! particles are awake up to two cubes from any that moves faster than a limit, bears more than its yield stress, or is
//! in the nozzle. Those up to four cubes away are held at rest: awake ones see all of their neighbours, and sound
//! pressures and fits besides. The others leave the cloud of a step, so that its cost follows what moves. Their weight
//! passes to the wall below them; their heat goes on, see [`resting`](super::resting).
//!
//! Places and speeds at the beginning of each part of a step decide which particles sleep, so that fluid which arrives
//! beside a sleeping strand wakes it.

use std::collections::HashSet;

use super::{DropletSph, Run};
use crate::method::sph::cloud::Cloud;
use crate::method::sph::feed::{ASLEEP, BY_NOZZLE, FREE};
use crate::method::sph::frozen::RIGID;

/// Speed below which fluid rests, over the expected fastest one.
const REST: f64 = 2e-3;
/// Stress over the yield stress up to which slow fluid rests: it falls towards the yield stress as fluid spreads.
const BORNE: f64 = 1.01;
/// Distance in cubes from fluid that moves, up to which fluid is awake, and up to which it is held in the cloud.
const AWAKE: i32 = 2;
const HELD: i32 = 4;

type Cube = [i32; 3];

impl DropletSph {
    /// Returns true if fluid of this plan comes to rest for good: it yields or freezes.
    fn may_sleep(&self) -> bool {
        self.method.flow.yield_stress() > 0.0 || self.method.phases.is_some()
    }

    /// Takes particles that rest out of the cloud of a run, while the others advance.
    pub(super) fn put_to_sleep(&self, run: &mut Run) -> Cloud {
        if !self.may_sleep() {
            return Cloud::none(self.head());
        }
        let cubes = self.moving_cubes(&run.cloud);
        let [awake, held] = [AWAKE, HELD].map(|reach| around(&cubes, reach));
        let (mut kept, mut others) = (Vec::new(), Vec::new());
        for i in 0..run.cloud.len() {
            let cube = cube(&run.cloud.position[i]);
            match held.contains(&cube) {
                true => kept.push(i as u32),
                false => others.push(i as u32),
            }
            if awake.contains(&cube) {
                wake(&mut run.cloud, i);
            } else {
                self.stop(run, i);
            }
        }
        if others.is_empty() {
            return Cloud::none(self.head());
        }
        run.cloud.keep(&kept, &others, &run.team)
    }

    /// Cubes that hold a particle which moves, one in the nozzle, or fluid that flows under its stress.
    fn moving_cubes(&self, cloud: &Cloud) -> HashSet<Cube> {
        let fastest = self.plan.feed.map_or(0.0, |feed| feed.fastest);
        let limit = REST * fastest / self.method.units.speed;
        let moves = |i: &usize| {
            let in_nozzle = cloud.origin.as_ref().is_some_and(|own| own.hold[*i] == BY_NOZZLE);
            let is_fast = cloud.velocity[*i].iter().map(|v| v * v).sum::<f64>() > limit * limit;
            in_nozzle || is_fast || self.flows(cloud, *i)
        };
        (0..cloud.len()).filter(moves).map(|i| cube(&cloud.position[i])).collect()
    }

    /// Returns true if a particle is not frozen, and has no yield stress or bears more than it.
    fn flows(&self, cloud: &Cloud, i: usize) -> bool {
        let content = cloud.contents()[i];
        let frozen = self.method.phases.map_or(0.0, |phases| phases.frozen(content));
        let borne = BORNE * self.method.flow.yield_stress();
        let stress = cloud.stress.as_ref().map_or([0.0; 6], |stresses| stresses[i]);
        let is_borne = borne > 0.0 && stress.iter().map(|s| s * s).sum::<f64>() <= borne * borne;
        !is_borne && frozen < RIGID
    }

    /// Stops a particle; the wall receives its momentum.
    fn stop(&self, run: &mut Run, i: usize) {
        let Run { cloud, points, .. } = run;
        let velocity = std::mem::take(&mut cloud.velocity[i]);
        if let Some(origin) = &mut cloud.origin {
            origin.hold[i] = ASLEEP;
        }
        let momentum = self.method.units.mass() * self.method.units.speed * cloud.mass[i];
        if let Some(points) = points.as_mut().filter(|_| velocity != [0.0; 3]) {
            points.push(self.method.place(cloud.position[i]), velocity.map(|v| momentum * v));
        }
    }

    /// Passes the weight of particles outside the cloud to the wall for a time [s].
    pub(super) fn weigh(&self, run: &mut Run, rest: &Cloud, duration: f64) {
        for (x, mass) in rest.position.iter().zip(&rest.mass) {
            let mass = self.method.units.mass() * mass;
            let impulse = self.plan.gravity.map(|g| mass * g * duration);
            let sum = &mut run.ledger.impulse_of_gravity;
            (0..3).for_each(|a| sum[a] += impulse[a]);
            if let Some(points) = &mut run.points {
                points.push(self.method.place(*x), impulse);
            }
        }
    }
}

fn wake(cloud: &mut Cloud, i: usize) {
    if let Some(origin) = &mut cloud.origin
        && origin.hold[i] == ASLEEP
    {
        origin.hold[i] = FREE;
    }
}

fn cube(x: &[f64; 3]) -> Cube {
    x.map(|x| x.floor() as i32)
}

/// Cubes within a number of cubes of some.
fn around(cubes: &HashSet<Cube>, reach: i32) -> HashSet<Cube> {
    let mut wider = cubes.clone();
    for axis in 0..3 {
        let along = |cube: &Cube| {
            let cube = *cube;
            (-reach..=reach).map(move |n| {
                let mut next = cube;
                next[axis] += n;
                next
            })
        };
        wider = wider.iter().flat_map(along).collect();
    }
    wider
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_around_one_fill_a_cube() {
        let wide = around(&HashSet::from([[3, -2, 0]]), 2);
        assert!(wide.len() == 125 && wide.contains(&[1, -4, 2]) && !wide.contains(&[0, -2, 0]));
    }
}

//! Frozen fluid in a step: free pieces move as rigid bodies, and what is bonded to the wall rests.

use super::{Stepper, acceleration};
use crate::method::sph::frozen::Moved;
use crate::method::sph::kick::{Motion, Times};

impl Stepper<'_, '_> {
    /// Positions and velocities of free pieces after a time without forces.
    pub(super) fn frozen_moved(&self, dt: f64) -> Vec<Moved> {
        match self.frozen.any_is_free() {
            true => self.frozen.bodies(self.cloud).moved(dt),
            false => Vec::new(),
        }
    }

    pub(super) fn place_frozen(&mut self, moved: &[Moved]) {
        for Moved { particle, position, velocity } in moved {
            self.cloud.position[*particle] = *position;
            self.cloud.velocity[*particle] = *velocity;
        }
    }

    /// Projects the velocities of free pieces onto rigid motions after a kick; returns the measures of the motion then.
    pub(super) fn make_rigid(&mut self, times: Times, kicked: Motion) -> Motion {
        let (cloud, gravity) = (&*self.cloud, self.method.gravity);
        let bodies = self.frozen.bodies(cloud);
        let accelerations = bodies.projected(|i| acceleration(cloud, i, times, gravity));
        for (i, velocity) in bodies.projected(|i| cloud.velocity[i]) {
            self.cloud.velocity[i] = velocity;
        }
        let mut motion =
            self.kick_particles(Times { dt: 0.0, tension: times.tension.map(|_| 0.0) });
        motion.sound &= kicked.sound;
        accelerations.into_iter().for_each(|(_, acceleration)| motion.accelerate(acceleration));
        motion
    }

    /// Adds the velocities that held particles have lost to those whose impulse the wall has not received yet.
    pub(super) fn note_stopped(&mut self, motion: &Motion) {
        if !motion.stopped.is_empty() {
            self.stopped.resize(self.cloud.len(), [0.0; 3]);
        }
        for &(i, velocity) in &motion.stopped {
            (0..3).for_each(|a| self.stopped[i][a] += velocity[a]);
        }
    }
}

//! Impulses that a step transfers to the wall, and that a nozzle gives.

use super::Stepper;

impl Stepper<'_, '_> {
    /// Transfers to the wall below them the impulses of forces on held particles; their pieces carry these there.
    pub(super) fn push_wall_by_stopped(&mut self) {
        let momentum = self.method.units.mass() * self.method.units.speed;
        let stopped = std::mem::take(&mut self.stopped);
        let Some(points) = &mut self.points else { return };
        for (i, velocity) in stopped.iter().enumerate().filter(|(_, v)| **v != [0.0; 3]) {
            let impulse = velocity.map(|v| momentum * self.cloud.mass[i] * v);
            points.push(self.method.place(self.cloud.position[i]), impulse);
        }
    }

    /// Notes momentum over its unit that the nozzle gives to the fluid.
    pub(super) fn push_by_nozzle(&mut self, given: [f64; 3]) {
        let unit = self.method.units.mass() * self.method.units.speed;
        let Some(fed) = &mut self.ledger.fed else { return };
        fed.impulse.iter_mut().zip(given).for_each(|(sum, given)| *sum += unit * given);
    }

    /// Transfers to the wall the reaction to all pending kicks of the particles that it pushes;
    /// nothing moved between these kicks.
    pub(super) fn push_wall(&mut self, pushed: &[usize]) {
        let (method, cloud) = (self.method, &*self.cloud);
        let kicks = std::mem::take(&mut self.pending_kicks);
        let dt: f64 = kicks.iter().map(|times| times.dt).sum();
        let turn: f64 = kicks.iter().filter_map(|times| times.tension).sum();
        let momentum = method.units.mass() * method.units.speed;
        let Some(points) = &mut self.points else { return };
        let pushes = self.team.map(pushed.len(), |k| {
            let i = pushed[k];
            let [x, y, z] = cloud.acceleration[i][1];
            let change = [dt * x, dt * y, dt * z + turn * cloud.tension[i][3]];
            let impulse = change.map(|v| -momentum * cloud.mass[i] * v);
            (method.place(cloud.position[i]), impulse)
        });
        pushes.into_iter().for_each(|(at, impulse)| points.push(at, impulse));
    }
}

//! Steps of droplets, and of the solids below them, which go along exchange by exchange.

use super::contact::Contact;
use super::droplets::{Below, DropletModel};
use super::interpolation::InputPath;
use super::{Model, ModelError, State};
use crate::math::allowance::Allowance;
use crate::math::thread::aside;

impl Model {
    /// Advances droplets by `dt` [s], and anew from `state` the solids that they are on.
    ///
    /// A droplet and a solid that are joined take turns: over each part of the step the droplet
    /// advances above the temperatures that the solid's surface had at its beginning, then the solid
    /// under the heat and force that the droplet gave during it, as constant rates. So all heat that
    /// leaves the one enters the other, and the time error is of first order in the parts. Inputs
    /// that change act with their values in the middle of a part.
    pub(super) fn advance_droplets(
        &self,
        path: &InputPath,
        state: &State,
        bodies: &mut [Vec<f64>],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        if self.droplets.is_empty() {
            return Ok(());
        }
        aside(|| self.advance_droplets_here(path, state, bodies, dt, allowance))
    }

    fn advance_droplets_here(
        &self,
        path: &InputPath,
        state: &State,
        bodies: &mut [Vec<f64>],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let (solids, droplets) = bodies.split_at_mut(self.bodies.len());
        for (droplet, unknowns) in self.droplets.iter().zip(droplets) {
            droplet.foresee(unknowns, dt, allowance)?;
            match &droplet.below {
                Below::Nothing => droplet.advance(unknowns, &[], dt, allowance)?,
                Below::Wall(wall) => {
                    // What acts is the middle, which may lie below both ends.
                    let inputs = path.at(0, 0.5 * dt);
                    self.check_underway(&inputs, 0.5 * dt)?;
                    self.check_underway(&path.at(0, dt), dt)?;
                    droplet.advance(unknowns, &inputs[wall.inputs.clone()], dt, allowance)?;
                }
                Below::Solid(contact) => {
                    let solid = &mut solids[contact.solid];
                    solid.clone_from(&state.bodies[contact.solid]);
                    let joined = (droplet, contact.as_ref());
                    self.advance_joined(joined, [unknowns, solid], (path, dt), allowance)?;
                }
            }
        }
        Ok(())
    }

    fn advance_joined(
        &self,
        (droplet, contact): (&DropletModel, &Contact),
        [fluid, solid]: [&mut Vec<f64>; 2],
        (path, dt): (&InputPath, f64),
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let body = &self.bodies[contact.solid];
        let halted = |halt| ModelError::Halted { body: body.name.clone(), halt };
        let parts = contact.parts(dt);
        let size = body.solid.state_len();
        allowance.foresee(parts as f64, "exchanges with a droplet", size).map_err(halted)?;
        let part = dt / parts as f64;
        for n in 0..parts {
            let inputs = path.at(0, (n as f64 + 0.5) * part);
            let loads = body.loads.assemble(&self.scene, &inputs, body.solid.mesh());
            let surface =
                contact.surface(&body.solid, solid, &loads, part, allowance).map_err(halted)?;
            let rises = droplet.advance_above(fluid, &surface, part, allowance)?;
            let exchange = droplet.droplet.exchange(fluid);
            let falling = surface.falling_parts(&exchange.heat, &rises, part);
            let loads = contact.loads_during(loads, &exchange, &falling, part);
            body.solid.advance(solid, &loads, part, allowance).map_err(halted)?;
        }
        Ok(())
    }
}

//! Steps of droplets, and of the solids below them, which go along exchange by exchange.

use super::contact::Contact;
use super::droplets::{Below, DropletModel};
use super::{Model, ModelError, State};

impl Model {
    /// The unknowns of all bodies after `dt` [s] under the state's inputs, held.
    ///
    /// A droplet and a solid that are joined take turns: over each part of the step the droplet
    /// advances above the temperatures that the solid's surface had at its beginning, then the solid
    /// under the heat and force that the droplet gave during it, as constant rates. So all heat that
    /// leaves the one enters the other, and the time error is of first order in the parts.
    pub(super) fn advanced(&self, state: &State, dt: f64) -> Result<Vec<Vec<f64>>, ModelError> {
        let mut bodies = state.bodies.clone();
        let (solids, droplets) = bodies.split_at_mut(self.bodies.len());
        let mut joined = vec![false; solids.len()];
        for (droplet, unknowns) in self.droplets.iter().zip(droplets) {
            match &droplet.below {
                Below::Nothing => droplet.advance(unknowns, &[], dt)?,
                Below::Wall(wall) => {
                    droplet.advance(unknowns, &state.inputs[wall.inputs.clone()], dt)?;
                }
                Below::Solid(contact) => {
                    joined[contact.solid] = true;
                    let pair = [unknowns, &mut solids[contact.solid]];
                    self.advance_joined((droplet, contact), pair, &state.inputs, dt)?;
                }
            }
        }
        for (index, body) in self.bodies.iter().enumerate().filter(|(i, _)| !joined[*i]) {
            let loads = body.loads.assemble(&self.scene, &state.inputs, body.solid.mesh());
            body.solid.advance(&mut solids[index], &loads, dt);
        }
        Ok(bodies)
    }

    fn advance_joined(
        &self,
        (droplet, contact): (&DropletModel, &Contact),
        [fluid, solid]: [&mut Vec<f64>; 2],
        inputs: &[f64],
        dt: f64,
    ) -> Result<(), ModelError> {
        let body = &self.bodies[contact.solid];
        let own = body.loads.assemble(&self.scene, inputs, body.solid.mesh());
        let parts = contact.parts(dt);
        let part = dt / parts as f64;
        for _ in 0..parts {
            let surface = contact.wall_temperature(&body.solid, solid, &own);
            droplet.advance(fluid, &surface, part)?;
            let mut loads = own.clone();
            contact.add(&mut loads, &droplet.droplet.exchange(fluid));
            body.solid.advance(solid, &loads, part);
        }
        Ok(())
    }
}

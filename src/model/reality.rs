//! What no run may come to: temperatures that cannot be, values that are no numbers, fluid that is lost over
//! an edge without a word.

use super::droplets::DropletModel;
use super::interpolation::InputPath;
use super::{Model, ModelError, State};

impl Model {
    /// Refuses temperatures of solids that are not above absolute zero. By the maximum principle only a
    /// flux out of a body takes it there, so nothing is computed where none acts.
    pub(super) fn check_temperatures(
        &self,
        (path, start): (&InputPath, &Vec<f64>),
        bodies: &[Vec<f64>],
        dt: f64,
    ) -> Result<(), ModelError> {
        let changed = (!path.is_held()).then(|| path.at(0, dt));
        let end = changed.as_ref().unwrap_or(start);
        for (body, unknowns) in self.bodies.iter().zip(bodies) {
            if !body.loads.draws_heat(start) && !body.loads.draws_heat(end) {
                continue;
            }
            let loads = body.loads.of_faces(end, body.solid.mesh());
            let temperatures = body.solid.temperatures(unknowns, &loads);
            let temperature = body.solid.min_temperature(&temperatures);
            if temperature <= 0.0 {
                return Err(ModelError::BelowAbsoluteZero { body: body.name.clone(), temperature });
            }
        }
        Ok(())
    }

    /// A sentence for each droplet that runs over the edge of the solid below it.
    pub fn overflows(&self, state: &State) -> Vec<String> {
        let droplets = self.droplets.iter().zip(&state.bodies[self.bodies.len()..]);
        let over = droplets.filter(|(droplet, unknowns)| droplet.overflows(unknowns));
        let sentence = |(droplet, _): (&DropletModel, _)| {
            format!(
                "{}: fluid lies beyond the edge of the solid; it gives no heat there, and its force, which \
                 does not act on the solid, is counted apart as force_outside",
                droplet.name
            )
        };
        over.map(sentence).collect()
    }

    /// A sentence for each droplet of which more than a little has come off.
    pub fn strays(&self, state: &State) -> Vec<String> {
        let droplets = self.droplets.iter().zip(&state.bodies[self.bodies.len()..]);
        let sentence = |(droplet, unknowns): (&DropletModel, &Vec<f64>)| {
            let totals = droplet.droplet.totals(unknowns);
            let part = totals.stray_mass / totals.mass;
            (part > MUCH_ASTRAY).then(|| {
                format!(
                    "{}: {:.0} % of the fluid have come off in small lumps (stray_mass): films thinner than some two \
                     particles break up, those of a smaller `spacing` later",
                    droplet.name,
                    100.0 * part
                )
            })
        };
        droplets.filter_map(sentence).collect()
    }
}

/// Part of the fluid that may come off without a word.
const MUCH_ASTRAY: f64 = 0.05;

/// Refuses what is no finite number.
pub(super) fn finite(value: f64) -> Result<f64, ModelError> {
    if value.is_finite() { Ok(value) } else { Err(ModelError::NotFinite(value)) }
}

//! How outputs change: with the inputs at one moment, and in time.
//!
//! Between steps a model is linear in its unknowns and in what acts on it, so a change of these goes
//! through the functions that give the outputs themselves; only von Mises and principal stresses and
//! the extremes of a body take the chain rule. Nothing is differenced.

use super::reality::finite;
use super::{Cache, Model, ModelError, State};
use crate::material::stress_rate::{max_principal_rate, von_mises_rate};
use crate::variables::{BodyTotal, Component, Output};

/// A change of unknowns and loads, with what follows from it.
#[derive(Debug, Default)]
pub struct Tangent {
    bodies: Vec<Vec<f64>>,
    cache: Cache,
    /// Whether unknowns change, too.
    in_time: bool,
}

impl Model {
    /// The change when the inputs change at `rates` while the unknowns stay.
    pub fn input_tangent(&self, state: &State, rates: &[f64]) -> Result<Tangent, ModelError> {
        self.check_inputs(&state.inputs)?;
        let loads = |body: &super::BodyModel| {
            body.loads.change(&self.scene, &state.inputs, rates, body.solid.mesh())
        };
        let bodies = state.bodies.iter().map(|unknowns| vec![0.0; unknowns.len()]).collect();
        let cache = Cache::of_loads(self.bodies.iter().map(loads).collect());
        Ok(Tangent { bodies, cache, in_time: false })
    }

    /// The time derivative under the present inputs and their first derivatives.
    pub fn time_tangent(&self, state: &State, cache: &mut Cache) -> Result<Tangent, ModelError> {
        let held = vec![0.0; state.inputs.len()];
        let mut tangent = self.input_tangent(state, state.derivatives.first().unwrap_or(&held))?;
        tangent.in_time = true;
        cache.meet(self, state);
        for (index, body) in self.bodies.iter().enumerate() {
            let (now, change) = (cache.loads(index), tangent.cache.loads(index));
            tangent.bodies[index] = body.solid.rates(&state.bodies[index], now, change);
        }
        Ok(tangent)
    }

    /// The change of an output. At kinks it is one-sided, in the direction of the change: where
    /// stress vanishes or principal stresses meet, and for extremes of a body, which follow the node
    /// that has the extreme, of several the fastest.
    pub fn output_rate(
        &self,
        state: &State,
        cache: &mut Cache,
        tangent: &mut Tangent,
        output: &Output,
    ) -> Result<f64, ModelError> {
        finite(self.computed_rate(state, cache, tangent, output)?)
    }

    fn computed_rate(
        &self,
        state: &State,
        cache: &mut Cache,
        tangent: &mut Tangent,
        output: &Output,
    ) -> Result<f64, ModelError> {
        cache.meet(self, state);
        match output {
            Output::Body { body, total } => {
                self.total_rate(state, cache, tangent, (self.place(body), *total))
            }
            // Between steps a droplet follows no input.
            Output::Droplet { .. } | Output::Wall { .. } if !tangent.in_time => Ok(0.0),
            Output::Droplet { .. } | Output::Wall { .. } => Err(ModelError::NoRate),
            Output::Probe { probe, component } => {
                let probe = &self.scene.probe[*probe];
                let (index, point) = (self.place(&probe.body), self.scene.point_of(probe));
                if *component == Component::Temperature {
                    let (unknowns, loads) = (&tangent.bodies[index], tangent.cache.loads(index));
                    return Ok(self.bodies[index].solid.rise_at(unknowns, loads, point));
                }
                self.component_rate(state, cache, tangent, (index, *component, point))
            }
            Output::Field { field, component, cell } => {
                let (body, _) = self.scene.field[*field].body_and_place();
                let point = self.grids[*field].point(cell[0], cell[1]);
                self.component_rate(state, cache, tangent, (self.place(body), *component, point))
            }
        }
    }

    fn component_rate(
        &self,
        state: &State,
        cache: &mut Cache,
        Tangent { bodies, cache: change, .. }: &mut Tangent,
        (index, component, point): (usize, Component, [f64; 3]),
    ) -> Result<f64, ModelError> {
        let solid = &self.bodies[index].solid;
        let measure = match component {
            Component::Temperature => {
                change.heat(self, bodies, index);
                return Ok(solid.rise_from(change.temperatures(index), point));
            }
            Component::VonMises => von_mises_rate,
            Component::MaxPrincipal => max_principal_rate,
            Component::Stress(_) | Component::Displacement(_) => {
                return self.component(bodies, change, index, component, point);
            }
        };
        cache.solve(self, &state.bodies, index)?;
        change.solve(self, bodies, index)?;
        Ok(measure(cache.stress_at(solid, index, point), change.stress_at(solid, index, point)))
    }

    fn total_rate(
        &self,
        state: &State,
        cache: &mut Cache,
        Tangent { bodies, cache: change, .. }: &mut Tangent,
        (index, total): (usize, BodyTotal),
    ) -> Result<f64, ModelError> {
        let solid = &self.bodies[index].solid;
        let unknowns = &bodies[index];
        Ok(match total {
            BodyTotal::HeatIn => solid.heat_totals(unknowns).brought_in,
            BodyTotal::HeatLost => solid.heat_totals(unknowns).lost,
            BodyTotal::HeatStored => solid.heat_stored(unknowns),
            BodyTotal::HeatDrift => solid.heat_drift(unknowns),
            BodyTotal::FallbackParticles => 0.0,
            BodyTotal::MaxTemperature => {
                cache.heat(self, &state.bodies, index);
                change.heat(self, bodies, index);
                solid.max_temperature_rate(cache.temperatures(index), change.temperatures(index))
            }
            BodyTotal::MaxVonMises | BodyTotal::MaxPrincipal => {
                cache.solve(self, &state.bodies, index)?;
                change.solve(self, bodies, index)?;
                let [von_mises, principal] = solid.max_stress_rate(
                    (cache.temperatures(index), cache.deformation(index)),
                    (change.temperatures(index), change.deformation(index)),
                );
                if total == BodyTotal::MaxVonMises { von_mises } else { principal }
            }
        })
    }
}

use super::droplets::{Below, DropletCache};
use super::{Model, ModelError, State};
use crate::method::fem::{Deformation, SolidFem, SolidLoads, Temperatures};

/// Values derived from one state, computed when first asked for. Clear it when the state changes;
/// changed inputs are noticed.
#[derive(Debug, Default)]
pub struct Cache {
    inputs: Vec<f64>,
    bodies: Vec<BodyCache>,
    droplets: Vec<DropletCache>,
}

#[derive(Debug, Default)]
struct BodyCache {
    /// Depend on the inputs, and on the unknowns where a droplet is on the body.
    loads: SolidLoads,
    temperatures: Option<Temperatures>,
    deformation: Option<Deformation>,
    max_temperature: Option<f64>,
    max_stress: Option<[f64; 2]>,
    /// The last point asked for: its components are read one after another.
    stress: Option<([f64; 3], [f64; 6])>,
}

impl Cache {
    /// Forgets all that depends on the unknowns.
    pub fn clear(&mut self) {
        if !self.droplets.is_empty() {
            *self = Self::default();
        }
        for body in &mut self.bodies {
            let loads = std::mem::take(&mut body.loads);
            *body = BodyCache { loads, ..Default::default() };
        }
    }

    /// Brings the loads up to date with the inputs and with what droplets gave last.
    pub(super) fn meet(&mut self, model: &Model, state: &State) {
        let inputs = &state.inputs;
        let sizes = [self.bodies.len(), self.droplets.len()];
        if self.inputs == *inputs && sizes == [model.bodies.len(), model.droplets.len()] {
            return;
        }
        self.inputs = inputs.to_vec();
        let loads =
            |body: &super::BodyModel| body.loads.assemble(&model.scene, inputs, body.solid.mesh());
        let fresh = |body| BodyCache { loads: loads(body), ..Default::default() };
        self.bodies = model.bodies.iter().map(fresh).collect();
        self.droplets = model.droplets.iter().map(|_| DropletCache::default()).collect();
        for (droplet, unknowns) in model.droplets.iter().zip(&state.bodies[model.bodies.len()..]) {
            if let Below::Solid(contact) = &droplet.below {
                let loads = &mut self.bodies[contact.solid].loads;
                contact.add(loads, &droplet.droplet.exchange(unknowns));
            }
        }
    }

    pub(super) fn droplet(&mut self, index: usize) -> &mut DropletCache {
        &mut self.droplets[index]
    }

    /// A cache for loads that follow from no inputs: a change of loads, a list entry a body.
    pub(super) fn of_loads(loads: Vec<SolidLoads>) -> Self {
        let fresh = |loads| BodyCache { loads, ..Default::default() };
        let bodies = loads.into_iter().map(fresh).collect();
        Self { inputs: Vec::new(), bodies, droplets: Vec::new() }
    }

    /// Makes sure that a body's nodal temperatures are known; `unknowns` are those of all bodies.
    pub(super) fn heat(&mut self, model: &Model, unknowns: &[Vec<f64>], index: usize) {
        let body = &mut self.bodies[index];
        if body.temperatures.is_none() {
            let solid = &model.bodies[index].solid;
            body.temperatures = Some(solid.temperatures(&unknowns[index], &body.loads));
        }
    }

    /// Makes sure that a body's temperatures and deformation are known.
    pub(super) fn solve(
        &mut self,
        model: &Model,
        unknowns: &[Vec<f64>],
        index: usize,
    ) -> Result<(), ModelError> {
        self.heat(model, unknowns, index);
        let body = &mut self.bodies[index];
        if body.deformation.is_none() {
            let solid = &model.bodies[index].solid;
            let temperatures = body.temperatures.as_ref().expect("just computed");
            body.deformation = Some(solid.deformation(temperatures, &body.loads)?);
        }
        Ok(())
    }

    /// Whether stresses of a body need but be looked up.
    pub(super) fn is_solved(&self, index: usize) -> bool {
        self.bodies.get(index).is_some_and(|body| body.deformation.is_some())
    }

    /// Whether the highest stresses of a body are known.
    pub(super) fn has_max_stress(&self, index: usize) -> bool {
        self.bodies.get(index).is_some_and(|body| body.max_stress.is_some())
    }

    pub(super) fn loads(&self, index: usize) -> &SolidLoads {
        &self.bodies[index].loads
    }

    pub(super) fn temperatures(&self, index: usize) -> &Temperatures {
        self.bodies[index].temperatures.as_ref().expect("asked for after `heat`")
    }

    pub(super) fn deformation(&self, index: usize) -> &Deformation {
        self.bodies[index].deformation.as_ref().expect("asked for after `solve`")
    }

    pub(super) fn max_temperature(&mut self, solid: &SolidFem, index: usize) -> f64 {
        let known = self.bodies[index].max_temperature;
        let value = known.unwrap_or_else(|| solid.max_temperature(self.temperatures(index)));
        self.bodies[index].max_temperature = Some(value);
        value
    }

    /// Highest von Mises and largest principal stress.
    pub(super) fn max_stress(&mut self, solid: &SolidFem, index: usize) -> [f64; 2] {
        let known = self.bodies[index].max_stress;
        let compute = || solid.max_stress(self.temperatures(index), self.deformation(index));
        let value = known.unwrap_or_else(compute);
        self.bodies[index].max_stress = Some(value);
        value
    }

    pub(super) fn stress_at(
        &mut self,
        solid: &SolidFem,
        index: usize,
        point: [f64; 3],
    ) -> [f64; 6] {
        if let Some((place, stress)) = self.bodies[index].stress
            && place == point
        {
            return stress;
        }
        let stress = solid.stress_at(self.temperatures(index), self.deformation(index), point);
        self.bodies[index].stress = Some((point, stress));
        stress
    }
}

//! Stress and plastic strain of bodies with history-dependent stress, from nodal values.
//!
//! Plastic strain and back strain are interpolated linearly between neighbouring nodes, so they stay within the range
//! there. Stress follows the shape functions, and then returns to the yield surface at the local plastic strain and
//! temperature. Once a part of the body has yielded, stress never exceeds the largest nodal values, which are those of
//! the whole body.

use super::{SolidFem, Temperatures, Weights, weighted};
use crate::laws::stress::{max_principal, von_mises};
use crate::laws::{FlowLaw, Overstress, admissible};
use crate::method::mesh::Axis;

/// Stress at the nodes, listed twice on interfaces, even about planes of symmetry.
#[derive(Debug, Clone)]
pub struct Remembered {
    /// xx, yy, zz, xy, yz, xz, of a section rr, tt, zz, 0, 0, rz [Pa].
    pub stress: Vec<[f64; 6]>,
    /// `None` if the body does not yield.
    pub flow: Option<NodalFlow>,
}

/// Traces of plastic flow at the nodes.
#[derive(Debug, Clone)]
pub struct NodalFlow {
    /// Accumulated plastic strain [1].
    pub plastic_strain: Vec<f64>,
    /// Strain that determines the back stress, with engineering shears [1].
    pub back_strain: Vec<[f64; 6]>,
    /// Bounds of von Mises and largest principal stress between nodes [Pa]: the largest of all nodes.
    pub most: [f64; 2],
}

impl Remembered {
    /// Stress of a body that never yields.
    pub fn elastic(stress: Vec<[f64; 6]>) -> Self {
        Self { stress, flow: None }
    }

    /// Stress of a body that yields, with its plastic strain and back strain.
    pub fn flowing(
        stress: Vec<[f64; 6]>,
        plastic_strain: Vec<f64>,
        back_strain: Vec<[f64; 6]>,
    ) -> Self {
        let most = |measure: fn([f64; 6]) -> f64| {
            stress.iter().map(|own| measure(*own)).fold(f64::NEG_INFINITY, f64::max)
        };
        let most = match plastic_strain.iter().any(|&strain| strain > 0.0) {
            true => [most(von_mises), most(max_principal)],
            // Not yielded yet: interpolation between nodes is as in elasticity.
            false => [f64::INFINITY; 2],
        };
        Self { stress, flow: Some(NodalFlow { plastic_strain, back_strain, most }) }
    }
}

impl SolidFem {
    /// Stress at a place of the mesh, in its own components [Pa].
    pub(super) fn remembered_at(
        &self,
        remembered: &Remembered,
        temperatures: &Temperatures,
        place: [f64; 3],
    ) -> [f64; 6] {
        let nodes = self.sided_weights(place);
        let stress = self.tensor_at(&remembered.stress, &nodes);
        let Some(flow) = &remembered.flow else { return stress };
        let Some(law) = self.flow_law_at(place[2]) else { return stress };
        let rise = temperatures.first().map_or(0.0, |field| {
            weighted(field, nodes.each_ref(), self.mesh.sided_counts(), (0, 1))
        });
        let temperature = self.initial_temperature + self.stress_free_rise + rise;
        let Some(own) = law.over_step(temperature, 0.0) else { return stress };
        let neighbours = self.neighbours(place);
        let radius = match own.overstress {
            Overstress::NONE => own.radius(self.plastic_strain_of(flow, &neighbours)),
            // A creeping material has no yield surface that limits stress.
            _ => f64::INFINITY,
        };
        let back = own.back_stress(&self.tensor_at(&flow.back_strain, &neighbours));
        let face = self.free_faces.normal_at(place);
        capped(admissible(stress, &back, radius, face), flow.most)
    }

    /// Accumulated plastic strain at a place of the mesh [1].
    pub(super) fn flowed_at(&self, flow: &NodalFlow, place: [f64; 3]) -> f64 {
        self.plastic_strain_of(flow, &self.neighbours(place))
    }

    fn plastic_strain_of(&self, flow: &NodalFlow, neighbours: &[Weights; 3]) -> f64 {
        weighted(&flow.plastic_strain, neighbours.each_ref(), self.mesh.sided_counts(), (0, 1))
    }

    /// Weights of the two nodes beside a place along each axis.
    fn neighbours(&self, place: [f64; 3]) -> [Weights; 3] {
        let [x, y, z] = self.sided_weights(place);
        let along_z: Vec<f64> =
            self.nodes_of_sided.iter().map(|&node| self.mesh.axes[2].nodes[node]).collect();
        let [columns, rows] = [0, 1].map(|axis: usize| &self.mesh.axes[axis].nodes);
        [linear(columns, x, place[0]), linear(rows, y, place[1]), linear(&along_z, z, place[2])]
    }

    /// The law of flow at a height; on interfaces that of the layer above.
    fn flow_law_at(&self, z: f64) -> Option<&dyn FlowLaw> {
        self.flow_laws.get(self.element_at(z)).map(|law| &**law)
    }

    /// Number of the element at a height; on interfaces that of the layer above.
    pub(super) fn element_at(&self, z: f64) -> usize {
        let axis: &Axis = &self.mesh.axes[2];
        axis.shape_at(z).first / axis.order
    }

    fn tensor_at(&self, field: &[[f64; 6]], nodes: &[Weights; 3]) -> [f64; 6] {
        let (field, counts) = (field.as_flattened(), self.mesh.sided_counts());
        std::array::from_fn(|slot| weighted(field, nodes.each_ref(), counts, (slot, 6)))
    }
}

/// Returns a stress whose von Mises and largest principal stress are at most those given [Pa]; interpolation between
/// nodes exceeds these slightly.
fn capped(mut stress: [f64; 6], [shape, tension]: [f64; 2]) -> [f64; 6] {
    let found = von_mises(stress);
    if found > shape {
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        for (slot, value) in stress.iter_mut().enumerate() {
            let mean = if slot < 3 { mean } else { 0.0 };
            *value = mean + (*value - mean) * shape / found;
        }
    }
    let off = max_principal(stress) - tension;
    if off > 0.0 {
        stress[..3].iter_mut().for_each(|value| *value -= off);
    }
    stress
}

/// Weights of the two neighbouring nodes at a place, among the nodes of an element.
fn linear(nodes: &[f64], of_element: Weights, place: f64) -> Weights {
    let Weights { first, values } = of_element;
    if values.len() < 3 {
        return Weights { first, values };
    }
    let own = &nodes[first..first + values.len()];
    let low = usize::from(place > own[1]);
    let part = ((place - own[low]) / (own[low + 1] - own[low])).clamp(0.0, 1.0);
    Weights { first: first + low, values: vec![1.0 - part, part] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capped_stress_has_the_largest_measures_that_there_are() {
        let stress = [120.0, -40.0, 30.0, 20.0, -10.0, 5.0];
        let measures = [von_mises(stress), max_principal(stress)];
        assert_eq!(capped(stress, measures), stress);
        for most in [[100.0, 500.0], [500.0, 100.0], [100.0, 80.0]] {
            let found = capped(stress, most);
            let found = [von_mises(found), max_principal(found)];
            for (found, (most, before)) in found.iter().zip(most.iter().zip(measures)) {
                assert!(*found <= most.min(before) * (1.0 + 1e-12), "{found} {most}");
            }
        }
    }

    #[test]
    fn weights_between_neighbours_reach_from_node_to_node() {
        let nodes = [0.0, 1.0, 2.0, 4.0, 6.0];
        let of_element = || Weights { first: 2, values: vec![0.1, 0.8, 0.1] };
        for (place, first, wanted) in
            [(3.0, 2, [0.5, 0.5]), (5.5, 3, [0.25, 0.75]), (4.0, 2, [0.0, 1.0])]
        {
            let found = linear(&nodes, of_element(), place);
            assert_eq!((found.first, found.values), (first, wanted.to_vec()));
        }
    }
}

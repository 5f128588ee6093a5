//! Stress and plastic strain at the nodes, within the law of the body.
//!
//! Stress recovered at nodes may exceed the values at the points; it is returned to the limit of the law there. Plastic
//! strain is between zero and the largest value of the points around a node, and the back strain is no longer than the
//! accumulated plastic strain allows. Stress returns to the yield surface at the plastic strain and temperature of the
//! node. In a creeping body stress may exceed that surface, but an excess relaxes by flow: a difference δq between two
//! points decays as `e^{−3G n p/q}` while the strain p accumulates under the stress q. At a node this factor is
//! therefore applied to the part of the stress that would flow faster than the fastest point around it.

use super::problem::{InelasticError, InelasticProblem, PointState};
use crate::laws::{Overstress, PlasticHistory, PointConstants, admissible};
use crate::method::fem::Mesh;
use crate::runtime::parallel::Team;

/// Values at the nodes, with nodes on interfaces between layers listed twice.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalValues {
    /// xx, yy, zz, xy, yz, xz, of a section rr, tt, zz, 0, 0, rz [Pa].
    pub stress: Vec<[f64; 6]>,
    /// Accumulated plastic strain [1].
    pub plastic_strain: Vec<f64>,
    /// Strain that determines the back stress, with engineering shears [1].
    pub back_strain: Vec<[f64; 6]>,
}

/// Slots of the stresses on an interface: zz, yz, xz.
const TRACTION: [usize; 3] = [2, 4, 5];
/// `√(3/2)`
const ROOT: f64 = 1.224_744_871_391_589;
/// Time over which flow rates are compared [s].
const UNIT_TIME: f64 = 1.0;

impl InelasticProblem {
    /// Computes stress and history at the nodes of a state at nodal temperatures [K].
    pub fn nodal_values(
        &self,
        state: &[f64],
        temperatures: &[f64],
    ) -> Result<NodalValues, InelasticError> {
        let points = self.points(state, temperatures)?;
        let mut stress = self.recover_tensor(points.iter().map(|point| point.stress).collect());
        self.join_tractions(&mut stress, temperatures)?;
        let plastic_strain = self.nodal_plastic_strain(&points);
        let back_strain = self.nodal_back_strain(&points, &plastic_strain);
        let mut values = NodalValues { stress, plastic_strain, back_strain };
        let fastest = self.fastest_around(&points, temperatures)?;
        let plane = self.mesh.axes[0].len() * self.mesh.axes[1].len();
        let levels = self.mesh.nodes_of_sided();
        let mut number = 0;
        for layer in 0..self.mesh.layering.count() {
            let element = self.mesh.layer_elements(layer).start;
            for _ in 0..self.mesh.layer_axis(layer).len() * plane {
                let node = levels[number / plane] * plane + number % plane;
                let temperature = temperatures[node];
                let own = self.constants_at(element, temperature)?;
                let face = self.free_faces.normal_at(self.place_of_node(node));
                let fastest = fastest.get(number).copied().unwrap_or(f64::NEG_INFINITY);
                values.keep_within(&own, number, fastest, face);
                number += 1;
            }
        }
        Ok(values)
    }

    /// Constants of an element's law at a temperature [K].
    fn constants_at(
        &self,
        element: usize,
        temperature: f64,
    ) -> Result<PointConstants, InelasticError> {
        let own = self.law(element).over_step(temperature, UNIT_TIME);
        own.ok_or(InelasticError::Constants { layer: element, temperature })
    }

    /// Gives both sides of interfaces the traction that they share, averaged with their compliances as weights: as the
    /// small difference of large stresses it is less accurate in the stiffer layer.
    fn join_tractions(
        &self,
        stress: &mut [[f64; 6]],
        temperatures: &[f64],
    ) -> Result<(), InelasticError> {
        let plane = self.mesh.axes[0].len() * self.mesh.axes[1].len();
        let levels = self.mesh.nodes_of_sided();
        let mut level = 0;
        for layer in 1..self.mesh.layering.count() {
            level += self.mesh.layer_axis(layer - 1).len();
            let [below, above] = [layer - 1, layer].map(|own| self.mesh.layer_elements(own).start);
            for i in 0..plane {
                let temperature = temperatures[levels[level] * plane + i];
                let below = traction_moduli(&self.constants_at(below, temperature)?);
                let above = traction_moduli(&self.constants_at(above, temperature)?);
                let [low, high] = [level - 1, level].map(|level| level * plane + i);
                for (slot, (below, above)) in TRACTION.into_iter().zip(below.into_iter().zip(above))
                {
                    let share = below / (below + above);
                    let mean = (1.0 - share) * stress[low][slot] + share * stress[high][slot];
                    (stress[low][slot], stress[high][slot]) = (mean, mean);
                }
            }
        }
        Ok(())
    }

    fn place_of_node(&self, node: usize) -> [f64; 3] {
        let [nx, ny, _] = self.mesh.node_counts();
        let at = [node % nx, node / nx % ny, node / (nx * ny)];
        [0, 1, 2].map(|axis: usize| self.mesh.axes[axis].nodes[at[axis]])
    }

    fn nodal_plastic_strain(&self, points: &[PointState]) -> Vec<f64> {
        let values: Vec<f64> = points.iter().map(|point| point.history.accumulated).collect();
        if values.iter().all(|&value| value == 0.0) {
            return vec![0.0; self.mesh.sided_nodes()];
        }
        let largest = largest_around(&self.mesh, &values);
        let recovered = self.recover_scalar(&values).into_iter().zip(largest);
        recovered.map(|(value, largest)| value.clamp(0.0, largest)).collect()
    }

    /// The back strain, whose length is at most `√(3/2) p`.
    fn nodal_back_strain(&self, points: &[PointState], plastic_strain: &[f64]) -> Vec<[f64; 6]> {
        let values: Vec<[f64; 6]> = points.iter().map(|point| point.history.back_strain).collect();
        if values.iter().flatten().all(|&value| value == 0.0) {
            return vec![[0.0; 6]; self.mesh.sided_nodes()];
        }
        let limited = |(strain, path): ([f64; 6], &f64)| {
            let length = length(&strain);
            let most = ROOT * path;
            if length > most { strain.map(|value| value * most / length) } else { strain }
        };
        self.recover_tensor(values).into_iter().zip(plastic_strain).map(limited).collect()
    }

    /// Logarithms of the fastest flow of the points around each node; empty without creep.
    fn fastest_around(
        &self,
        points: &[PointState],
        temperatures: &[f64],
    ) -> Result<Vec<f64>, InelasticError> {
        if !self.creeps() {
            return Ok(Vec::new());
        }
        let constants = self.constants(temperatures, UNIT_TIME, &Team::new(1))?;
        let rate = |(point, own): (&PointState, &PointConstants)| {
            own.overstress.logarithm_of_flow(own.beyond_yield(&point.stress, &point.history))
        };
        let rates: Vec<f64> = points.iter().zip(&constants).map(rate).collect();
        Ok(largest_around(&self.mesh, &rates))
    }
}

impl NodalValues {
    /// Returns the stress of a node to the limit of the law, on a free face with a normal.
    fn keep_within(
        &mut self,
        own: &PointConstants,
        number: usize,
        fastest: f64,
        face: Option<usize>,
    ) {
        let (stress, back_strain) = (&mut self.stress[number], self.back_strain[number]);
        let accumulated = self.plastic_strain[number];
        let history = PlasticHistory { back_strain, accumulated, ..PlasticHistory::default() };
        let mut radius = own.radius(accumulated);
        if own.overstress != Overstress::NONE {
            let beyond = own.beyond_yield(stress, &history).max(0.0);
            let around = own.overstress.of_flow(fastest).min(beyond);
            let relaxed = 3.0 * own.shear * own.overstress.exponent_at(beyond) * accumulated
                / (ROOT * beyond);
            radius +=
                around + if beyond > around { (beyond - around) * (-relaxed).exp() } else { 0.0 };
        }
        *stress = admissible(*stress, &own.back_stress(&back_strain), radius, face);
    }
}

/// Moduli of the stresses on an interface [Pa].
fn traction_moduli(own: &PointConstants) -> [f64; 3] {
    [own.bulk + 4.0 / 3.0 * own.shear, own.shear, own.shear]
}

/// Length of a strain with engineering shears.
fn length(strain: &[f64; 6]) -> f64 {
    let squares = |from: &[f64]| from.iter().map(|value| value * value).sum::<f64>();
    (squares(&strain[..3]) + 0.5 * squares(&strain[3..])).sqrt()
}

/// Largest value of all points of the elements that meet at each node, layer by layer.
fn largest_around(mesh: &Mesh, values: &[f64]) -> Vec<f64> {
    let [nx, ny, nz] = mesh.element_counts().map(|count| count.max(1));
    let points = values.len() / (nx * ny * nz);
    let of_elements: Vec<f64> = values
        .chunks_exact(points)
        .map(|values| values.iter().fold(f64::NEG_INFINITY, |most, value| most.max(*value)))
        .collect();
    let [columns, rows, _] = mesh.node_counts();
    let (order, mut out) = (mesh.order(), Vec::new());
    for layer in 0..mesh.layering.count() {
        let elements = mesh.layer_elements(layer);
        for level in 0..mesh.layer_axis(layer).len() {
            let levels = around(level, order, elements.len());
            for row in 0..rows {
                for column in 0..columns {
                    let mut most = f64::NEG_INFINITY;
                    for ez in levels.clone().map(|level| elements.start + level) {
                        for ey in around(row, order, ny) {
                            for ex in around(column, order, nx) {
                                most = most.max(of_elements[ex + nx * (ey + ny * ez)]);
                            }
                        }
                    }
                    out.push(most);
                }
            }
        }
    }
    out
}

/// Elements along an axis that meet at a node, given the number of all elements.
fn around(node: usize, order: usize, elements: usize) -> std::ops::Range<usize> {
    let low = node.saturating_sub(1) / order;
    let high = (node / order).min(elements - 1);
    low.min(high)..high + 1
}

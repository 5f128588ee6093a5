//! Rows of linear readings of a solid: displacement and recovered stress at points, and sums of these.
//!
//! [`SolidFem::displacement_at`] and [`SolidFem::stress_at`] are linear in everything up to the solution. Here the same
//! steps are transposed, in reverse order: stress law, recovery with tractions on bottom and top, strains at sampling
//! points, solution, and nodal temperatures from modes.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::recovered::{Quantity, per_area_row, quantities, through, traction_of};
use super::{SolidFem, SolidLoads, Weights};
use crate::laws::Thermoelastic;
use crate::laws::stress::from_cylindrical;
use crate::math::cholesky::SolverError;
use crate::math::separable::dot;
use crate::method::fem::elastic::{
    Component, ElasticProblem, FaceRows, Functional, Gradient, StrainWeights, Term,
};
use crate::method::mesh::{Geometry, Parity};

/// Derivatives of a reading of one symmetry class.
#[derive(Debug, Clone)]
pub struct ClassRow {
    /// Derivatives by the class's part of a state: modal heat contents as in [`SolidFem::contents`]. If heat has no
    /// modes, derivatives by nodal temperatures [per K].
    pub heat: Arc<Vec<f64>>,
    /// Derivatives by the values of thermal faces, of which only prescribed temperatures act without delay [per K].
    pub faces: Vec<f64>,
    /// Derivatives by nodal forces on the bottom and the top [per N], a list for each displacement component.
    pub forces: Arc<FaceRows>,
    /// Contribution of the stress-free temperature to the reading, if it is not the initial one.
    pub constant: f64,
}

impl ClassRow {
    /// Reading of loads, or of a change of them, without the constant; empty lists are zero.
    pub fn of(&self, heat: &[f64], faces: &[f64], forces: &[Vec<Vec<f64>>; 2]) -> f64 {
        let mut sum = 0.0;
        if !heat.is_empty() {
            sum += dot(&self.heat, heat);
        }
        sum += self.faces.iter().zip(faces).map(|(row, value)| row * value).sum::<f64>();
        for (rows, lists) in self.forces.iter().zip(forces) {
            for (row, list) in rows.iter().zip(lists).filter(|(_, list)| !list.is_empty()) {
                sum += dot(row, list);
            }
        }
        sum
    }
}

impl SolidFem {
    /// Components in the axes of the mesh from which those along x, y and z follow.
    pub fn components(&self) -> &'static [Component] {
        use Component::{Displacement, Stress};
        match self.mesh.geometry {
            Geometry::Box => &[
                Stress(0),
                Stress(1),
                Stress(2),
                Stress(3),
                Stress(4),
                Stress(5),
                Displacement(0),
                Displacement(1),
                Displacement(2),
            ],
            Geometry::Axisymmetric => {
                &[Stress(0), Stress(1), Stress(2), Stress(5), Displacement(0), Displacement(1)]
            }
        }
    }

    /// Expresses a component along x, y, z at a point of the body as a sum of components in the axes of the mesh.
    pub fn terms(&self, component: Component, point: [f64; 3]) -> Vec<Term> {
        let (place, image) = self.mesh.locate(point);
        let own = [(component, 1.0)];
        let parts = match (self.mesh.geometry, component) {
            (Geometry::Box, _) => own.to_vec(),
            (Geometry::Axisymmetric, Component::Displacement(axis)) => {
                let r = point[0].hypot(point[1]);
                let cosine = |x: f64| if r > 0.0 { x / r } else { 0.0 };
                match axis {
                    2 => vec![(Component::Displacement(1), 1.0)],
                    _ => vec![(Component::Displacement(0), cosine(point[axis]))],
                }
            }
            (Geometry::Axisymmetric, Component::Stress(slot)) => {
                let share = |n: usize| {
                    let mut unit = [0.0; 4];
                    unit[n] = 1.0;
                    from_cylindrical(unit, point[0], point[1])[slot]
                };
                let slots = [0, 1, 2, 5].into_iter().enumerate();
                slots.map(|(n, slot)| (Component::Stress(slot), share(n))).collect()
            }
        };
        let term = |(component, weight)| Term { component, place, image, weight };
        parts.into_iter().filter(|(_, weight)| *weight != 0.0).map(term).collect()
    }

    /// The sum of a component along x, y, z over points with weights, such as a mean over a cell.
    pub fn functional(&self, component: Component, points: &[([f64; 3], f64)]) -> Functional {
        let of_point = |&(point, weight): &([f64; 3], f64)| {
            let terms = self.terms(component, point).into_iter();
            terms.map(move |term| Term { weight: weight * term.weight, ..term })
        };
        Functional { terms: points.iter().flat_map(of_point).collect() }
    }

    /// The sign of a component of a symmetry class at an image.
    pub fn sign(&self, class: usize, component: Component, image: [bool; 2]) -> f64 {
        self.parities[class].component_sign(self.mesh.geometry, component, image)
    }

    /// Returns the row of a reading of one symmetry class; `None` if mechanics is not linear or not modelled.
    pub fn row(
        &self,
        functional: &Functional,
        class: usize,
    ) -> Option<Result<ClassRow, SolverError>> {
        let elastic = self.elastic.as_ref()?;
        let nodal = elastic.row(functional, class, || self.gradient(elastic, functional, class));
        Some(nodal.map(|nodal| {
            let (heat, faces) = match self.heat.modal() {
                Some(modal) => {
                    let [heat, faces] = modal.row(class, &nodal.temperature);
                    (Arc::new(heat), faces)
                }
                None => (nodal.temperature.clone(), Vec::new()),
            };
            let constant = match (class, self.stress_free_rise) {
                (0, rise) if rise != 0.0 => -rise * nodal.temperature.iter().sum::<f64>(),
                _ => 0.0,
            };
            ClassRow { heat, faces, forces: nodal.forces, constant }
        }))
    }

    /// Returns the rows of a reading of all symmetry classes.
    pub fn rows(&self, functional: &Functional) -> Option<Result<Vec<ClassRow>, SolverError>> {
        self.elastic.as_ref()?;
        (0..self.classes()).map(|class| self.row(functional, class)).collect()
    }

    /// Returns for each symmetry class the part of a state on which rows act; `None` if heat has no modes, so that they
    /// act on nodal temperatures.
    pub fn contents<'s>(&'s self, state: &'s [f64]) -> Option<Vec<&'s [f64]>> {
        self.heat.modal().map(|modal| modal.contents(state))
    }

    /// Returns that part for one class.
    pub fn contents_of<'s>(&'s self, state: &'s [f64], class: usize) -> Option<&'s [f64]> {
        self.contents(state).map(|contents| contents[class])
    }

    /// Number of symmetry classes.
    pub fn classes(&self) -> usize {
        self.parities.len()
    }

    /// Returns true if instantaneous loads act on a class.
    pub fn drives_at_once(loads: &SolidLoads, class: usize) -> bool {
        let forces = loads.force.get(class).into_iter().flatten().flatten().flatten();
        let faces = loads.faces.get(class).into_iter().flatten();
        forces.chain(faces).any(|&value| value != 0.0)
    }

    fn gradient(
        &self,
        elastic: &ElasticProblem,
        functional: &Functional,
        class: usize,
    ) -> Gradient {
        let mut out = Gradient::zeros(&self.mesh);
        let mut recovered = Recovered::default();
        let parity = self.parities[class];
        for term in &functional.terms {
            if self.vanishes(parity, term) {
                continue;
            }
            match term.component {
                Component::Displacement(component) => {
                    let sign = self.sign(class, term.component, term.image);
                    let nodes = self.node_weights(term.place);
                    let (counts, degrees) = (self.mesh.node_counts(), elastic.degrees());
                    let target = (&mut out.displacement[..], counts, (component, degrees));
                    add_weighted(target, nodes.each_ref(), sign * term.weight);
                }
                Component::Stress(slot) => {
                    self.add_stress(parity, (slot, term), &mut recovered, &mut out.temperature);
                }
            }
        }
        let strains = self.strain_weights(elastic, recovered.samples);
        elastic.add_strain_rows(&strains, &mut out);
        for ((end, number), mut density) in recovered.tractions {
            let quantity = &quantities(self.mesh.geometry)[number];
            let Some(component) = traction_of(self.mesh.geometry, quantity.slot) else { continue };
            let sign = if end == 0 { -1.0 } else { 1.0 };
            let odd = self.odd_along(parity, quantity.slot);
            let row = per_area_row(self, &mut density, sign, odd);
            out.forces[end][component].iter_mut().zip(row).for_each(|(sum, own)| *sum += own);
        }
        out
    }

    /// Returns true if a component vanishes at its place, on a plane about which it is odd.
    fn vanishes(&self, parity: Parity, term: &Term) -> bool {
        let odd = |axis: usize| {
            let mut image = [false; 2];
            image[axis] = true;
            parity.component_sign(self.mesh.geometry, term.component, image) < 0.0
        };
        let on_plane = |axis: usize| self.mesh.mirrored[axis] && term.place[axis] == 0.0;
        (0..2).any(|axis| on_plane(axis) && odd(axis))
    }

    /// Adds the derivatives of a recovered stress: by samples of the recovered quantities, by tractions and by the
    /// local temperature.
    fn add_stress(
        &self,
        parity: Parity,
        (slot, term): (usize, &Term),
        recovered: &mut Recovered,
        temperature: &mut [f64],
    ) {
        let nodes = self.sided_weights(term.place);
        let law = self.law_at(nodes[2].first);
        let rise = self.stress_of(law, [0.0; 6], 1.0)[slot];
        let scalar = parity.sign(term.image) * term.weight * rise;
        let target = (temperature, self.mesh.sided_counts(), (0, 1));
        add_weighted(target, nodes.each_ref(), scalar);
        for (number, quantity) in quantities(self.mesh.geometry).iter().enumerate() {
            let share = self.share_of(law, quantity, slot);
            let sign = parity.tensor_sign(term.image, quantity.slot);
            let weight = sign * share * term.weight;
            if weight != 0.0 {
                self.add_quantity(parity, (number, quantity), (&nodes, weight), recovered);
            }
        }
    }

    /// Derivative of a stress by a recovered quantity.
    fn share_of(&self, law: &Thermoelastic, quantity: &Quantity, slot: usize) -> f64 {
        let mut unit = [0.0; 6];
        unit[quantity.slot] = 1.0;
        self.stress_of(law, unit, 0.0)[slot]
    }

    fn add_quantity(
        &self,
        parity: Parity,
        (number, quantity): (usize, &Quantity),
        (nodes, weight): (&[Weights; 3], f64),
        recovered: &mut Recovered,
    ) {
        let chosen = self.recoveries.choose(parity, quantity);
        let [x, y, z] = [0, 1, 2].map(|a| through(&nodes[a], chosen[a]));
        let [columns, rows, _] = chosen.map(|recovery| recovery.samples.ncols());
        for (c, wz) in z.values.iter().enumerate() {
            for (b, wy) in y.values.iter().enumerate() {
                let row = columns * (y.first + b + rows * (z.first + c)) + x.first;
                for (a, wx) in x.values.iter().enumerate() {
                    recovered.samples.entry(row + a).or_default()[number] += weight * wx * wy * wz;
                }
            }
        }
        let counts = self.mesh.node_counts();
        for (end, weights) in chosen[2].ends.iter().enumerate() {
            let share: f64 = nodes[2].of(weights);
            if share != 0.0 {
                let none = || vec![0.0; counts[0] * counts[1]];
                let density = recovered.tractions.entry((end, number)).or_insert_with(none);
                let one = Weights { first: 0, values: vec![1.0] };
                let plane = [&nodes[0], &nodes[1], &one];
                add_weighted((density, counts, (0, 1)), plane, weight * share);
            }
        }
    }

    /// The transpose of [`SolidFem::quantities_of`].
    fn strain_weights(
        &self,
        elastic: &ElasticProblem,
        mut samples: StrainWeights,
    ) -> StrainWeights {
        let layers = self.recoveries.layers_of_samples(&self.mesh);
        let per_level = self.recoveries.samples_per_level();
        for (number, weights) in &mut samples {
            let law = elastic.law(layers[number / per_level]);
            let (lambda, shear) = (law.lame_first(), law.shear_modulus());
            let along_z = (lambda + 2.0 * shear) * weights[2];
            match self.mesh.geometry {
                Geometry::Box => {
                    let [xx, yy, zz, xy, yz, xz] = *weights;
                    let (xx, yy) = (xx + lambda * zz, yy + lambda * zz);
                    *weights = [xx, yy, along_z, xy, shear * yz, shear * xz];
                }
                Geometry::Axisymmetric => {
                    let [mean, half, zz, rz, ..] = *weights;
                    let (rr, tt) = (0.5 * (mean + half), 0.5 * (mean - half));
                    let (rr, tt) = (rr + lambda * zz, tt + lambda * zz);
                    *weights = [rr, tt, along_z, shear * rz, 0.0, 0.0];
                }
            }
        }
        samples
    }
}

/// Weights of recovered quantities at sampling points, and of tractions by end and number of the quantity.
#[derive(Default)]
struct Recovered {
    samples: StrainWeights,
    tractions: BTreeMap<(usize, usize), Vec<f64>>,
}

impl Parity {
    /// The sign of a component of a reading of this class at an image.
    fn component_sign(&self, geometry: Geometry, component: Component, image: [bool; 2]) -> f64 {
        match (geometry, component) {
            (Geometry::Axisymmetric, _) => 1.0,
            (_, Component::Displacement(axis)) => self.vector_sign(image, axis),
            (_, Component::Stress(slot)) => self.tensor_sign(image, slot),
        }
    }
}

/// The transpose of [`super::weighted`].
fn add_weighted(
    (field, counts, (component, stride)): (&mut [f64], [usize; 3], (usize, usize)),
    [x, y, z]: [&Weights; 3],
    weight: f64,
) {
    for (c, wz) in z.values.iter().enumerate() {
        for (b, wy) in y.values.iter().enumerate() {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c)) + x.first;
            for (a, wx) in x.values.iter().enumerate() {
                field[stride * (row + a) + component] += weight * wx * wy * wz;
            }
        }
    }
}

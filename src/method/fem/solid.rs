//! A solid: heat and elasticity on one mesh, and readings of their solution.

mod extremes;
mod failure_density;
mod influence;
mod modal;
mod nodal_sum;
mod recovered;
mod remembered;
mod risk;
mod tangent;

use std::sync::Arc;

use faer::Mat;

use super::conduction::{Heat, HeatFailure, heat_of};

use super::elastic::{ElasticProblem, ElasticSetup, Strains};
use super::end_response::EndResponse;
use super::free_faces::FreeFaces;
use super::heat::HeatLoads;
use super::plan::Plan;
use crate::laws::{FlowLaw, Thermoelastic};
use crate::math::cholesky::SolverError;
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::Axis;
use crate::method::mesh::{Geometry, Mesh, Parity};
use crate::runtime::allowance::Allowance;
use crate::state::Layout;
pub use extremes::Extreme;
pub use failure_density::FlawsIn;
pub use influence::ClassRow;
pub use modal::SolidModes;
pub use nodal_sum::NodalSum;
use recovered::{FaceStresses, Recoveries};
pub use remembered::Remembered;
pub use risk::{Flaws, ImageStress};

/// Everything that is known of a solid before time starts.
pub struct SolidFem {
    mesh: Mesh,
    initial_temperature: f64,
    /// Stress-free temperature above the initial one [K].
    stress_free_rise: f64,
    heat: Box<dyn Heat>,
    /// Responses of the bottom and the top.
    ends: [EndResponse; 2],
    /// Node along z of each node of the list with doubled interfaces.
    nodes_of_sided: Vec<usize>,
    elastic: Option<Arc<ElasticProblem>>,
    recoveries: Recoveries,
    parities: Vec<Parity>,
    /// Flow law of each element along z; empty if stress follows from deformation alone.
    flow_laws: Vec<Arc<dyn FlowLaw>>,
    free_faces: FreeFaces,
    flaws: Option<Flaws>,
}

/// Loads on a solid, or a derivative of them; every list has an entry for each symmetry class.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SolidLoads {
    /// Heat into the nodes of the bottom and the top of the mesh [W]; empty for none.
    pub heat: Vec<[Vec<f64>; 2]>,
    /// Forces on the nodes of the bottom and the top [N], a list for each displacement component;
    /// empty for none.
    pub force: Vec<[Vec<Vec<f64>>; 2]>,
    /// Value of each thermal face: flux [W/m²] or temperature above the initial one [K].
    pub faces: Vec<Vec<f64>>,
}

/// Nodal temperature above the initial one [K], class by class; empty for a class that is zero. Nodes on interfaces
/// between layers are listed twice, first for the layer below.
pub type Temperatures = Vec<Vec<f64>>;

/// Displacements [m] and the data for stress recovery, class by class; empty for a class that is zero.
#[derive(Debug, Clone, Default)]
pub struct Deformation {
    pub displacement: Vec<Vec<f64>>,
    /// The recovered quantities at the sampling points.
    strains: Vec<Strains>,
    tractions: Vec<FaceStresses>,
    /// Set for a body whose stress depends on its history.
    remembered: Option<Remembered>,
    /// Damage at the nodes [1]; empty if nothing cracks.
    damage: Vec<f64>,
}

impl Deformation {
    /// Displacements and stress known at the nodes, even about planes of symmetry.
    pub fn of_nodes(displacement: Vec<f64>, remembered: Remembered) -> Self {
        let (displacement, remembered) = (vec![displacement], Some(remembered));
        Self { displacement, remembered, ..Self::default() }
    }

    /// The same with damage at the nodes [1].
    pub fn with_damage(self, damage: Vec<f64>) -> Self {
        Self { damage, ..self }
    }

    /// Accumulated plastic strain at the nodes [1]; empty without yielding.
    fn plastic_strain(&self) -> &[f64] {
        let flow = self.remembered.as_ref().and_then(|remembered| remembered.flow.as_ref());
        flow.map_or(&[], |flow| &flow.plastic_strain)
    }
}

/// Values at all nodes of the whole body, images included: a rectilinear grid.
#[derive(Debug, Clone, Default)]
pub struct NodalFields {
    /// Coordinates along x, y, z [m]; the x index runs fastest. In axisymmetry x is the radius and y the single value
    /// 0. Interfaces between layers are listed twice along z, first for the layer below.
    pub axes: [Vec<f64>; 3],
    /// [K]
    pub temperature: Vec<f64>,
    /// [m]; empty if mechanics is not modelled.
    pub displacement: Vec<[f64; 3]>,
    /// xx, yy, zz, xy, yz, xz [Pa] (axisymmetry: rr, tt, zz, 0, 0, rz); empty if mechanics is not modelled.
    pub stress: Vec<[f64; 6]>,
    /// Accumulated plastic strain [1]; empty without yielding.
    pub plastic_strain: Vec<f64>,
    /// Damage [1]; empty if nothing cracks.
    pub damage: Vec<f64>,
}

impl NodalFields {
    /// All values at the nodes.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let vectors = self.displacement.iter().flatten().chain(self.stress.iter().flatten());
        self.temperature
            .iter()
            .chain(vectors)
            .chain(&self.plastic_strain)
            .chain(&self.damage)
            .copied()
    }
}

/// Weights of consecutive values along one axis.
struct Weights {
    first: usize,
    values: Vec<f64>,
}

impl SolidLoads {
    /// Returns loads of the same shape that are zero.
    pub fn zero(&self) -> Self {
        let empty =
            |lists: &[Vec<Vec<f64>>; 2]| lists.each_ref().map(|l| vec![Vec::new(); l.len()]);
        Self {
            heat: vec![[Vec::new(), Vec::new()]; self.heat.len()],
            force: self.force.iter().map(empty).collect(),
            faces: self.faces.iter().map(|values| vec![0.0; values.len()]).collect(),
        }
    }

    /// Returns true if instantaneous loads are bitwise equal: face values, including prescribed temperatures, and
    /// forces.
    pub fn acts_at_once_as(&self, other: &Self) -> bool {
        let same = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
        };
        fn lists(loads: &SolidLoads) -> Vec<&Vec<f64>> {
            loads.force.iter().flatten().flatten().chain(&loads.faces).collect()
        }
        let (own, other) = (lists(self), lists(other));
        own.len() == other.len() && own.iter().zip(other).all(|(own, other)| same(own, other))
    }

    fn thermal(&self) -> HeatLoads<'_> {
        HeatLoads { surface: &self.heat, faces: &self.faces }
    }
}

impl SolidFem {
    /// Builds the heat problem of a plan on at most `threads` threads; the solver for displacements is made when these
    /// are first read.
    pub fn new(plan: &Plan, threads: usize) -> Self {
        let mesh = plan.mesh.clone();
        let heat = heat_of(plan, threads);
        let ends = [false, true].map(|high| EndResponse::of(plan, high));
        let setup = |laws: &Vec<Thermoelastic>| ElasticSetup {
            mesh: mesh.clone(),
            laws: laws.clone(),
            supports: plan.supports.clone(),
            threads,
        };
        let elastic = plan.law.as_ref().map(|laws| ElasticProblem::shared(&setup(laws)));
        let recoveries = Recoveries::of(plan);
        let parities = mesh.parities();
        let initial_temperature = plan.initial_temperature;
        let nodes_of_sided = mesh.nodes_of_sided();
        Self {
            mesh,
            initial_temperature,
            stress_free_rise: plan.stress_free_rise,
            heat,
            ends,
            nodes_of_sided,
            elastic,
            recoveries,
            parities,
            flow_laws: plan.inelastic.clone().unwrap_or_default(),
            free_faces: FreeFaces::of(&plan.mesh, &plan.supports),
            flaws: Flaws::of(plan),
        }
    }

    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub fn free_faces(&self) -> &FreeFaces {
        &self.free_faces
    }

    /// The state at time zero.
    pub fn initial_state(&self) -> Vec<f64> {
        self.heat.initial_state()
    }

    /// Returns true if heat obeys a linear equation.
    pub fn conducts_linearly(&self) -> bool {
        self.heat.is_linear()
    }

    /// Error of temperatures from step to step [K]; zero where they are exact.
    pub fn tolerance(&self) -> f64 {
        self.heat.tolerance()
    }

    /// Liquid volume [m³].
    pub fn liquid_volume(&self, state: &[f64]) -> f64 {
        self.heat.liquid_volume(state, self.mesh.copies())
    }

    /// Approximate scatter of that volume as fronts move from node to node [m³].
    pub fn liquid_scatter(&self, state: &[f64]) -> f64 {
        self.heat.liquid_scatter(state, self.mesh.copies())
    }

    pub fn state_len(&self) -> usize {
        self.heat.layout().len()
    }

    /// The fields of a state.
    pub fn layout(&self) -> Layout {
        self.heat.layout()
    }

    /// Stored entries of all factorisations made so far.
    pub fn factor_entries(&self) -> usize {
        self.elastic.as_ref().map_or(0, |elastic| elastic.factor_entries())
    }

    /// Returns the elastic problem, shared by bodies that differ only in thermal data.
    pub fn stiffness(&self) -> Option<Arc<ElasticProblem>> {
        self.elastic.clone()
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one entry of `loads`
    /// for their values at the beginning and one for each derivative. After a halt `state` is unusable.
    pub fn advance(
        &self,
        state: &mut [f64],
        loads: &[SolidLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure> {
        let heat: Vec<HeatLoads> = loads.iter().map(SolidLoads::thermal).collect();
        self.heat.advance(state, &heat, dt, allowance)
    }

    /// Heat stored since time zero [J].
    pub fn heat_stored(&self, state: &[f64]) -> f64 {
        self.heat.stored(state)
    }

    pub fn heat_totals(&self, state: &[f64]) -> HeatTotals {
        self.heat.totals(state)
    }

    /// Heat stored minus heat supplied plus heat lost [J].
    pub fn heat_drift(&self, state: &[f64]) -> f64 {
        let totals = self.heat_totals(state);
        self.heat_stored(state) - (totals.brought_in - totals.lost)
    }

    /// Temperature of the stress-free body at time zero [K].
    pub fn initial_temperature(&self) -> f64 {
        self.initial_temperature
    }

    /// Number of particles without a corrected operator of their own; `None` if finite elements conduct the heat.
    pub fn fallback_particles(&self) -> Option<usize> {
        self.heat.fallback()
    }

    /// Temperature above the initial one at one point [K], computed from the modes if there are any, without the whole
    /// field.
    pub fn rise_at(&self, state: &[f64], loads: &SolidLoads, point: [f64; 3]) -> f64 {
        let place = self.mesh.locate(point);
        let modal = self.heat.modal();
        let found = modal.map(|modal| modal.at(&self.mesh, state, &loads.faces, place));
        found.unwrap_or_else(|| self.rise_from(&self.temperatures(state, loads), point))
    }

    /// Response of the top, or the bottom, to an impulse of heat per area, uniform along it: rates λ [1/s] and gains g
    /// [K m²/J] of `Σ g e^{−λt}`.
    pub fn end_modes(&self, high: bool) -> [Vec<f64>; 2] {
        let end = &self.ends[usize::from(high)];
        [end.rates.clone(), end.gains.clone()]
    }

    /// Temperature above the initial one at the nodes of that end [K], followed by the contribution of each of these
    /// modes to it, class by class; empty for a class that is zero.
    pub fn end_parts(&self, state: &[f64], loads: &SolidLoads, high: bool) -> Vec<Vec<f64>> {
        self.heat.along_depth(state, &loads.faces, &self.ends[usize::from(high)].rows)
    }

    /// Temperature above the initial one at the nodes of the top or the bottom [K], class by class; empty for a class
    /// that is zero.
    pub fn end_rise(&self, state: &[f64], loads: &SolidLoads, high: bool) -> Vec<Vec<f64>> {
        let rows = &self.ends[usize::from(high)].rows;
        let node = Mat::from_fn(1, rows.ncols(), |_, k| rows[(0, k)]);
        self.heat.along_depth(state, &loads.faces, &node)
    }

    pub fn temperatures(&self, state: &[f64], loads: &SolidLoads) -> Temperatures {
        self.heat.nodal(state, &loads.faces)
    }

    /// Solves for the deformation under temperatures and loads.
    ///
    /// Temperatures are relative to the stress-free one, see [`Self::above_stress_free`].
    pub fn deformation(
        &self,
        temperatures: &Temperatures,
        loads: &SolidLoads,
    ) -> Result<Deformation, SolverError> {
        let mut result = Deformation::default();
        let Some(elastic) = &self.elastic else { return Ok(result) };
        // This is done even at rest: hosts read initial values before the first step, which then takes no longer than
        // the others.
        elastic.prepare()?;
        for (class, temperature) in temperatures.iter().enumerate() {
            let displacement = elastic.displacement(class, temperature, &loads.force[class])?;
            let strains = match displacement.is_empty() {
                true => Vec::new(),
                false => self.quantities_of(elastic, elastic.strains(&displacement, temperature)),
            };
            result.tractions.push(self.face_stresses(self.parities[class], &loads.force[class]));
            result.displacement.push(displacement);
            result.strains.push(strains);
        }
        Ok(result)
    }

    /// Converts temperatures above the initial one to those above the stress-free one.
    pub fn above_stress_free(&self, mut temperatures: Temperatures) -> Temperatures {
        if self.stress_free_rise != 0.0 {
            temperatures[0].resize(self.mesh.sided_nodes(), 0.0);
            temperatures[0].iter_mut().for_each(|rise| *rise -= self.stress_free_rise);
        }
        temperatures
    }

    /// Temperature above the initial one at a point from nodal values [K].
    pub fn rise_from(&self, temperatures: &Temperatures, point: [f64; 3]) -> f64 {
        let (place, image) = self.mesh.locate(point);
        let weights = self.sided_weights(place);
        let counts = self.mesh.sided_counts();
        let value = |field: &Vec<f64>| weighted(field, weights.each_ref(), counts, (0, 1));
        let parts = self.parities.iter().zip(temperatures);
        parts.map(|(parity, field)| parity.sign(image) * value(field)).sum()
    }

    /// Displacement at a point along x, y, z [m].
    pub fn displacement_at(&self, deformation: &Deformation, point: [f64; 3]) -> [f64; 3] {
        let (place, image) = self.mesh.locate(point);
        let weights = self.node_weights(place);
        let counts = self.mesh.node_counts();
        let mut total = [0.0; 3];
        for (parity, field) in self.parities.iter().zip(&deformation.displacement) {
            match self.mesh.geometry {
                Geometry::Box => {
                    for (i, sum) in total.iter_mut().enumerate() {
                        let u = weighted(field, weights.each_ref(), counts, (i, 3));
                        *sum += parity.vector_sign(image, i) * u;
                    }
                }
                Geometry::Axisymmetric => {
                    let [radial, axial] =
                        [0, 1].map(|i| weighted(field, weights.each_ref(), counts, (i, 2)));
                    let r = point[0].hypot(point[1]);
                    let direction = |x: f64| if r > 0.0 { x / r } else { 0.0 };
                    total = [radial * direction(point[0]), radial * direction(point[1]), axial];
                }
            }
        }
        total
    }

    /// Accumulated plastic strain at a point [1]; zero without yielding.
    pub fn plastic_strain_at(&self, deformation: &Deformation, point: [f64; 3]) -> f64 {
        let flow = deformation.remembered.as_ref().and_then(|remembered| remembered.flow.as_ref());
        flow.map_or(0.0, |flow| self.flowed_at(flow, self.mesh.locate(point).0))
    }

    /// Damage at a point [1]; zero if nothing cracks.
    pub fn damage_at(&self, deformation: &Deformation, point: [f64; 3]) -> f64 {
        let weights = self.sided_weights(self.mesh.locate(point).0);
        weighted(&deformation.damage, weights.each_ref(), self.mesh.sided_counts(), (0, 1))
    }

    /// Values at all nodes of the whole body, from temperatures above the initial one, those above the stress-free one,
    /// and the deformation under these.
    pub fn fields(
        &self,
        temperatures: &Temperatures,
        thermal: &Temperatures,
        deformation: &Deformation,
    ) -> NodalFields {
        let [x, y, z] = &self.mesh.axes;
        let [mirror_x, mirror_y] = self.mesh.mirrored;
        let (columns, rows) = (self.mesh.unfolded(0), self.mesh.unfolded(1));
        let coordinates = |axis: &Axis, places: &[(usize, bool)]| {
            let signed = |&(node, image): &(usize, bool)| {
                if image { -axis.nodes[node] } else { axis.nodes[node] }
            };
            places.iter().map(signed).collect::<Vec<f64>>()
        };
        let mut fields = NodalFields {
            axes: [
                coordinates(x, &columns),
                coordinates(y, &rows),
                self.nodes_of_sided.iter().map(|&node| z.nodes[node]).collect(),
            ],
            ..Default::default()
        };
        let nodal = self.nodal_strains(deformation);
        let images = [[false, false], [true, false], [false, true], [true, true]];
        let parts = images.map(|image| {
            let wanted = (!image[0] || mirror_x) && (!image[1] || mirror_y);
            wanted.then(|| self.image_fields([temperatures, thermal], deformation, &nodal, image))
        });
        for (k, &layer) in self.nodes_of_sided.iter().enumerate() {
            for &(j, image_y) in &rows {
                for &(i, image_x) in &columns {
                    let part = &parts[usize::from(image_x) + 2 * usize::from(image_y)];
                    let Some(part) = part else { continue };
                    let node_of = |k: usize| i + x.len() * (j + y.len() * k);
                    let node = node_of(k);
                    fields.temperature.push(self.initial_temperature + part.temperature[node]);
                    if !part.stress.is_empty() {
                        fields.displacement.push(part.displacement[node_of(layer)]);
                        fields.stress.push(part.stress[node]);
                    }
                    fields.plastic_strain.extend(deformation.plastic_strain().get(node));
                    fields.damage.extend(deformation.damage.get(node));
                }
            }
        }
        fields
    }

    fn image_fields(
        &self,
        [temperatures, thermal]: [&Temperatures; 2],
        deformation: &Deformation,
        nodal_strains: &[Vec<Vec<f64>>],
        image: [bool; 2],
    ) -> NodalFields {
        let temperature = self.rise_of_image(temperatures, image);
        let (mut displacement, mut stress) = (Vec::new(), Vec::new());
        if self.elastic.is_some() || deformation.remembered.is_some() {
            stress = self.stress_in(thermal, deformation, nodal_strains, image);
            displacement = self.displacement_of_image(deformation, image);
        }
        NodalFields { temperature, displacement, stress, ..Default::default() }
    }

    /// Stress at the nodes of an image, with nodes on interfaces listed twice.
    fn stress_in(
        &self,
        thermal: &Temperatures,
        deformation: &Deformation,
        nodal_strains: &[Vec<Vec<f64>>],
        image: [bool; 2],
    ) -> Vec<[f64; 6]> {
        let Some(Remembered { stress, .. }) = &deformation.remembered else {
            return self.stress_of_image(thermal, nodal_strains, image);
        };
        stress.iter().map(|stress| self.imaged(*stress, image)).collect()
    }

    /// The image of a stress that is even about planes of symmetry.
    fn imaged(&self, stress: [f64; 6], image: [bool; 2]) -> [f64; 6] {
        std::array::from_fn(|slot| self.parities[0].tensor_sign(image, slot) * stress[slot])
    }

    fn displacement_of_image(&self, deformation: &Deformation, image: [bool; 2]) -> Vec<[f64; 3]> {
        let mut out = vec![[0.0; 3]; self.mesh.nodes()];
        // Component along each axis, and the place of that component among a node's values.
        let components: &[(usize, usize)] = match self.mesh.geometry {
            Geometry::Box => &[(0, 0), (1, 1), (2, 2)],
            Geometry::Axisymmetric => &[(0, 0), (2, 1)],
        };
        for (parity, field) in self.parities.iter().zip(&deformation.displacement) {
            for (u, values) in out.iter_mut().zip(field.chunks_exact(components.len())) {
                for &(axis, at) in components {
                    u[axis] += parity.vector_sign(image, axis) * values[at];
                }
            }
        }
        out
    }

    /// Distinct images: all four only if an odd part is present.
    fn images(&self, classes: &[Vec<f64>]) -> Vec<[bool; 2]> {
        let odd = |axis: usize| {
            let parts = self.parities.iter().zip(classes);
            parts.into_iter().any(|(p, values)| p.odd[axis] && !values.is_empty())
        };
        let choices = |odd: bool| if odd { vec![false, true] } else { vec![false] };
        let (along_x, along_y) = (choices(odd(0)), choices(odd(1)));
        along_y.iter().flat_map(|&y| along_x.iter().map(move |&x| [x, y])).collect()
    }

    fn rise_of_image(&self, temperatures: &Temperatures, image: [bool; 2]) -> Vec<f64> {
        self.sum_at_image(temperatures, image, self.mesh.sided_nodes())
    }

    /// Sum of the classes of a number of values at an image.
    fn sum_at_image(&self, classes: &[Vec<f64>], image: [bool; 2], count: usize) -> Vec<f64> {
        let mut rise = vec![0.0; count];
        for (parity, part) in self.parities.iter().zip(classes) {
            let sign = parity.sign(image);
            for (r, t) in rise.iter_mut().zip(part) {
                *r += sign * t;
            }
        }
        rise
    }

    /// Weights of the nodes around a place, with nodes on interfaces listed twice.
    fn sided_weights(&self, place: [f64; 3]) -> [Weights; 3] {
        let [x, y, _] = self.node_weights(place);
        let shape = self.mesh.sided_shape_at(place[2]);
        [x, y, Weights { first: shape.first, values: shape.values[..shape.count].to_vec() }]
    }

    /// Weights of the nodes around a place.
    fn node_weights(&self, place: [f64; 3]) -> [Weights; 3] {
        [0, 1, 2].map(|a| {
            let shape = self.mesh.axes[a].shape_at(place[a]);
            Weights { first: shape.first, values: shape.values[..shape.count].to_vec() }
        })
    }
}

/// Weighted sum over a grid of one component of `(component, number per point)`; zero for an empty field.
fn weighted(
    field: &[f64],
    [x, y, z]: [&Weights; 3],
    counts: [usize; 3],
    (component, stride): (usize, usize),
) -> f64 {
    let mut sum = 0.0;
    if field.is_empty() {
        return sum;
    }
    for (c, wz) in z.values.iter().enumerate() {
        for (b, wy) in y.values.iter().enumerate() {
            let row = counts[0] * (y.first + b + counts[1] * (z.first + c)) + x.first;
            for (a, wx) in x.values.iter().enumerate() {
                sum += wx * wy * wz * field[stride * (row + a) + component];
            }
        }
    }
    sum
}

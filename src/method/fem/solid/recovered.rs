//! Stress from the recovered quantities: in-plane strains and out-of-plane stresses of the surface.
//!
//! In a box they are the strains xx, yy, xy and the stresses zz, yz, xz; in a meridian section the mean of
//! the strains rr and tt, half their difference, and the stresses zz and rz.

use faer::Mat;

use super::{Deformation, SolidFem, Temperatures, Weights, weighted};
use crate::laws::Thermoelastic;
use crate::laws::stress::from_cylindrical;
use crate::math::separable::{Side, transform};
use crate::method::fem::elastic::{ElasticProblem, Strains, Support};
use crate::method::fem::plan::Plan;
use crate::method::fem::recovery::{Beyond, Recovery, sampling_places};
use crate::method::mesh::{Geometry, Mesh, MeshFace, Parity};

/// Tractions on the nodes of the bottom and the top as the stresses zz, yz and xz (zz and rz) there, with a list for
/// each recovered quantity that is such a stress; empty if zero.
pub type FaceStresses = [Vec<Vec<f64>>; 2];

/// Recoveries from strain sampling points to nodes.
pub struct Recoveries {
    /// Along x and y: of even and of odd quantities, and of those that vanish on the axis of a disc.
    lateral: [[Recovery; 3]; 2],
    /// Along z: of strains, of the stress zz and of the stresses yz and xz.
    depth: [Recovery; 3],
    /// Areas of the nodes of a horizontal face, and mass matrices along x and y.
    areas: Vec<f64>,
    masses: [Mat<f64>; 2],
}

/// A recovered quantity.
pub struct Quantity {
    /// Index among the strains xx, yy, zz, xy, yz, xz.
    pub slot: usize,
    /// Index of its recovery along z.
    depth: usize,
    /// True if it vanishes on the axis.
    vanishes: bool,
}

const fn quantity(slot: usize, depth: usize, vanishes: bool) -> Quantity {
    Quantity { slot, depth, vanishes }
}

const OF_BOX: [Quantity; 6] = [
    quantity(0, 0, false),
    quantity(1, 0, false),
    quantity(2, 1, false),
    quantity(3, 0, false),
    quantity(4, 2, false),
    quantity(5, 2, false),
];
const OF_SECTION: [Quantity; 4] =
    [quantity(0, 0, false), quantity(1, 0, true), quantity(2, 1, false), quantity(5, 2, false)];

pub fn quantities(geometry: Geometry) -> &'static [Quantity] {
    match geometry {
        Geometry::Box => &OF_BOX,
        Geometry::Axisymmetric => &OF_SECTION,
    }
}

/// Displacement component whose traction is the stress of a slot on top and bottom.
pub fn traction_of(geometry: Geometry, slot: usize) -> Option<usize> {
    match (geometry, slot) {
        (Geometry::Box, 2) => Some(2),
        (Geometry::Box, 4) => Some(1),
        (Geometry::Box, 5) => Some(0),
        (Geometry::Axisymmetric, 2) => Some(1),
        (Geometry::Axisymmetric, 5) => Some(0),
        _ => None,
    }
}

impl Recoveries {
    pub fn of(plan: &Plan) -> Self {
        let mesh = &plan.mesh;
        let support = |high| {
            let place = MeshFace { axis: 2, high };
            plan.supports.iter().find(|(face, _)| *face == place).map(|(_, support)| *support)
        };
        let supports = [support(false), support(true)];
        let laws = plan.law.as_deref().unwrap_or_default();
        let traction = |known: fn(Option<Support>) -> bool, modulus: fn(&Thermoelastic) -> f64| {
            let compliances: Vec<f64> = laws.iter().map(|law| modulus(law).recip()).collect();
            Recovery::across_layers(mesh, supports.map(known), &compliances)
        };
        let lateral = |axis: usize| {
            let all = match continues(mesh, axis) {
                true => [Beyond::Even, Beyond::Odd, Beyond::Vanishing],
                false => [Beyond::Nothing; 3],
            };
            all.map(|beyond| Recovery::new(&mesh.axes[axis], beyond, [false; 2]))
        };
        let [along_x, along_y] = [0, 1].map(|axis: usize| mesh.axes[axis].integrals());
        let areas = along_y.iter().flat_map(|b| along_x.iter().map(move |a| a * b));
        Self {
            areas: areas.collect(),
            masses: [0, 1].map(|axis: usize| mesh.axes[axis].mass()),
            lateral: [lateral(0), lateral(1)],
            depth: [
                Recovery::of_layers(mesh, [false; 2]),
                traction(
                    |support| support.is_none(),
                    |law| law.lame_first() + 2.0 * law.shear_modulus(),
                ),
                traction(|support| support != Some(Support::Clamped), Thermoelastic::shear_modulus),
            ],
        }
    }

    /// Returns the recoveries of a quantity in a class, along x, y and z.
    pub fn choose(&self, parity: Parity, quantity: &Quantity) -> [&Recovery; 3] {
        let odd = |image| parity.tensor_sign(image, quantity.slot) < 0.0;
        let lateral = [[true, false], [false, true]].map(|image| match odd(image) {
            _ if quantity.vanishes && image[0] => 2,
            odd => usize::from(odd),
        });
        let [x, y] = [0, 1].map(|axis| &self.lateral[axis][lateral[axis]]);
        [x, y, &self.depth[quantity.depth]]
    }

    /// Returns the layer of each level of sampling points.
    pub fn layers_of_samples(&self, mesh: &Mesh) -> Vec<usize> {
        let levels = sampling_places(&mesh.axes[2]).into_iter();
        levels.map(|(element, _)| mesh.layering.layer_of(element)).collect()
    }

    /// Number of sampling points of a level.
    pub fn samples_per_level(&self) -> usize {
        self.lateral.iter().map(|[even, ..]| even.samples.ncols()).product()
    }
}

impl SolidFem {
    /// Recovered stress at a point: xx, yy, zz, xy, yz, xz [Pa].
    pub fn stress_at(
        &self,
        temperatures: &Temperatures,
        deformation: &Deformation,
        point: [f64; 3],
    ) -> [f64; 6] {
        let (place, image) = self.mesh.locate(point);
        if let Some(remembered) = &deformation.remembered {
            let stress = self.remembered_at(remembered, temperatures, place);
            return self.turned(self.imaged(stress, image), point);
        }
        let nodes = self.sided_weights(place);
        let counts = self.mesh.node_counts();
        let quantities = quantities(self.mesh.geometry);
        let mut recovered = [0.0; 6];
        let parts = deformation.strains.iter().zip(&deformation.tractions);
        for (&parity, (field, tractions)) in self.parities.iter().zip(parts) {
            for (n, quantity) in quantities.iter().enumerate() {
                let chosen = self.recoveries.choose(parity, quantity);
                let samples = [0, 1, 2].map(|a| through(&nodes[a], chosen[a]));
                let columns = chosen.map(|recovery| recovery.samples.ncols());
                let mut value = weighted(field, samples.each_ref(), columns, (n, quantities.len()));
                for (end, weights) in chosen[2].ends.iter().enumerate() {
                    let share: f64 = nodes[2].of(weights);
                    if share != 0.0 {
                        let one = Weights { first: 0, values: vec![1.0] };
                        let plane = [&nodes[0], &nodes[1], &one];
                        value += share * weighted(&tractions[end][n], plane, counts, (0, 1));
                    }
                }
                recovered[quantity.slot] += parity.tensor_sign(image, quantity.slot) * value;
            }
        }
        let law = self.law_at(nodes[2].first);
        let stress = self.stress_of(law, recovered, self.rise_from(temperatures, point));
        self.turned(stress, point)
    }

    /// Converts a stress to components along x, y and z.
    fn turned(&self, stress: [f64; 6], point: [f64; 3]) -> [f64; 6] {
        match self.mesh.geometry {
            Geometry::Box => stress,
            Geometry::Axisymmetric => {
                let [rr, tt, zz, _, _, rz] = stress;
                from_cylindrical([rr, tt, zz, rz], point[0], point[1])
            }
        }
    }

    /// Recovered quantities at the nodes: class, quantity, node.
    pub(super) fn nodal_strains(&self, deformation: &Deformation) -> Vec<Vec<Vec<f64>>> {
        let quantities = quantities(self.mesh.geometry);
        let recover = |(&parity, (strains, tractions)): (&Parity, (&Strains, &FaceStresses))| {
            if strains.is_empty() {
                return Vec::new();
            }
            let one = |(n, quantity): (usize, &Quantity)| {
                let chosen = self.recoveries.choose(parity, quantity);
                let samples: Vec<f64> =
                    strains.iter().skip(n).step_by(quantities.len()).copied().collect();
                let matrices = chosen.map(|recovery| &recovery.samples);
                let mut nodal = transform(&samples, matrices, Side::Direct);
                for (weights, values) in chosen[2].ends.iter().zip(tractions) {
                    add_outer(&mut nodal, weights, &values[n]);
                }
                nodal
            };
            quantities.iter().enumerate().map(one).collect()
        };
        let parts = deformation.strains.iter().zip(&deformation.tractions);
        self.parities.iter().zip(parts).map(recover).collect()
    }

    pub(super) fn stress_of_image(
        &self,
        temperatures: &Temperatures,
        nodal_strains: &[Vec<Vec<f64>>],
        image: [bool; 2],
    ) -> Vec<[f64; 6]> {
        let rise = self.rise_of_image(temperatures, image);
        let mut recovered = vec![[0.0; 6]; rise.len()];
        for (parity, parts) in self.parities.iter().zip(nodal_strains) {
            for (part, Quantity { slot, .. }) in parts.iter().zip(quantities(self.mesh.geometry)) {
                let sign = parity.tensor_sign(image, *slot);
                for (quantities, value) in recovered.iter_mut().zip(part) {
                    quantities[*slot] += sign * value;
                }
            }
        }
        let [nx, ny, nz] = self.mesh.sided_counts();
        let laws: Vec<_> = (0..nz).map(|k| self.law_at(k)).collect();
        let nodes = recovered.into_iter().zip(rise).enumerate();
        nodes.map(|(n, (r, rise))| self.stress_of(laws[n / (nx * ny)], r, rise)).collect()
    }

    /// Stress of recovered quantities at `rise` kelvin above the stress-free temperature.
    pub(super) fn stress_of(
        &self,
        law: &Thermoelastic,
        [a, b, zz, xy, yz, xz]: [f64; 6],
        rise: f64,
    ) -> [f64; 6] {
        let [xx, yy] = match self.mesh.geometry {
            Geometry::Box => [a, b],
            Geometry::Axisymmetric => [a + b, a - b],
        };
        let shear = law.shear_modulus();
        let along_z = (zz - law.lame_first() * (xx + yy)) / (law.lame_first() + 2.0 * shear);
        let strain = [xx, yy, along_z + law.layer_strain() * rise, xy, yz / shear, xz / shear];
        let [s_xx, s_yy, _, s_xy, ..] = law.stress(strain, rise);
        [s_xx, s_yy, zz, s_xy, yz, xz]
    }

    /// Returns the law at a node along z, with nodes on interfaces listed twice.
    pub(super) fn law_at(&self, sided: usize) -> &Thermoelastic {
        let elastic = self.elastic.as_ref();
        let node = self.nodes_of_sided[sided];
        let layers_below = sided - node;
        elastic.expect("stress is asked for where mechanics is modelled").law(layers_below)
    }

    /// Computes the recovered quantities of a class from its strains, which exclude that of a heated layer.
    pub(super) fn quantities_of(&self, elastic: &ElasticProblem, mut strains: Strains) -> Strains {
        let values = quantities(self.mesh.geometry).len();
        let [x, y, z] = self.mesh.axes.each_ref().map(sampling_places);
        let planes = strains.chunks_exact_mut(values * x.len() * y.len());
        for (plane, (element, _)) in planes.zip(z) {
            let law = elastic.law(self.mesh.layering.layer_of(element));
            let (lambda, shear) = (law.lame_first(), law.shear_modulus());
            match self.mesh.geometry {
                Geometry::Box => {
                    for at in plane.chunks_exact_mut(6) {
                        at[2] = lambda * (at[0] + at[1]) + (lambda + 2.0 * shear) * at[2];
                        at[4] *= shear;
                        at[5] *= shear;
                    }
                }
                Geometry::Axisymmetric => {
                    for at in plane.chunks_exact_mut(4) {
                        let [rr, tt] = [at[0], at[1]];
                        at[2] = lambda * (rr + tt) + (lambda + 2.0 * shear) * at[2];
                        at[0] = 0.5 * (rr + tt);
                        at[1] = 0.5 * (rr - tt);
                        at[3] *= shear;
                    }
                }
            }
        }
        strains
    }

    /// Converts nodal forces on bottom and top to stresses, by the area of each node.
    pub(super) fn face_stresses(
        &self,
        parity: Parity,
        forces: &[Vec<Vec<f64>>; 2],
    ) -> FaceStresses {
        let geometry = self.mesh.geometry;
        [0, 1].map(|end| {
            // The outward normal turns the traction into a stress.
            let sign = if end == 0 { -1.0 } else { 1.0 };
            let of = |quantity: &Quantity| match traction_of(geometry, quantity.slot) {
                Some(component) => {
                    let odd = self.odd_along(parity, quantity.slot);
                    self.per_area(&forces[end][component], sign, odd)
                }
                None => Vec::new(),
            };
            quantities(geometry).iter().map(of).collect()
        })
    }

    /// Returns the density whose consistent nodal values on a horizontal face are given. It is the values over the
    /// areas of the nodes, corrected once by the residual of such a density. The result is fourth-order where the
    /// density is smooth and hardly overshoots at jumps.
    fn per_area(&self, values: &[f64], sign: f64, odd: [bool; 2]) -> Vec<f64> {
        if values.is_empty() {
            return Vec::new();
        }
        let Recoveries { areas, masses: [x, y], .. } = &self.recoveries;
        let over_areas = |values: &[f64]| -> Vec<f64> {
            areas.iter().zip(values).map(|(area, value)| sign * value / area).collect()
        };
        let mut density = self.with_axis(over_areas(values));
        self.vanish_on_planes(&mut density, odd);
        let one = Mat::from_fn(1, 1, |_, _| 1.0);
        let met = transform(&density, [x, y, &one], Side::Direct);
        let left: Vec<f64> = values.iter().zip(met).map(|(v, met)| v - sign * met).collect();
        density.iter_mut().zip(over_areas(&left)).for_each(|(d, more)| *d += more);
        self.vanish_on_planes(&mut density, odd);
        self.with_axis(density)
    }

    /// Returns for x and y whether a stress of a symmetry class changes its sign at the mirror plane.
    pub(super) fn odd_along(&self, parity: Parity, slot: usize) -> [bool; 2] {
        let odd = [[true, false], [false, true]].map(|image| parity.tensor_sign(image, slot) < 0.0);
        [0, 1].map(|axis| self.mesh.mirrored[axis] && odd[axis])
    }

    /// Sets densities that are odd about a mirror plane to zero on it.
    fn vanish_on_planes(&self, density: &mut [f64], odd: [bool; 2]) {
        let [nx, ny, _] = self.mesh.node_counts();
        if odd[0] {
            density.iter_mut().step_by(nx).for_each(|value| *value = 0.0);
        }
        if odd[1] && ny > 1 {
            density[..nx].fill(0.0);
        }
    }

    /// On the axis of a disc the quadratic shape function has no area; the value there is that of the parabola through
    /// the next two nodes.
    fn with_axis(&self, mut density: Vec<f64>) -> Vec<f64> {
        let x = &self.mesh.axes[0];
        if self.mesh.geometry == Geometry::Axisymmetric && x.start() == 0.0 && x.order > 1 {
            let [near, far] = [x.nodes[1].powi(2), x.nodes[2].powi(2)];
            density[0] = (density[1] * far - density[2] * near) / (far - near);
        }
        density
    }
}

/// The transpose of [`SolidFem::per_area`]: from derivatives by the density to those by nodal values.
pub fn per_area_row(solid: &SolidFem, density: &mut [f64], sign: f64, odd: [bool; 2]) -> Vec<f64> {
    let Recoveries { areas, masses: [x, y], .. } = &solid.recoveries;
    let over_areas = |values: &[f64]| -> Vec<f64> {
        // The node on the axis of a disc has no area and does not contribute.
        let share = |(area, value): (&f64, &f64)| match *value {
            0.0 => 0.0,
            value => sign * value / area,
        };
        areas.iter().zip(values).map(share).collect()
    };
    solid.axis_row(density);
    solid.vanish_on_planes(density, odd);
    let mut row = over_areas(density);
    let one = Mat::from_fn(1, 1, |_, _| 1.0);
    let met = transform(&row, [x, y, &one], Side::Transposed);
    let mut first: Vec<f64> = density.iter().zip(met).map(|(d, met)| d - sign * met).collect();
    solid.vanish_on_planes(&mut first, odd);
    solid.axis_row(&mut first);
    row.iter_mut().zip(over_areas(&first)).for_each(|(row, own)| *row += own);
    row
}

impl SolidFem {
    /// The transpose of [`SolidFem::with_axis`].
    fn axis_row(&self, density: &mut [f64]) {
        let x = &self.mesh.axes[0];
        if self.mesh.geometry == Geometry::Axisymmetric && x.start() == 0.0 && x.order > 1 {
            let [near, far] = [x.nodes[1].powi(2), x.nodes[2].powi(2)];
            let centre = std::mem::take(&mut density[0]);
            density[1] += centre * far / (far - near);
            density[2] -= centre * near / (far - near);
        }
    }
}

impl Weights {
    /// Weighted sum of values; zero for an empty list.
    pub(super) fn of(&self, values: &[f64]) -> f64 {
        let part = values.iter().skip(self.first);
        self.values.iter().zip(part).map(|(w, value)| w * value).sum()
    }
}

/// Weights of sampling points: recovery to the nodes around a place, followed by their shape functions.
pub fn through(nodes: &Weights, recovery: &Recovery) -> Weights {
    let matrix = &recovery.samples;
    let mut all = vec![0.0; matrix.ncols()];
    for (i, value) in nodes.values.iter().enumerate() {
        for (j, weight) in all.iter_mut().enumerate() {
            *weight += value * matrix[(nodes.first + i, j)];
        }
    }
    let first = all.iter().position(|&w| w != 0.0).unwrap_or(0);
    let last = all.iter().rposition(|&w| w != 0.0).unwrap_or(0);
    Weights { first, values: all[first..=last].to_vec() }
}

/// Adds values on a horizontal face, weighted for each layer of nodes.
fn add_outer(nodal: &mut [f64], weights: &[f64], face: &[f64]) {
    if face.is_empty() || weights.is_empty() {
        return;
    }
    for (layer, weight) in nodal.chunks_exact_mut(face.len()).zip(weights) {
        if *weight != 0.0 {
            layer.iter_mut().zip(face).for_each(|(value, known)| *value += weight * known);
        }
    }
}

/// Returns true if the body continues, as a mirror image, below the low end of an axis of the mesh.
fn continues(mesh: &Mesh, axis: usize) -> bool {
    match mesh.geometry {
        Geometry::Box => axis < 2 && mesh.mirrored[axis],
        Geometry::Axisymmetric => axis == 0 && mesh.axes[0].start() == 0.0,
    }
}

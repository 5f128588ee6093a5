//! Loops over the elements of a section: forces, stiffness, the energy that drives damage, and sums.

use super::section::{POINTS, Point, Section};
use crate::laws::fracture::{Components, DEGRADED, GradientDamage, PointResponse, degradation};
use crate::math::nine_point::{Grid, NinePoint};
use crate::runtime::parallel::Team;

/// Rows of elements whose matrices are held at a time.
const ROWS: usize = 16;

/// A section of one material.
#[derive(Debug, Clone)]
pub struct Elements {
    pub section: Section,
    pub law: GradientDamage,
    pub grid: Grid,
}

/// Nodal values at a moment.
#[derive(Debug, Clone, Copy)]
pub struct Nodal<'a> {
    /// [m], both components of a node together.
    pub displacement: &'a [f64],
    /// [1]
    pub damage: &'a [f64],
    /// Temperature above the stress-free one [K].
    pub rise: &'a [f64],
}

/// Energy of the points that cracks release [J/m³], element by element.
pub type Released = Vec<[f64; POINTS]>;

/// Sums over a section [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    pub elastic: f64,
    pub dissipated: f64,
}

impl Elements {
    pub fn new(section: Section, law: GradientDamage) -> Self {
        Self { grid: section.grid(), section, law }
    }

    fn gather<const N: usize>(&self, element: [usize; 2], nodal: &[f64]) -> [f64; N] {
        let width = N / 4;
        let corners = self.grid.corners(element);
        std::array::from_fn(|k| nodal[corners[k / width] * width + k % width])
    }

    /// Size of an element across a crack [m]: the geometric mean of its edges.
    fn size(&self, element: [usize; 2]) -> f64 {
        let [width, height] = self.section.size(element);
        (width * height).sqrt()
    }

    /// Calls back for the points of an element with their responses.
    fn each_point(
        &self,
        element: [usize; 2],
        nodal: &Nodal,
        mut visit: impl FnMut(usize, &Point, &PointResponse),
    ) {
        self.each_strain(element, nodal, |q, point, strain, damage| {
            visit(q, point, &self.law.respond(strain, damage));
        });
    }

    /// Calls back for the points of an element with their elastic strain and damage.
    pub(super) fn each_strain(
        &self,
        element: [usize; 2],
        nodal: &Nodal,
        mut visit: impl FnMut(usize, &Point, Components, f64),
    ) {
        let u: [f64; 8] = self.gather(element, nodal.displacement);
        let damage: [f64; 4] = self.gather(element, nodal.damage);
        let rise: [f64; 4] = self.gather(element, nodal.rise);
        for (q, point) in self.section.points(element).iter().enumerate() {
            let thermal = self.law.expansion * point.interpolate(&rise);
            let mut strain = point.strain(&u);
            strain[..3].iter_mut().for_each(|strain| *strain -= thermal);
            visit(q, point, strain, point.interpolate(&damage));
        }
    }

    /// Forces of an element by a stress of its points.
    pub(super) fn nodal_forces(
        &self,
        element: [usize; 2],
        nodal: &Nodal,
        stress: impl Fn(Components, f64) -> Components,
    ) -> [f64; 8] {
        let mut forces = [0.0; 8];
        self.each_strain(element, nodal, |_, point, strain, damage| {
            let stress = stress(strain, damage);
            for (k, force) in forces.iter_mut().enumerate() {
                *force += point.volume * dot(&point.unit_strains(k / 2)[k % 2], &stress);
            }
        });
        forces
    }

    pub(super) fn intact_tangent(&self) -> [Components; 4] {
        self.law.respond([0.0; 4], 0.0).stiffness.tangent()
    }

    /// Stiffness of an intact element.
    fn intact(&self, element: [usize; 2]) -> Box<[f64; 64]> {
        let tangent = self.intact_tangent();
        let mut stiffness = Box::new([0.0; 64]);
        for point in &self.section.points(element) {
            let strains = std::array::from_fn(|k| point.unit_strains(k / 2)[k % 2]);
            add_stiffness(&mut stiffness, point, &strains, tangent);
        }
        mirror(&mut stiffness);
        stiffness
    }

    /// Stiffness of the intact section.
    pub fn intact_stiffness(&self, team: &Team) -> NinePoint<2> {
        let mut matrix = NinePoint::zeros(self.grid);
        let [columns, rows] = self.grid.elements();
        for first in (0..rows).step_by(ROWS) {
            let found = team.map((rows - first).min(ROWS), |row| {
                (0..columns).map(|i| self.intact([i, first + row])).collect::<Vec<_>>()
            });
            for (row, own) in found.iter().enumerate() {
                for (i, element) in own.iter().enumerate() {
                    matrix.add_element([i, first + row], &element[..]);
                }
            }
        }
        matrix
    }

    /// Computes nodal forces of the stresses [N].
    pub fn forces(&self, nodal: &Nodal, team: &Team) -> Vec<f64> {
        let [columns, rows] = self.grid.elements();
        let mut forces = vec![0.0; 2 * self.grid.nodes()];
        let stress = |strain, damage| self.law.respond(strain, damage).stress;
        // Computed on all threads, added in fixed order.
        for first in (0..rows).step_by(ROWS) {
            let found = team.map((rows - first).min(ROWS), |row| {
                let of_row =
                    (0..columns).map(|i| self.nodal_forces([i, first + row], nodal, stress));
                of_row.collect::<Vec<_>>()
            });
            for (row, own) in found.iter().enumerate() {
                for (i, element) in own.iter().enumerate() {
                    add_forces(&mut forces, self.grid.corners([i, first + row]), element);
                }
            }
        }
        forces
    }

    /// Computes the energy that cracks release.
    pub fn released(&self, nodal: &Nodal, team: &Team) -> Released {
        let [columns, rows] = self.grid.elements();
        let mut released = vec![[0.0; POINTS]; columns * rows];
        let mut of_rows: Vec<_> = released.chunks_mut(columns).collect();
        team.for_each(&mut of_rows, |row, own| {
            for (i, own) in own.iter_mut().enumerate() {
                self.each_strain([i, row], nodal, |q, _, strain, _| {
                    own[q] = self.law.released(strain)
                });
            }
        });
        released
    }

    /// Assembles the conditions on damage under given energies: `A d = b` where nothing bounds it.
    ///
    /// The energy `(1 − d)²ψ + G_c/c_w (w/ℓ + ℓ|∇d|²)` is quadratic in d.
    pub fn damage_system(
        &self,
        released: &Released,
        matrix: &mut NinePoint<1>,
        team: &Team,
    ) -> Vec<f64> {
        use crate::laws::fracture::Dissipation::{At1, At2};
        let [columns, rows] = self.grid.elements();
        matrix.clear();
        let mut load = vec![0.0; self.grid.nodes()];
        for first in (0..rows).step_by(ROWS) {
            let found = team.map((rows - first).min(ROWS), |row| {
                let of_element = |i: usize| {
                    let place = [i, first + row];
                    let [local, spread] = self.law.weights(self.size(place), place);
                    let (mut own, mut b) = ([0.0; 16], [0.0; 4]);
                    for (point, psi) in self
                        .section
                        .points(place)
                        .iter()
                        .zip(released[place[0] + columns * place[1]])
                    {
                        let psi = DEGRADED * psi;
                        let (mass, pull) = match self.law.dissipation {
                            At1 => (2.0 * psi, 2.0 * psi - local),
                            At2 => (2.0 * (psi + local), 2.0 * psi),
                        };
                        for r in 0..4 {
                            b[r] += point.volume * pull * point.shape[r];
                            for c in 0..4 {
                                let slopes = &point.slopes;
                                let gradients =
                                    slopes[0][r] * slopes[0][c] + slopes[1][r] * slopes[1][c];
                                own[4 * r + c] += point.volume
                                    * (mass * point.shape[r] * point.shape[c]
                                        + 2.0 * spread * gradients);
                            }
                        }
                    }
                    (own, b)
                };
                (0..columns).map(of_element).collect::<Vec<_>>()
            });
            for (row, elements) in found.iter().enumerate() {
                for (i, (own, b)) in elements.iter().enumerate() {
                    let place = [i, first + row];
                    matrix.add_element(place, own);
                    for (node, b) in self.grid.corners(place).into_iter().zip(b) {
                        load[node] += b;
                    }
                }
            }
        }
        load
    }

    /// Energies of a moment [J].
    pub fn energies(&self, nodal: &Nodal, team: &Team) -> Energies {
        let sums = self.by_rows(team, |place, sum: &mut Energies| {
            let damage: [f64; 4] = self.gather(place, nodal.damage);
            let weights = self.law.weights(self.size(place), place);
            self.each_point(place, nodal, |_, point, response| {
                let own = point.interpolate(&damage);
                let elastic = degradation(own) * response.released + response.remaining;
                sum.elastic += point.volume * elastic;
                let gradient = point.gradient(&damage);
                sum.dissipated += point.volume * self.law.dissipated(weights, own, gradient);
            });
        });
        sums.iter().fold(Energies::default(), |all, row| Energies {
            elastic: all.elastic + row.elastic,
            dissipated: all.dissipated + row.dissipated,
        })
    }

    /// Work of the stress of a moment on a change of temperatures, `−∫ σ : α ΔT dV` [J].
    pub fn thermal_work(&self, nodal: &Nodal, change: &[f64], team: &Team) -> f64 {
        let sums = self.by_rows(team, |place, sum: &mut f64| {
            let change: [f64; 4] = self.gather(place, change);
            self.each_point(place, nodal, |_, point, response| {
                let strain = self.law.expansion * point.interpolate(&change);
                *sum -= point.volume * strain * response.stress[..3].iter().sum::<f64>();
            });
        });
        sums.iter().sum()
    }

    /// Sums over the elements of each row.
    fn by_rows<T: Default + Send>(
        &self,
        team: &Team,
        add: impl Fn([usize; 2], &mut T) + Sync,
    ) -> Vec<T> {
        let [columns, rows] = self.grid.elements();
        team.map(rows, |row| {
            let mut sum = T::default();
            (0..columns).for_each(|i| add([i, row], &mut sum));
            sum
        })
    }

    /// Stress at the nodes: means of the points of the elements around, by their volumes [Pa].
    pub fn nodal_stress(&self, nodal: &Nodal) -> Vec<Components> {
        let mut sums = vec![([0.0; 4], 0.0); self.grid.nodes()];
        let [columns, rows] = self.grid.elements();
        for place in (0..rows).flat_map(|j| (0..columns).map(move |i| [i, j])) {
            let corners = self.grid.corners(place);
            self.each_point(place, nodal, |q, point, response| {
                // The nearest point of an element represents its corner.
                let (stress, volume) = &mut sums[corners[q]];
                *volume += point.volume;
                for (sum, own) in stress.iter_mut().zip(&response.stress) {
                    *sum += point.volume * own;
                }
            });
        }
        sums.into_iter().map(|(stress, volume)| stress.map(|sum| sum / volume)).collect()
    }
}

/// Adds the forces of an element to those of all nodes.
pub(super) fn add_forces(forces: &mut [f64], corners: [usize; 4], element: &[f64; 8]) {
    for (a, node) in corners.into_iter().enumerate() {
        forces[2 * node] += element[2 * a];
        forces[2 * node + 1] += element[2 * a + 1];
    }
}

/// Adds the part of a point to the lower triangle of an element's stiffness.
pub(super) fn add_stiffness(
    stiffness: &mut [f64; 64],
    point: &Point,
    strains: &[Components; 8],
    tangent: [Components; 4],
) {
    for (column, strain) in strains.iter().enumerate() {
        let stress = tangent.map(|row| point.volume * dot(&row, strain));
        for (row, strain) in strains.iter().enumerate().skip(column) {
            stiffness[row * 8 + column] += dot(strain, &stress);
        }
    }
}

/// Copies the lower triangle of an element's stiffness to the upper one.
pub(super) fn mirror(stiffness: &mut [f64; 64]) {
    for row in 0..8 {
        for column in 0..row {
            stiffness[column * 8 + row] = stiffness[row * 8 + column];
        }
    }
}

pub(super) fn dot(a: &Components, b: &Components) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

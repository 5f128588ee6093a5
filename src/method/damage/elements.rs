//! Loops over the elements of a domain: forces, stiffness, the energy that drives damage, and sums.

use super::domain::{Domain, Kinematics, Point};
use crate::laws::fracture::{DEGRADED, Dissipation, GradientDamage, PointResponse, degradation};
use crate::math::grid_matrix::{Grid, GridMatrix};
use crate::runtime::parallel::Team;

/// Rows of elements, and elements, whose matrices are held at a time.
const ROWS: usize = 16;
pub(super) const AT_A_TIME: usize = 1 << 12;

/// A domain of one material, in elements of `C` corners, with strains of `V` components.
#[derive(Debug, Clone)]
pub struct Elements<const D: usize, const C: usize, const V: usize> {
    pub domain: Domain<D>,
    pub law: GradientDamage,
    pub grid: Grid<D>,
}

/// Elements of a section, and in space.
pub type PlaneElements = Elements<2, 4, 4>;
pub type Bricks = Elements<3, 8, 6>;

/// Principal axes of the strains of a point.
type Axes<const D: usize, const C: usize, const V: usize> =
    <Point<D, C> as Kinematics<D, C, V>>::Axes;

/// Nodal values at a moment.
#[derive(Debug, Clone, Copy)]
pub struct Nodal<'a> {
    /// [m], all components of a node together.
    pub displacement: &'a [f64],
    /// [1]
    pub damage: &'a [f64],
    /// Temperature above the stress-free one [K].
    pub rise: &'a [f64],
}

/// Energy of the points that cracks release [J/m³], element by element.
pub type Released<const C: usize> = Vec<[f64; C]>;

/// Sums over a domain [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    pub elastic: f64,
    pub dissipated: f64,
}

impl<const D: usize, const C: usize, const V: usize> Elements<D, C, V>
where
    Point<D, C>: Kinematics<D, C, V>,
{
    pub fn new(domain: Domain<D>, law: GradientDamage) -> Self {
        Self { grid: domain.grid(), domain, law }
    }

    /// Values of a nodal field at the corners of an element.
    fn gather(&self, element: [usize; D], nodal: &[f64]) -> [f64; C] {
        self.grid.corners::<C>(element).map(|node| nodal[node])
    }

    /// Displacements of the corners of an element [m].
    fn gather_vectors(&self, element: [usize; D], nodal: &[f64]) -> [[f64; D]; C] {
        let own = |node| std::array::from_fn(|axis| nodal[D * node + axis]);
        self.grid.corners::<C>(element).map(own)
    }

    /// Response of a point to its elastic strain.
    pub(super) fn respond(&self, strain: [f64; V], damage: f64) -> PointResponse<V> {
        self.law.respond::<Axes<D, C, V>, V>(strain, damage)
    }

    /// Derivatives of the stress of a point by its elastic strain [Pa].
    pub(super) fn tangent(&self, strain: [f64; V], damage: f64) -> [[f64; V]; V] {
        self.law.tangent::<Axes<D, C, V>, V>(strain, damage)
    }

    /// Calls back for the points of an element with their responses.
    fn each_point(
        &self,
        element: [usize; D],
        nodal: &Nodal,
        mut visit: impl FnMut(usize, &Point<D, C>, &PointResponse<V>),
    ) {
        self.each_strain(element, nodal, |q, point, strain, damage| {
            visit(q, point, &self.respond(strain, damage));
        });
    }

    /// Calls back for the points of an element with their elastic strain and damage.
    pub(super) fn each_strain(
        &self,
        element: [usize; D],
        nodal: &Nodal,
        mut visit: impl FnMut(usize, &Point<D, C>, [f64; V], f64),
    ) {
        let u = self.gather_vectors(element, nodal.displacement);
        let damage = self.gather(element, nodal.damage);
        let rise = self.gather(element, nodal.rise);
        for (q, point) in self.domain.points(element).iter().enumerate() {
            let thermal = self.law.expansion * point.interpolate(&rise);
            let mut strain = point.strain(&u);
            strain[..3].iter_mut().for_each(|strain| *strain -= thermal);
            visit(q, point, strain, point.interpolate(&damage));
        }
    }

    /// Forces of an element by a stress of its points.
    pub(super) fn nodal_forces(
        &self,
        element: [usize; D],
        nodal: &Nodal,
        stress: impl Fn([f64; V], f64) -> [f64; V],
    ) -> [[f64; D]; C] {
        let mut forces = [[0.0; D]; C];
        self.each_strain(element, nodal, |_, point, strain, damage| {
            let stress = stress(strain, damage);
            for (corner, forces) in forces.iter_mut().enumerate() {
                for (force, unit) in forces.iter_mut().zip(&point.unit_strains(corner)) {
                    *force += point.volume * dot(unit, &stress);
                }
            }
        });
        forces
    }

    pub(super) fn intact_tangent(&self) -> [[f64; V]; V] {
        self.tangent([0.0; V], 0.0)
    }

    /// Stiffness of an element without any, row by row, with all components of a corner together.
    pub(super) fn no_stiffness() -> Vec<f64> {
        vec![0.0; (C * D) * (C * D)]
    }

    /// Adds the part of a point to the lower triangle of an element's stiffness.
    pub(super) fn add_stiffness(
        stiffness: &mut [f64],
        point: &Point<D, C>,
        tangent: &[[f64; V]; V],
    ) {
        let strains: [[[f64; V]; D]; C] = std::array::from_fn(|corner| point.unit_strains(corner));
        let strains = strains.as_flattened();
        for (column, strain) in strains.iter().enumerate() {
            let stress = tangent.map(|row| point.volume * dot(&row, strain));
            for (row, strain) in strains.iter().enumerate().skip(column) {
                stiffness[row * C * D + column] += dot(strain, &stress);
            }
        }
    }

    /// Copies the lower triangle of an element's stiffness to the upper one.
    pub(super) fn mirror(stiffness: &mut [f64]) {
        for row in 0..C * D {
            for column in 0..row {
                stiffness[column * C * D + row] = stiffness[row * C * D + column];
            }
        }
    }

    /// Stiffness of an intact element.
    fn intact(&self, element: [usize; D]) -> Vec<f64> {
        let tangent = self.intact_tangent();
        let mut stiffness = Self::no_stiffness();
        for point in &self.domain.points(element) {
            Self::add_stiffness(&mut stiffness, point, &tangent);
        }
        Self::mirror(&mut stiffness);
        stiffness
    }

    /// Stiffness of the intact domain.
    pub fn intact_stiffness(&self, team: &Team) -> GridMatrix<D, D> {
        let mut matrix = GridMatrix::zeros(self.grid);
        let (columns, rows) = (self.grid.elements()[0], self.grid.rows());
        for first in (0..rows).step_by(ROWS) {
            let found = team.map((rows - first).min(ROWS), |row| {
                (0..columns)
                    .map(|i| self.intact(self.grid.element(i, first + row)))
                    .collect::<Vec<_>>()
            });
            for (row, own) in found.iter().enumerate() {
                for (i, element) in own.iter().enumerate() {
                    matrix.add_element::<C>(self.grid.element(i, first + row), element);
                }
            }
        }
        matrix
    }

    /// Computes nodal forces of the stresses [N].
    pub fn forces(&self, nodal: &Nodal, team: &Team) -> Vec<f64> {
        let (columns, rows) = (self.grid.elements()[0], self.grid.rows());
        let mut forces = vec![0.0; D * self.grid.nodes()];
        let stress = |strain, damage| self.respond(strain, damage).stress;
        // Computed on all threads, added in fixed order.
        for first in (0..rows).step_by(ROWS) {
            let found = team.map((rows - first).min(ROWS), |row| {
                let of_element =
                    |i| self.nodal_forces(self.grid.element(i, first + row), nodal, stress);
                (0..columns).map(of_element).collect::<Vec<_>>()
            });
            for (row, own) in found.iter().enumerate() {
                for (i, element) in own.iter().enumerate() {
                    self.add_forces(&mut forces, self.grid.element(i, first + row), element);
                }
            }
        }
        forces
    }

    /// Computes the energy that cracks release.
    pub fn released(&self, nodal: &Nodal, team: &Team) -> Released<C> {
        let (columns, rows) = (self.grid.elements()[0], self.grid.rows());
        let mut released = vec![[0.0; C]; columns * rows];
        let mut of_rows: Vec<_> = released.chunks_mut(columns).collect();
        team.for_each(&mut of_rows, |row, own| {
            for (i, own) in own.iter_mut().enumerate() {
                self.each_strain(self.grid.element(i, row), nodal, |q, _, strain, _| {
                    own[q] = self.law.released::<Axes<D, C, V>, V>(strain)
                });
            }
        });
        released
    }

    /// Number of nodes across the damage beside a crack, which reaches 2ℓ with AT1.
    pub fn reach_of_damage(&self) -> usize {
        let size = self.domain.mean_size([0; D]);
        (2.0 * self.law.length / size).ceil() as usize
    }

    /// Nodes whose damage may differ from zero, with a margin around: all but those around which nothing is damaged and
    /// the energy that a crack releases is below that of damage.
    pub fn endangered(&self, released: &Released<C>, damage: &[f64], margin: usize) -> Vec<bool> {
        let columns = self.grid.elements()[0];
        if self.law.dissipation == Dissipation::At2 {
            return vec![true; self.grid.nodes()];
        }
        let mut endangered = vec![false; self.grid.nodes()];
        for (n, energies) in released.iter().enumerate() {
            let place = self.grid.element(n % columns, n / columns);
            let corners = self.grid.corners::<C>(place);
            let [local, _] = self.law.weights(self.domain.mean_size(place), place);
            let is_quiet = energies.iter().all(|psi| 2.0 * DEGRADED * psi < local)
                && corners.iter().all(|&node| damage[node] == 0.0);
            if !is_quiet {
                corners.iter().for_each(|&node| endangered[node] = true);
            }
        }
        (0..margin).for_each(|_| endangered = self.grid.dilated(&endangered));
        endangered
    }

    /// Assembles the conditions on damage of some nodes under given energies: `A d = b` where nothing bounds it.
    ///
    /// The energy `(1 − d)²ψ + G_c/c_w (w/ℓ + ℓ|∇d|²)` is quadratic in d.
    pub fn damage_system(
        &self,
        released: &Released<C>,
        wanted: &[bool],
        matrix: &mut GridMatrix<D, 1>,
        team: &Team,
    ) -> Vec<f64> {
        let columns = self.grid.elements()[0];
        let is_wanted = |&n: &usize| {
            let corners = self.grid.corners::<C>(self.grid.element(n % columns, n / columns));
            corners.iter().any(|&node| wanted[node])
        };
        let elements: Vec<usize> = (0..released.len()).filter(is_wanted).collect();
        matrix.clear();
        let mut load = vec![0.0; self.grid.nodes()];
        for some in elements.chunks(AT_A_TIME) {
            let found = team.map(some.len(), |k| {
                let n = some[k];
                self.damage_of_element(self.grid.element(n % columns, n / columns), &released[n])
            });
            for (&n, (own, b)) in some.iter().zip(&found) {
                let place = self.grid.element(n % columns, n / columns);
                matrix.add_element::<C>(place, own.as_flattened());
                for (node, b) in self.grid.corners::<C>(place).into_iter().zip(b) {
                    load[node] += b;
                }
            }
        }
        load
    }

    /// Part of an element in the conditions on damage.
    fn damage_of_element(
        &self,
        place: [usize; D],
        released: &[f64; C],
    ) -> ([[f64; C]; C], [f64; C]) {
        let [local, spread] = self.law.weights(self.domain.mean_size(place), place);
        let (mut own, mut b) = ([[0.0; C]; C], [0.0; C]);
        let points: [Point<D, C>; C] = self.domain.points(place);
        for (point, psi) in points.iter().zip(released) {
            let psi = DEGRADED * psi;
            let (mass, pull) = match self.law.dissipation {
                Dissipation::At1 => (2.0 * psi, 2.0 * psi - local),
                Dissipation::At2 => (2.0 * (psi + local), 2.0 * psi),
            };
            for r in 0..C {
                b[r] += point.volume * pull * point.shape[r];
                for c in 0..C {
                    let gradients: f64 =
                        point.slopes.iter().map(|slopes| slopes[r] * slopes[c]).sum();
                    own[r][c] += point.volume
                        * (mass * point.shape[r] * point.shape[c] + 2.0 * spread * gradients);
                }
            }
        }
        (own, b)
    }

    /// Energies of a moment [J].
    pub fn energies(&self, nodal: &Nodal, team: &Team) -> Energies {
        let sums = self.by_rows(team, |place, sum: &mut Energies| {
            let damage = self.gather(place, nodal.damage);
            let weights = self.law.weights(self.domain.mean_size(place), place);
            self.each_point(place, nodal, |_, point, response| {
                let own = point.interpolate(&damage);
                let elastic = degradation(own) * response.released + response.remaining;
                sum.elastic += point.volume * elastic;
                let gradient = point.gradient(&damage);
                sum.dissipated += point.volume * self.law.dissipated(weights, own, &gradient);
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
            let change = self.gather(place, change);
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
        add: impl Fn([usize; D], &mut T) + Sync,
    ) -> Vec<T> {
        let (columns, rows) = (self.grid.elements()[0], self.grid.rows());
        team.map(rows, |row| {
            let mut sum = T::default();
            (0..columns).for_each(|i| add(self.grid.element(i, row), &mut sum));
            sum
        })
    }

    /// Stress at the nodes as xx, yy, zz, xy, yz and xz, where the normal of a section is y: means of the points of the
    /// elements around, by their volumes [Pa].
    pub fn nodal_stress(&self, nodal: &Nodal) -> Vec<[f64; 6]> {
        let mut sums = vec![([0.0; V], 0.0); self.grid.nodes()];
        let columns = self.grid.elements()[0];
        for row in 0..self.grid.rows() {
            for place in (0..columns).map(|i| self.grid.element(i, row)) {
                let corners = self.grid.corners::<C>(place);
                self.each_point(place, nodal, |q, point, response| {
                    // The nearest point of an element represents its corner.
                    let (stress, volume) = &mut sums[corners[q]];
                    *volume += point.volume;
                    for (sum, own) in stress.iter_mut().zip(&response.stress) {
                        *sum += point.volume * own;
                    }
                });
            }
        }
        let mean = |(stress, volume): ([f64; V], f64)| stress.map(|sum| sum / volume);
        sums.into_iter().map(|sum| Point::in_space(mean(sum))).collect()
    }

    /// Adds the forces of an element to those of all nodes.
    pub(super) fn add_forces(&self, forces: &mut [f64], element: [usize; D], own: &[[f64; D]; C]) {
        for (node, own) in self.grid.corners::<C>(element).into_iter().zip(own) {
            forces[D * node..][..D].iter_mut().zip(own).for_each(|(force, own)| *force += own);
        }
    }
}

pub(super) fn dot<const V: usize>(a: &[f64; V], b: &[f64; V]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

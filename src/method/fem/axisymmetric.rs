//! Quadrilateral elements of a meridian section: Lagrange shape functions of order 1 or 2.
//!
//! Strains are rr, tt (hoop), zz and rz (engineering shear); each node has the displacements along
//! r and z, and integrals go over the whole circle. The linear element carries enhanced assumed
//! strains whose mean over the ring vanishes, so that it repeats uniform stress (J. C. Simo and
//! M. S. Rifai 1990, doi 10.1002/nme.1620290802). The quadratic element projects its dilatation on
//! linear polynomials, as [`super::dilatation`] does.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

use crate::laws::Thermoelastic;
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::{shape, slope};

/// A rectangle of the meridian section [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    pub r: [f64; 2],
    pub z: [f64; 2],
}

/// Matrices of one element; nodes run r fastest.
pub struct QuadrilateralMatrices {
    order: usize,
    rectangle: Rectangle,
    /// `2 n × 2 n` [N/m]
    pub stiffness: DMatrix<f64>,
    /// `2 n × n` thermal force [N/K]
    pub thermal: DMatrix<f64>,
    locking: LockingTreatment,
}

/// Treatment that keeps the element from locking.
enum LockingTreatment {
    Enhanced(Enhanced),
    Projected(Projected),
}

/// The projection of the dilatation: coefficients of `1, ξ, η` per displacement and per degree.
struct Projected {
    by_displacement: DMatrix<f64>,
    by_temperature: DMatrix<f64>,
    expansion: f64,
}

/// The condensed strain modes: their amplitudes follow from displacements and temperatures.
struct Enhanced {
    /// Mean of each mode's polynomial over the ring.
    means: [f64; MODES],
    /// Amplitudes per displacement and per degree.
    by_displacement: DMatrix<f64>,
    by_temperature: DMatrix<f64>,
}

const MODES: usize = 7;

/// Strain component (rr, tt, zz, rz) and local polynomial.
pub type Mode = (usize, fn(f64, f64) -> f64);

/// The enhanced modes.
pub const ENHANCED: [Mode; MODES] = [
    (0, |xi, _| xi),
    (0, |xi, eta| xi * eta),
    (1, |xi, eta| xi * eta),
    (2, |_, eta| eta),
    (2, |xi, eta| xi * eta),
    (3, |xi, _| xi),
    (3, |_, eta| eta),
];

/// Values at one quadrature or sampling point.
struct Point {
    place: [f64; 2],
    weight: f64,
    values: DVector<f64>,
    /// `4 × 2 n`
    strain: DMatrix<f64>,
}

impl QuadrilateralMatrices {
    pub fn new(order: usize, rectangle: Rectangle, law: &Thermoelastic) -> Self {
        // The quadratic element takes its volume stress from the projection alone.
        let lambda = if order == 1 { law.lame_first() } else { 0.0 };
        let elastic = elasticity(lambda, law.shear_modulus());
        let modulus = (3.0 * lambda + 2.0 * law.shear_modulus()) * law.expansion;
        let points = quadrature(order, rectangle);
        let n = (order + 1) * (order + 1);
        let mut stiffness = DMatrix::zeros(2 * n, 2 * n);
        let mut thermal = DMatrix::zeros(2 * n, n);
        for point in &points {
            let b = &point.strain;
            stiffness += b.transpose() * elastic * b * point.weight;
            let forces = b.transpose() * volume() * (modulus * point.weight);
            thermal += forces * point.values.transpose();
        }
        let locking = match order {
            1 => LockingTreatment::Enhanced(Enhanced::new(&points, &elastic, modulus)),
            _ => LockingTreatment::Projected(Projected::new(&points, law)),
        };
        let mut element = Self { order, rectangle, stiffness, thermal, locking };
        element.treat_locking(&points, &elastic, law);
        element
    }

    /// Returns the strains rr, tt, zz and rz at a local place that determine the element's stress.
    pub fn strain(&self, xi: f64, eta: f64, displacement: &[f64], temperature: &[f64]) -> [f64; 4] {
        let point = point_at(self.order, self.rectangle, xi, eta, 0.0);
        let u = DVector::from_column_slice(displacement);
        let t = DVector::from_column_slice(temperature);
        let compatible = &point.strain * &u;
        let mut strain = [0, 1, 2, 3].map(|i| compatible[i]);
        match &self.locking {
            LockingTreatment::Enhanced(enhanced) => {
                let amplitudes = &enhanced.by_displacement * u + &enhanced.by_temperature * t;
                for (m, (component, f)) in ENHANCED.iter().enumerate() {
                    strain[*component] += amplitudes[m] * (f(xi, eta) - enhanced.means[m]);
                }
            }
            LockingTreatment::Projected(projected) => {
                let c = &projected.by_displacement * u + &projected.by_temperature * &t;
                let thermal = 3.0 * projected.expansion * point.values.dot(&t);
                let wanted = c[0] + c[1] * xi + c[2] * eta + thermal;
                let change = (wanted - strain[0] - strain[1] - strain[2]) / 3.0;
                strain[..3].iter_mut().for_each(|e| *e += change);
            }
        }
        strain
    }

    fn treat_locking(&mut self, points: &[Point], elastic: &Matrix4<f64>, law: &Thermoelastic) {
        match &self.locking {
            LockingTreatment::Enhanced(enhanced) => {
                // Condensation: K + K_uaᵀ a_u and C − K_uaᵀ a_T with the amplitudes a.
                let coupling = enhanced.coupling(points, elastic).transpose();
                self.stiffness += &coupling * &enhanced.by_displacement;
                self.thermal -= &coupling * &enhanced.by_temperature;
            }
            LockingTreatment::Projected(projected) => {
                let moments = Projected::dilatation_moments(points).transpose() * law.lame_first();
                self.stiffness += &moments * &projected.by_displacement;
                self.thermal -= &moments * &projected.by_temperature;
            }
        }
    }
}

impl Projected {
    fn new(points: &[Point], law: &Thermoelastic) -> Self {
        let mut gram = DMatrix::<f64>::zeros(3, 3);
        let mut values = DMatrix::<f64>::zeros(3, points[0].values.len());
        for point in points {
            let psi = DVector::from_column_slice(&[1.0, point.place[0], point.place[1]]);
            gram += &psi * psi.transpose() * point.weight;
            values += psi * point.values.transpose() * point.weight;
        }
        let inverse = gram.cholesky().expect("linear polynomials are independent").inverse();
        Self {
            by_displacement: &inverse * Self::dilatation_moments(points),
            by_temperature: inverse * values * (-3.0 * law.expansion),
            expansion: law.expansion,
        }
    }

    /// `∫ ψ_m tr ε dV` per displacement.
    fn dilatation_moments(points: &[Point]) -> DMatrix<f64> {
        let mut moments = DMatrix::zeros(3, points[0].strain.ncols());
        for point in points {
            let psi = DVector::from_column_slice(&[1.0, point.place[0], point.place[1]]);
            let dilatation = volume().transpose() * &point.strain;
            moments += psi * dilatation * point.weight;
        }
        moments
    }
}

impl Enhanced {
    fn new(points: &[Point], elastic: &Matrix4<f64>, thermal_modulus: f64) -> Self {
        let mut element = Self {
            means: mode_means(points),
            by_displacement: DMatrix::zeros(0, 0),
            by_temperature: DMatrix::zeros(0, 0),
        };
        let mut own = DMatrix::<f64>::zeros(MODES, MODES);
        let mut load = DMatrix::<f64>::zeros(MODES, points[0].values.len());
        for point in points {
            let modes = element.modes(point);
            own += modes.transpose() * elastic * &modes * point.weight;
            let forces = modes.transpose() * volume() * (thermal_modulus * point.weight);
            load += forces * point.values.transpose();
        }
        let inverse = own.cholesky().expect("enhanced modes are independent").inverse();
        element.by_displacement = -(&inverse * element.coupling(points, elastic));
        element.by_temperature = inverse * load;
        element
    }

    /// `∫ Eᵀ D B dV` of the modes E.
    fn coupling(&self, points: &[Point], elastic: &Matrix4<f64>) -> DMatrix<f64> {
        let mut coupling = DMatrix::<f64>::zeros(MODES, points[0].strain.ncols());
        for point in points {
            coupling += self.modes(point).transpose() * elastic * &point.strain * point.weight;
        }
        coupling
    }

    fn modes(&self, point: &Point) -> DMatrix<f64> {
        let [xi, eta] = point.place;
        let mut modes = DMatrix::<f64>::zeros(4, MODES);
        for (m, (component, f)) in ENHANCED.iter().enumerate() {
            modes[(*component, m)] = f(xi, eta) - self.means[m];
        }
        modes
    }
}

fn mode_means(points: &[Point]) -> [f64; MODES] {
    let volume: f64 = points.iter().map(|point| point.weight).sum();
    ENHANCED.map(|(_, f)| {
        let sum: f64 = points.iter().map(|p| p.weight * f(p.place[0], p.place[1])).sum();
        sum / volume
    })
}

/// Gauss points of the element; one more each way than a brick needs, for the weight r.
fn quadrature(order: usize, rectangle: Rectangle) -> Vec<Point> {
    let points = gauss_legendre(order + 2);
    let mut out = Vec::with_capacity(points.len() * points.len());
    for &(eta, we) in &points {
        for &(xi, wx) in &points {
            out.push(point_at(order, rectangle, xi, eta, wx * we));
        }
    }
    out
}

/// The strain of a unit expansion.
fn volume() -> Vector4<f64> {
    Vector4::new(1.0, 1.0, 1.0, 0.0)
}

/// Isotropic elasticity for rr, tt, zz and rz.
fn elasticity(lambda: f64, shear: f64) -> Matrix4<f64> {
    let mut d = Matrix4::zeros();
    for i in 0..3 {
        for j in 0..3 {
            d[(i, j)] = lambda;
        }
        d[(i, i)] += 2.0 * shear;
    }
    d[(3, 3)] = shear;
    d
}

fn point_at(order: usize, rectangle: Rectangle, xi: f64, eta: f64, w: f64) -> Point {
    let n = order + 1;
    let [r0, r1] = rectangle.r;
    let [z0, z1] = rectangle.z;
    let (width, height) = (r1 - r0, z1 - z0);
    let r = 0.5 * (r0 + r1) + 0.5 * width * xi;
    let (nr, nz) = (shape(order, xi), shape(order, eta));
    let dr = slope(order, xi).map(|s| 2.0 * s / width);
    let dz = slope(order, eta).map(|s| 2.0 * s / height);
    let mut strain = DMatrix::zeros(4, 2 * n * n);
    let mut values = DVector::zeros(n * n);
    for j in 0..n {
        for i in 0..n {
            let a = i + n * j;
            values[a] = nr[i] * nz[j];
            strain[(0, 2 * a)] = dr[i] * nz[j];
            // On the axis the hoop strain u/r is the limit du/dr.
            strain[(1, 2 * a)] = if r > 0.0 { values[a] / r } else { dr[i] * nz[j] };
            strain[(2, 2 * a + 1)] = nr[i] * dz[j];
            strain[(3, 2 * a)] = nr[i] * dz[j];
            strain[(3, 2 * a + 1)] = dr[i] * nz[j];
        }
    }
    Point { place: [xi, eta], weight: w * TAU * r * width * height / 4.0, values, strain }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Thermoelastic {
        Thermoelastic { young: 200.0, poisson: 0.3, expansion: 1e-3 }
    }

    /// `u_r = a r`, `u_z = b z`.
    fn stretch(order: usize, rectangle: Rectangle, a: f64, b: f64) -> Vec<f64> {
        let n = order + 1;
        let at = |ends: [f64; 2], i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / order as f64;
        (0..n * n).flat_map(|k| [a * at(rectangle.r, k % n), b * at(rectangle.z, k / n)]).collect()
    }

    #[test]
    fn uniform_strain_is_repeated_exactly_and_expansion_is_free_of_stress() {
        let rectangle = Rectangle { r: [0.2, 0.7], z: [-0.4, -0.1] };
        for order in [1, 2] {
            let element = QuadrilateralMatrices::new(order, rectangle, &law());
            let n = (order + 1) * (order + 1);
            let u = stretch(order, rectangle, 2e-3, -1e-3);
            let strain = element.strain(0.3, -0.4, &u, &vec![0.0; n]);
            for (s, e) in strain.iter().zip([2e-3, 2e-3, -1e-3, 0.0]) {
                assert!((s - e).abs() < 1e-15, "order {order}: {strain:?}");
            }
            let free = stretch(order, rectangle, 1e-3, 1e-3);
            let internal = &element.stiffness * DMatrix::from_column_slice(2 * n, 1, &free);
            let thermal = &element.thermal * DMatrix::from_element(n, 1, 1.0);
            assert!((internal - thermal).abs().max() < 1e-13);
        }
    }

    #[test]
    fn axial_translation_is_force_free() {
        let rectangle = Rectangle { r: [0.0, 0.7], z: [-0.4, -0.1] };
        for order in [1, 2] {
            let element = QuadrilateralMatrices::new(order, rectangle, &law());
            let n = (order + 1) * (order + 1);
            let u = DMatrix::from_fn(2 * n, 1, |i, _| (i % 2) as f64);
            assert!((&element.stiffness * u).abs().max() < 1e-12);
        }
    }
}

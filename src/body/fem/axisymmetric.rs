//! Quadrilateral elements of a meridian section: Lagrange shape functions of order 1 or 2.
//!
//! Strains are rr, tt (hoop), zz and rz (engineering shear); each node has the displacements along
//! r and z, and integrals go over the whole circle. The linear element carries enhanced assumed
//! strains whose mean over the ring vanishes, so that it repeats uniform stress (J. C. Simo and
//! M. S. Rifai 1990, doi 10.1002/nme.1620290802).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix4, Vector4};

use crate::material::Thermoelastic;
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
    enhanced: Option<Enhanced>,
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

/// Strain component (rr, tt, zz, rz) and local polynomial of each enhanced mode.
const ENHANCED: [(usize, fn(f64, f64) -> f64); MODES] = [
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
    weight: f64,
    values: Vec<f64>,
    /// `4 × 2 n`
    strain: DMatrix<f64>,
}

impl QuadrilateralMatrices {
    pub fn new(order: usize, rectangle: Rectangle, law: &Thermoelastic) -> Self {
        let n = (order + 1) * (order + 1);
        let elastic = elasticity(law);
        let expansion = Vector4::new(1.0, 1.0, 1.0, 0.0) * law.thermal_modulus();
        let mut stiffness = DMatrix::zeros(2 * n, 2 * n);
        let mut thermal = DMatrix::zeros(2 * n, n);
        let points = gauss_legendre(order + 2);
        let places: Vec<_> = points
            .iter()
            .flat_map(|&(eta, we)| points.iter().map(move |&(xi, wx)| (xi, eta, wx * we)))
            .collect();
        for &(xi, eta, w) in &places {
            let point = point_at(order, rectangle, xi, eta, w);
            let b = &point.strain;
            stiffness += b.transpose() * elastic * b * point.weight;
            let forces = b.transpose() * expansion * point.weight;
            for (a, value) in point.values.iter().enumerate() {
                let column = thermal.column(a) + &forces * *value;
                thermal.set_column(a, &column);
            }
        }
        let mut element = Self { order, rectangle, stiffness, thermal, enhanced: None };
        if order == 1 {
            element.enhance(&places, &elastic, law);
        }
        element
    }

    /// Strains rr, tt, zz and rz at a local place, enhanced modes included.
    pub fn strain(&self, xi: f64, eta: f64, displacement: &[f64], temperature: &[f64]) -> [f64; 4] {
        let point = point_at(self.order, self.rectangle, xi, eta, 0.0);
        let u = DMatrix::from_column_slice(displacement.len(), 1, displacement);
        let compatible = &point.strain * &u;
        let mut strain = [0, 1, 2, 3].map(|i| compatible[i]);
        if let Some(enhanced) = &self.enhanced {
            let t = DMatrix::from_column_slice(temperature.len(), 1, temperature);
            let amplitudes = &enhanced.by_displacement * u + &enhanced.by_temperature * t;
            for (m, (component, f)) in ENHANCED.iter().enumerate() {
                strain[*component] += amplitudes[m] * (f(xi, eta) - enhanced.means[m]);
            }
        }
        strain
    }

    fn enhance(&mut self, places: &[(f64, f64, f64)], elastic: &Matrix4<f64>, law: &Thermoelastic) {
        let means = self.mode_means(places);
        let mut own = DMatrix::<f64>::zeros(MODES, MODES);
        let mut coupling = DMatrix::<f64>::zeros(MODES, 8);
        let mut load = DMatrix::<f64>::zeros(MODES, 4);
        for &(xi, eta, w) in places {
            let point = point_at(1, self.rectangle, xi, eta, w);
            let mut modes = DMatrix::<f64>::zeros(4, MODES);
            for (m, (component, f)) in ENHANCED.iter().enumerate() {
                modes[(*component, m)] = f(xi, eta) - means[m];
            }
            let stress = modes.transpose() * elastic * point.weight;
            own += &stress * &modes;
            coupling += &stress * &point.strain;
            let forces = modes.transpose()
                * Vector4::new(1.0, 1.0, 1.0, 0.0)
                * (law.thermal_modulus() * point.weight);
            for (a, value) in point.values.iter().enumerate() {
                let column = load.column(a) + &forces * *value;
                load.set_column(a, &column);
            }
        }
        let inverse = own.cholesky().expect("enhanced modes are independent").inverse();
        let by_displacement = -(&inverse * &coupling);
        let by_temperature = inverse * load;
        self.stiffness += coupling.transpose() * &by_displacement;
        self.thermal -= coupling.transpose() * &by_temperature;
        self.enhanced = Some(Enhanced { means, by_displacement, by_temperature });
    }

    fn mode_means(&self, places: &[(f64, f64, f64)]) -> [f64; MODES] {
        let mut sums = [0.0; MODES];
        let mut volume = 0.0;
        for &(xi, eta, w) in places {
            let weight = point_at(1, self.rectangle, xi, eta, w).weight;
            volume += weight;
            for (sum, (_, f)) in sums.iter_mut().zip(&ENHANCED) {
                *sum += weight * f(xi, eta);
            }
        }
        sums.map(|sum| sum / volume)
    }
}

/// Isotropic elasticity for rr, tt, zz and rz.
fn elasticity(law: &Thermoelastic) -> Matrix4<f64> {
    let (lambda, shear) = (law.lame_first(), law.shear_modulus());
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
    let mut values = vec![0.0; n * n];
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
    Point { weight: w * TAU * r * width * height / 4.0, values, strain }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> Thermoelastic {
        Thermoelastic {
            density: 1.0,
            specific_heat: 1.0,
            conductivity: 1.0,
            young: 200.0,
            poisson: 0.3,
            expansion: 1e-3,
        }
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
    fn a_shift_along_the_axis_costs_no_force() {
        let rectangle = Rectangle { r: [0.0, 0.7], z: [-0.4, -0.1] };
        for order in [1, 2] {
            let element = QuadrilateralMatrices::new(order, rectangle, &law());
            let n = (order + 1) * (order + 1);
            let u = DMatrix::from_fn(2 * n, 1, |i, _| (i % 2) as f64);
            assert!((&element.stiffness * u).abs().max() < 1e-12);
        }
    }
}

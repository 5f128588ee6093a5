//! Rings of a meridian section: strains rr, tt (hoop), zz and rz over whole circles.

use std::f64::consts::TAU;

use faer::Mat;

use crate::method::fem::Mesh;

/// Tables of shape functions, with a row per point and a column per node, and the places of the points.
pub struct Ring {
    values: Mat<f64>,
    /// Derivatives along the local r and z.
    slopes: [Mat<f64>; 2],
    /// Radii of the points of each element along r [m].
    radii: Vec<Vec<f64>>,
}

impl Ring {
    pub fn new(mesh: &Mesh, values: Mat<f64>, slopes: [Mat<f64>; 2]) -> Self {
        let axis = &mesh.axes[0];
        // The radius at a point follows from those of the nodes, which are equidistant.
        let order = axis.order;
        let radius = |element: usize, q: usize| {
            let node = |a: usize| axis.nodes[element * order + a % (order + 1)];
            (0..values.ncols()).map(|a| values[(q, a)] * node(a)).sum()
        };
        let radii =
            (0..axis.elements()).map(|e| (0..values.nrows()).map(|q| radius(e, q)).collect());
        Self { radii: radii.collect(), values, slopes }
    }

    /// Length of the circle through a point [m].
    pub fn circle(&self, element: usize, point: usize) -> f64 {
        TAU * self.radii[element][point]
    }

    pub fn strains(&self, element: usize, size: [f64; 3], u: &[f64], out: &mut [[f64; 6]]) {
        let (r, z) = u.split_at(self.values.ncols());
        let [across, along] = [2.0 / size[0], 2.0 / size[2]];
        for (q, strain) in out.iter_mut().enumerate() {
            let radius = self.radii[element][q];
            *strain = [0.0; 6];
            for (a, (r, z)) in r.iter().zip(z).enumerate() {
                let [dr, dz] = [self.slopes[0][(q, a)] * across, self.slopes[1][(q, a)] * along];
                strain[0] += dr * r;
                strain[1] += self.values[(q, a)] / radius * r;
                strain[2] += dz * z;
                strain[5] += dz * r + dr * z;
            }
        }
    }

    pub fn forces(&self, element: usize, size: [f64; 3], stress: &[[f64; 6]], out: &mut [f64]) {
        let (r, z) = out.split_at_mut(self.values.ncols());
        let [across, along] = [2.0 / size[0], 2.0 / size[2]];
        r.fill(0.0);
        z.fill(0.0);
        for (q, stress) in stress.iter().enumerate() {
            let radius = self.radii[element][q];
            for (a, (r, z)) in r.iter_mut().zip(z.iter_mut()).enumerate() {
                let [dr, dz] = [self.slopes[0][(q, a)] * across, self.slopes[1][(q, a)] * along];
                *r += dr * stress[0] + self.values[(q, a)] / radius * stress[1] + dz * stress[5];
                *z += dz * stress[2] + dr * stress[5];
            }
        }
    }
}

//! What keeps elements from locking, in bending and where plastic flow keeps the volume.
//!
//! Linear elements carry the enhanced strains of elasticity (`hexahedron` and `axisymmetric` of [`crate::method::fem`];
//! with plastic flow: J. C. Simo and M. S. Rifai 1990, doi 10.1002/nme.1620290802). Quadratic ones project the elastic
//! change of volume on linear polynomials (Q2/P₋₁). What that leaves over of the change of volume counts as a change of
//! shape: where nothing yields this is the elasticity of the same elements, and where something does, it flows with the
//! rest instead of holding it back.

use nalgebra::DMatrix;

use super::shapes::Shapes;
use crate::method::fem::axisymmetric::ENHANCED as RING_MODES;
use crate::method::fem::hexahedron::ENHANCED as BRICK_MODES;

/// Tables of local places.
pub struct Remedy {
    /// Strain component (of six) of each enhanced mode.
    components: Vec<usize>,
    /// Values of each mode: a row a point.
    modes: DMatrix<f64>,
    /// Values of the polynomials that the change of volume is projected on: a row a point; no column where the change
    /// at the point itself is taken.
    polynomials: DMatrix<f64>,
}

impl Remedy {
    pub fn new(shapes: &Shapes, order: usize) -> Self {
        let places = || shapes.places.iter().map(|(place, _)| *place);
        let is_ring = shapes.degrees == 2;
        let table = |columns: Vec<Vec<f64>>| {
            DMatrix::from_fn(shapes.points, columns.len(), |q, m| columns[m][q])
        };
        if order > 1 {
            let kept = |place: [f64; 3]| match is_ring {
                true => vec![1.0, place[0], place[2]],
                false => vec![1.0, place[0], place[1], place[2]],
            };
            let count = if is_ring { 3 } else { 4 };
            let columns = (0..count).map(|m| places().map(|p| kept(p)[m]).collect()).collect();
            let modes = DMatrix::zeros(shapes.points, 0);
            return Self { components: Vec::new(), modes, polynomials: table(columns) };
        }
        let (components, columns) = match is_ring {
            true => RING_MODES
                .iter()
                .map(|(c, f)| (if *c == 3 { 5 } else { *c }, places().map(|p| f(p[0], p[2])).collect()))
                .unzip(),
            false => BRICK_MODES.iter().map(|(c, f)| (*c, places().map(f).collect())).unzip(),
        };
        Self { components, modes: table(columns), polynomials: DMatrix::zeros(shapes.points, 0) }
    }

    /// Amplitudes of enhanced modes an element.
    pub fn modes(&self) -> usize {
        self.components.len()
    }

    /// Mean of each mode over an element's volume, which is taken off, so that uniform stress does no work on it.
    pub fn means(&self, volumes: &[f64]) -> Vec<f64> {
        let total: f64 = volumes.iter().sum();
        let mean = |m: usize| {
            let sum: f64 = volumes.iter().enumerate().map(|(q, v)| v * self.modes[(q, m)]).sum();
            // Symmetric over a brick: what is left is rounding.
            if sum.abs() < 1e-14 * total { 0.0 } else { sum / total }
        };
        (0..self.modes()).map(mean).collect()
    }

    /// Strain component and value of a mode at a point.
    pub fn mode(&self, means: &[f64], q: usize, m: usize) -> (usize, f64) {
        (self.components[m], self.modes[(q, m)] - means[m])
    }

    pub fn is_projected(&self) -> bool {
        self.polynomials.ncols() > 0
    }

    /// Replaces a scalar at the points by its projection on linear polynomials, in the sense of least squares.
    pub fn project(&self, volumes: &[f64], values: &mut [f64]) {
        self.through(volumes, values, true);
    }

    /// The adjoint of [`Self::project`].
    pub fn project_back(&self, volumes: &[f64], values: &mut [f64]) {
        self.through(volumes, values, false);
    }

    fn through(&self, volumes: &[f64], values: &mut [f64], direct: bool) {
        let count = self.polynomials.ncols();
        let mut gram = nalgebra::Matrix4::<f64>::identity();
        let mut moments = nalgebra::Vector4::<f64>::zeros();
        for m in 0..count {
            for o in 0..count {
                gram[(m, o)] = 0.0;
            }
        }
        for (q, (volume, value)) in volumes.iter().zip(&*values).enumerate() {
            for m in 0..count {
                let weighted = volume * self.polynomials[(q, m)];
                moments[m] += value * if direct { weighted } else { self.polynomials[(q, m)] };
                for o in 0..=m {
                    gram[(m, o)] += weighted * self.polynomials[(q, o)];
                }
            }
        }
        for m in 0..count {
            for o in 0..m {
                gram[(o, m)] = gram[(m, o)];
            }
        }
        let coefficients = match gram.cholesky() {
            Some(factor) => factor.solve(&moments),
            None => moments * f64::NAN,
        };
        for (q, value) in values.iter_mut().enumerate() {
            let sum: f64 = (0..count).map(|m| self.polynomials[(q, m)] * coefficients[m]).sum();
            *value = if direct { sum } else { volumes[q] * sum };
        }
    }
}


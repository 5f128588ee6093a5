//! Treatment of locking, in bending and in volume-preserving plastic flow.
//!
//! Linear elements carry the enhanced strains of elasticity (`hexahedron` and `axisymmetric` of [`crate::method::fem`];
//! with plastic flow: J. C. Simo and M. S. Rifai 1990, doi 10.1002/nme.1620290802). Quadratic ones project the elastic
//! volume change on linear polynomials (Q2/P₋₁). The remainder of the volume change counts as a change of shape.
//! Without yielding this is the elasticity of the same elements; with yielding, the remainder flows with the rest
//! instead of constraining it.

use nalgebra::DMatrix;

use super::shapes::Shapes;
use crate::method::fem::axisymmetric::ENHANCED as RING_MODES;
use crate::method::fem::hexahedron::ENHANCED as BRICK_MODES;

/// Largest number of enhanced modes of any element.
pub const MOST_MODES: usize = 15;

/// Tables of local places.
pub struct LockingTreatment {
    /// Strain component (of six) of each enhanced mode.
    components: Vec<usize>,
    /// Values of the modes at each point, point after point.
    modes: Vec<f64>,
    /// True if their means over an element vanish identically, as on a brick.
    is_balanced: bool,
    /// Values of the polynomials on which the volume change is projected, a row per point; no column if the pointwise
    /// change is used.
    polynomials: DMatrix<f64>,
}

impl LockingTreatment {
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
            let (components, modes) = (Vec::new(), Vec::new());
            return Self { components, modes, is_balanced: true, polynomials: table(columns) };
        }
        let (components, columns): (Vec<usize>, Vec<Vec<f64>>) = match is_ring {
            true => RING_MODES
                .iter()
                .map(|(c, f)| {
                    (if *c == 3 { 5 } else { *c }, places().map(|p| f(p[0], p[2])).collect())
                })
                .unzip(),
            false => BRICK_MODES.iter().map(|(c, f)| (*c, places().map(f).collect())).unzip(),
        };
        let values = (0..shapes.points).flat_map(|q| columns.iter().map(move |column| column[q]));
        let modes = values.collect();
        let polynomials = DMatrix::zeros(shapes.points, 0);
        Self { components, modes, is_balanced: !is_ring, polynomials }
    }

    /// Number of amplitudes of enhanced modes per element.
    pub fn modes(&self) -> usize {
        self.components.len()
    }

    /// Mean of each mode over an element's volume, which is subtracted so that uniform stress does no work on it.
    pub fn means(&self, volumes: &[f64]) -> [f64; MOST_MODES] {
        let mut means = [0.0; MOST_MODES];
        if !self.is_balanced {
            let total: f64 = volumes.iter().sum();
            for (values, volume) in self.modes.chunks_exact(self.modes()).zip(volumes) {
                means.iter_mut().zip(values).for_each(|(mean, v)| *mean += v * volume / total);
            }
        }
        means
    }

    /// Strain component and value of each mode at a point.
    #[inline]
    pub fn at<'a>(
        &'a self,
        means: &'a [f64; MOST_MODES],
        q: usize,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let values = &self.modes[q * self.modes()..][..self.modes()];
        let pairs = self.components.iter().zip(values).zip(means);
        pairs.map(|((component, value), mean)| (*component, value - mean))
    }

    pub fn is_projected(&self) -> bool {
        self.polynomials.ncols() > 0
    }

    /// Replaces a scalar at the points by its least-squares projection on linear polynomials.
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

/// Factor `A = L Lᵀ` of a system of enhanced modes.
#[derive(Clone)]
pub struct SmallFactor {
    count: usize,
    /// Rows of L, with the inverse of its diagonal entries.
    lower: [[f64; MOST_MODES]; MOST_MODES],
}

impl SmallFactor {
    /// Factors a matrix from the rows of its lower triangle; `None` if it is not positive definite.
    pub fn new(count: usize, mut lower: [[f64; MOST_MODES]; MOST_MODES]) -> Option<Self> {
        for i in 0..count {
            for j in 0..=i {
                let done: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest = lower[i][j] - done;
                lower[i][j] = if i > j {
                    rest * lower[j][j]
                } else if rest > 0.0 {
                    rest.sqrt().recip()
                } else {
                    return None;
                };
            }
        }
        Some(Self { count, lower })
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        for i in 0..self.count {
            let done: f64 = (0..i).map(|k| self.lower[i][k] * x[k]).sum();
            x[i] = (x[i] - done) * self.lower[i][i];
        }
        for i in (0..self.count).rev() {
            let done: f64 = (i + 1..self.count).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = (x[i] - done) * self.lower[i][i];
        }
    }
}

//! Anderson acceleration of fixed-point iterations (D. G. Anderson 1965, doi 10.1145/321296.321305;
//! H. F. Walker and P. Ni 2011, doi 10.1137/10078356X). For linear equations it is equivalent to
//! GMRES.

use nalgebra::{DMatrix, DVector};

/// Largest number of earlier iterates used by default.
const DEPTH: usize = 40;
/// Threshold of singular values, relative to the largest.
const SINGULAR: f64 = 1e-12;

/// History of the iteration.
#[derive(Debug)]
pub struct Anderson {
    /// Largest number of earlier iterates used.
    depth: usize,
    /// Differences of iterates and of their corrections, the oldest first.
    steps: Vec<DVector<f64>>,
    changes: Vec<DVector<f64>>,
    last: Option<(DVector<f64>, DVector<f64>)>,
}

impl Default for Anderson {
    fn default() -> Self {
        Self::of_depth(DEPTH)
    }
}

impl Anderson {
    /// Uses so many earlier iterates at most.
    pub fn of_depth(depth: usize) -> Self {
        Self { depth, steps: Vec::new(), changes: Vec::new(), last: None }
    }

    /// Returns the next iterate after `x`; the plain iteration would continue with
    /// `x + correction`.
    pub fn next(&mut self, x: &[f64], correction: &[f64]) -> Vec<f64> {
        let (x, f) = (DVector::from_column_slice(x), DVector::from_column_slice(correction));
        if let Some((last_x, last_f)) = &self.last {
            if self.steps.len() == self.depth {
                self.steps.remove(0);
                self.changes.remove(0);
            }
            self.steps.push(&x - last_x);
            self.changes.push(&f - last_f);
        }
        let mut next = &x + &f;
        if !self.changes.is_empty() {
            let changes = DMatrix::from_columns(&self.changes);
            let svd = changes.svd(true, true);
            let smallest = SINGULAR * svd.singular_values.max();
            if let Ok(weights) = svd.solve(&f, smallest) {
                for ((step, change), weight) in self.steps.iter().zip(&self.changes).zip(&weights) {
                    next -= (step + change) * *weight;
                }
            }
        }
        self.last = Some((x, f));
        next.as_slice().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_problem_converges_within_its_dimension() {
        // An iteration that diverges by itself: x + (b − A x) with eigenvalues of A up to 6.
        let a = DMatrix::from_fn(5, 5, |i, j| {
            if i == j { 2.0 + i as f64 } else { 1.0 / (2.0 + i as f64 + j as f64) }
        });
        let b = DVector::from_fn(5, |i, _| 1.0 + i as f64);
        let mut anderson = Anderson::default();
        let mut x = vec![0.0; 5];
        for _ in 0..7 {
            let correction = &b - &a * DVector::from_column_slice(&x);
            x = anderson.next(&x, correction.as_slice());
        }
        let residual = &b - &a * DVector::from_column_slice(&x);
        assert!(residual.amax() < 1e-10, "{residual}");
    }

    #[test]
    fn fixed_point_of_cosine() {
        let mut anderson = Anderson::default();
        let mut x = vec![1.0];
        for _ in 0..7 {
            x = anderson.next(&x, &[x[0].cos() - x[0]]);
        }
        assert!((x[0] - 0.739_085_133_215_160_7).abs() < 1e-12, "{x:?}");
    }
}

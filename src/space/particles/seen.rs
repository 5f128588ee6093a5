//! Second derivatives that the neighbours of a particle determine.
//!
//! What a linear fit leaves over of the quadratic terms has moments M. Where a single row of neighbours lies behind a
//! face, nothing is left over across it but what makes the row uneven: a fit to that would see noise a thousandfold. So
//! combinations of terms of which less than a part [`SEEN`] is left over have a derivative of zero. On a lattice that
//! is 0.03 beside a face for supports of 2.2 distances and 0.1 from 2.5 on; a single row that is uneven by a tenth of
//! the distance leaves 1e-3.

use nalgebra::DMatrix;

use crate::space::factor::Factor;

/// Least part of the square of a quadratic term that a linear fit leaves over where its derivative is seen.
const SEEN: f64 = 0.01;
/// Part of that square which is added to what is left over, so that the moments have a factor.
const ADDED: f64 = 1e-7;

/// The inverse of the moments, on what is seen.
pub enum Seen<const M: usize> {
    All(Factor<M>),
    Part([[f64; M]; M]),
}

impl<const M: usize> Seen<M> {
    /// `left` and `whole` are the lower triangles of the moments of what is left over and of the terms themselves;
    /// `None` if these are zero.
    pub fn of(left: [[f64; M]; M], whole: &[[f64; M]; M]) -> Option<Self> {
        let mut added = left;
        (0..M).for_each(|k| added[k][k] += ADDED * whole[k][k]);
        let factor = Factor::of(&added)?;
        // The trace of the inverse is above its largest eigenvalue.
        let entry = |k: usize| {
            let mut unit = [0.0; M];
            unit[k] = 1.0;
            whole[k][k] * factor.solve(unit)[k]
        };
        if (0..M).map(entry).sum::<f64>() < 1.0 / SEEN {
            return Some(Self::All(factor));
        }
        let scale = |a: usize, b: usize| 1.0 / (whole[a][a] * whole[b][b]).sqrt();
        let entry = |a: usize, b: usize| left[a.max(b)][a.min(b)] * scale(a, b);
        let eigen = DMatrix::from_fn(M, M, entry).symmetric_eigen();
        if eigen.eigenvalues.iter().all(|&value| value >= SEEN) {
            return Some(Self::All(factor));
        }
        let mut inverse = [[0.0; M]; M];
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value < SEEN {
                continue;
            }
            for (a, row) in inverse.iter_mut().enumerate() {
                for (b, sum) in row.iter_mut().enumerate() {
                    *sum += scale(a, b) * vector[a] * vector[b] / value;
                }
            }
        }
        Some(Self::Part(inverse))
    }

    pub fn solve(&self, right: [f64; M]) -> [f64; M] {
        match self {
            Self::All(factor) => factor.solve(right),
            Self::Part(inverse) => {
                inverse.map(|row| row.iter().zip(&right).map(|(a, b)| a * b).sum())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A combination that is hardly left over has no part of the solution, and the others theirs.
    #[test]
    fn what_is_not_seen_is_zero() {
        let (c, s) = (0.6, 0.8);
        let moments = |least: f64| {
            let entry = |u: [f64; 2], a: usize, b: usize| u[a] * u[b];
            let of = |a, b| 0.5 * entry([c, s], a, b) + least * entry([-s, c], a, b);
            [[of(0, 0), 0.0], [of(1, 0), of(1, 1)]]
        };
        let whole = [[1.0, 0.0], [0.0, 1.0]];
        let right = [c - 2.0 * s, s + 2.0 * c];
        for least in [0.1, 1e-3, 1e-12, 0.0] {
            let found = Seen::of(moments(least), &whole).unwrap().solve(right);
            let across = if least > SEEN { 2.0 / least } else { 0.0 };
            let wanted = [2.0 * c - across * s, 2.0 * s + across * c];
            for (found, wanted) in found.iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-5 * (1.0 + across), "{least} {found} {wanted}");
            }
        }
        assert!(Seen::of([[0.0; 2]; 2], &[[0.0; 2]; 2]).is_none());
    }
}

//! Factors of small symmetric positive definite matrices.

/// M = L D Lᵀ of which only the lower triangle is read.
pub(super) struct Factor<const N: usize> {
    /// L below the diagonal, 1/D on it.
    rows: [[f64; N]; N],
}

/// Smallest part of a diagonal term that remains once the terms before it are eliminated: the squared sine of the angle
/// between a monomial and those before it at the nodes. Values of functions lose as many digits as it has zeros.
const INDEPENDENT: f64 = 1e-9;

impl<const N: usize> Factor<N> {
    /// Factorises a matrix; `None` if its rows depend on each other.
    #[inline(always)]
    pub(super) fn of(m: &[[f64; N]; N]) -> Option<Self> {
        let mut rows = [[0.0; N]; N];
        for i in 0..N {
            // L D of this row before the diagonal.
            let mut scaled = [0.0; N];
            for j in 0..i {
                let mut left = m[i][j];
                for k in 0..j {
                    left -= scaled[k] * rows[j][k];
                }
                scaled[j] = left;
            }
            let mut pivot = m[i][i];
            for j in 0..i {
                rows[i][j] = scaled[j] * rows[j][j];
                pivot -= rows[i][j] * scaled[j];
            }
            // False for what is not a number, too.
            let is_independent = pivot > INDEPENDENT * m[i][i];
            if !is_independent {
                return None;
            }
            rows[i][i] = 1.0 / pivot;
        }
        Some(Self { rows })
    }

    /// M⁻¹ `right`.
    #[inline(always)]
    pub(super) fn solve(&self, mut right: [f64; N]) -> [f64; N] {
        for i in 0..N {
            for j in 0..i {
                right[i] -= self.rows[i][j] * right[j];
            }
        }
        for (i, (value, row)) in right.iter_mut().zip(&self.rows).enumerate() {
            *value *= row[i];
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                right[i] -= self.rows[j][i] * right[j];
            }
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_refuses() {
        let m = [[4.0, 0.0, 0.0], [2.0, 5.0, 0.0], [-1.0, 0.5, 3.0]];
        let x = [1.0, -2.0, 0.5];
        let full = |i: usize, j: usize| if i < j { m[j][i] } else { m[i][j] };
        let right = [0, 1, 2].map(|i| (0..3).map(|j| full(i, j) * x[j]).sum());
        let found = Factor::of(&m).unwrap().solve(right);
        (0..3).for_each(|i| assert!((found[i] - x[i]).abs() < 1e-15));
        assert!(Factor::of(&[[1.0, 0.0], [1.0, 1.0]]).is_none());
        assert!(Factor::of(&[[f64::NAN]]).is_none());
    }
}

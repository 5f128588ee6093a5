//! Inverses of small matrices, with their condition number.

/// An inverse and `κ₁ = ‖A‖₁ ‖A⁻¹‖₁`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmallInverse<const N: usize> {
    pub matrix: [[f64; N]; N],
    pub condition: f64,
}

/// Inverse of the leading `n × n` block, by Gauss–Jordan elimination with row pivots; zeros are
/// beyond it. `None` where a pivot is zero.
pub fn inverse<const N: usize>(block: &[[f64; N]; N], n: usize) -> Option<SmallInverse<N>> {
    let mut left = *block;
    let mut right = [[0.0; N]; N];
    for (i, row) in right.iter_mut().enumerate().take(n) {
        row[i] = 1.0;
    }
    for column in 0..n {
        let larger =
            |&a: &usize, &b: &usize| left[a][column].abs().total_cmp(&left[b][column].abs());
        let pivot = (column..n).max_by(larger)?;
        left.swap(column, pivot);
        right.swap(column, pivot);
        let scale = left[column][column];
        if scale == 0.0 || !scale.is_finite() {
            return None;
        }
        for j in 0..n {
            left[column][j] /= scale;
            right[column][j] /= scale;
        }
        let (unit, image) = (left[column], right[column]);
        for row in (0..n).filter(|&row| row != column) {
            let factor = left[row][column];
            for j in 0..n {
                left[row][j] -= factor * unit[j];
                right[row][j] -= factor * image[j];
            }
        }
    }
    let condition = one_norm(block, n) * one_norm(&right, n);
    Some(SmallInverse { matrix: right, condition })
}

/// Largest column sum of absolute values.
fn one_norm<const N: usize>(matrix: &[[f64; N]; N], n: usize) -> f64 {
    let column = |j: usize| (0..n).map(|i| matrix[i][j].abs()).sum::<f64>();
    (0..n).map(column).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn product_with_inverse_is_identity() {
        let a = [[0.0, 2.0, 1.0, 9.0], [3.0, -1.0, 0.5, 9.0], [1.0, 4.0, -2.0, 9.0], [9.0; 4]];
        let found = inverse(&a, 3).unwrap();
        for (i, row) in a.iter().enumerate().take(3) {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| row[k] * found.matrix[k][j]).sum();
                assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-15, "{entry}");
            }
        }
        assert!(found.condition > 1.0 && found.condition < 20.0);
    }

    #[test]
    fn condition_number_of_a_diagonal_matrix() {
        let a = [[1e3, 0.0], [0.0, 1e-4]];
        assert!((inverse(&a, 2).unwrap().condition / 1e7 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn singular_matrix_has_no_inverse() {
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]], 2), None);
    }
}

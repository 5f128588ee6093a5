//! Singular value decomposition by one-sided rotations, on the calling thread.
//!
//! `A P = Q R` with the longest column first. The columns of `Rᵀ`, at most as many as the rank, are
//! rotated in pairs until all are orthogonal: then they are `σ u`, and the rotations are `V` (M. R.
//! Hestenes 1958, doi 10.1137/0106005; Z. Drmač and K. Veselić 2008, doi 10.1137/050639193). Small
//! singular values of graded matrices keep their digits (J. Demmel and K. Veselić 1992, doi
//! 10.1137/0613074); methods that first make the matrix bidiagonal lose them.

use faer::Mat;

use super::product::product;

/// `A = U diag(σ) Vᵀ` with one column per significant singular value, in descending order.
pub struct SingularValues {
    pub left: Mat<f64>,
    pub values: Vec<f64>,
    pub right: Mat<f64>,
}

/// Cosine below which two columns count as orthogonal, and the largest number of sweeps.
const ORTHOGONAL: f64 = 1e-13;
const SWEEPS: usize = 40;
/// Length, relative to the longest, below which columns are omitted.
const SHORT: f64 = 1e-15;

/// Decomposes a matrix; `None` if an entry is not finite.
pub fn singular_values(matrix: &Mat<f64>) -> Option<SingularValues> {
    // Rotations of each pair cost as many operations as columns are long.
    if matrix.ncols() > matrix.nrows() {
        let turned = singular_values(&matrix.transpose().to_owned())?;
        return Some(SingularValues {
            left: turned.right,
            values: turned.values,
            right: turned.left,
        });
    }
    let own: Vec<Vec<f64>> =
        (0..matrix.ncols()).map(|j| matrix.col(j).iter().copied().collect()).collect();
    let lengths: Vec<f64> = own.iter().map(|column| length(column)).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    if !lengths.iter().all(|length| length.is_finite()) {
        return None;
    }
    let Factors { basis, mut rows } = factors(own, SHORT * longest);
    let rank = rows.len();
    let mut turns: Vec<Vec<f64>> =
        (0..rank).map(|j| (0..rank).map(|i| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    for _ in 0..SWEEPS {
        if !sweep(&mut rows, &mut turns, SHORT * longest) {
            break;
        }
    }
    let values: Vec<f64> = rows.iter().map(|row| length(row)).collect();
    let mut order: Vec<usize> = (0..rank).filter(|&j| values[j] > 0.0).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let right =
        Mat::from_fn(matrix.ncols(), order.len(), |i, r| rows[order[r]][i] / values[order[r]]);
    let basis = Mat::from_fn(matrix.nrows(), rank, |i, k| basis[k][i]);
    let turned = Mat::from_fn(rank, order.len(), |k, r| turns[order[r]][k]);
    let mut left = vec![0.0; matrix.nrows() * order.len()];
    product(&mut left, basis.as_ref(), turned.as_ref());
    let left = Mat::from_fn(matrix.nrows(), order.len(), |i, r| left[r * matrix.nrows() + i]);
    Some(SingularValues { left, values: order.iter().map(|&j| values[j]).collect(), right })
}

/// Orthonormal columns, and a row for each of these: the matrix is the sum of their products.
struct Factors {
    basis: Vec<Vec<f64>>,
    rows: Vec<Vec<f64>>,
}

/// Factors a matrix given by columns; always takes the longest remaining one, down to those that
/// are `short`.
fn factors(mut left: Vec<Vec<f64>>, short: f64) -> Factors {
    let count = left.len();
    let mut lengths: Vec<f64> = left.iter().map(|column| length(column)).collect();
    let mut found = Factors { basis: Vec::new(), rows: Vec::new() };
    while found.basis.len() < count {
        let longer = |best: usize, j: usize| if lengths[j] > lengths[best] { j } else { best };
        let pivot = (1..count).fold(0, longer);
        let size = lengths[pivot];
        // Without this, NaN would never end the loop.
        if size.is_nan() || size <= short {
            break;
        }
        let mut unit: Vec<f64> = left[pivot].iter().map(|value| value / size).collect();
        // Orthogonalises once more, against rounding.
        for (before, row) in found.basis.iter().zip(&mut found.rows) {
            let part = dot(before, &unit);
            subtract(&mut unit, part, before);
            row[pivot] += part * size;
        }
        let scale = length(&unit);
        unit.iter_mut().for_each(|value| *value /= scale);
        let mut row = vec![0.0; count];
        for (j, column) in left.iter_mut().enumerate().filter(|(_, column)| !column.is_empty()) {
            row[j] = dot(&unit, column);
            subtract(column, row[j], &unit);
            lengths[j] = length(column);
        }
        left[pivot].clear();
        lengths[pivot] = 0.0;
        found.basis.push(unit);
        found.rows.push(row);
    }
    found
}

fn subtract(from: &mut [f64], part: f64, values: &[f64]) {
    from.iter_mut().zip(values).for_each(|(from, value)| *from -= part * value);
}

/// Rotates all pairs once; returns true if any was not orthogonal.
fn sweep(columns: &mut [Vec<f64>], turns: &mut [Vec<f64>], short: f64) -> bool {
    let mut any = false;
    for p in 0..columns.len() {
        for q in p + 1..columns.len() {
            let (first, second) = columns.split_at_mut(q);
            let (a, b) = (&mut first[p], &mut second[0]);
            let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
            // A column at rounding level has no direction.
            let is_noise = aa.min(bb) <= short * short;
            if is_noise || ab.abs() <= ORTHOGONAL * (aa * bb).sqrt() {
                continue;
            }
            any = true;
            let zeta = (bb - aa) / (2.0 * ab);
            let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            turn(a, b, [cosine, cosine * tangent]);
            let (first, second) = turns.split_at_mut(q);
            turn(&mut first[p], &mut second[0], [cosine, cosine * tangent]);
        }
    }
    any
}

fn turn(a: &mut [f64], b: &mut [f64], [cosine, sine]: [f64; 2]) {
    for (a, b) in a.iter_mut().zip(b) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    crate::math::separable::dot(a, b)
}

fn length(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_rank_matrix_is_reproduced() {
        let wave = |a: f64, n: usize| (a * (n as f64 + 1.0)).sin();
        let own = Mat::from_fn(30, 400, |i, j| {
            (1..=5)
                .map(|k| {
                    10f64.powi(-3 * k) * wave(0.7 * f64::from(k), i) * wave(0.013 * f64::from(k), j)
                })
                .sum()
        });
        let found = singular_values(&own).unwrap();
        // Beyond the rank there is only rounding.
        let rounding = 1e-14 * found.values[0];
        assert!(found.values.iter().skip(5).all(|value| *value < rounding), "{:?}", found.values);
        assert!(found.values[4] > 10.0 * rounding && found.values.len() < 30);
        for (i, j) in (0..30).zip((0..400).step_by(13)) {
            let parts = found.values.iter().enumerate();
            let sum: f64 = parts.map(|(r, s)| found.left[(i, r)] * s * found.right[(j, r)]).sum();
            assert!((sum - own[(i, j)]).abs() < rounding);
        }
        for a in 0..found.values.len() {
            for b in 0..=a {
                let wanted = if a == b { 1.0 } else { 0.0 };
                let left: f64 = (0..30).map(|i| found.left[(i, a)] * found.left[(i, b)]).sum();
                assert!((left - wanted).abs() < 1e-12);
                let right: f64 = (0..400).map(|i| found.right[(i, a)] * found.right[(i, b)]).sum();
                // A column at rounding level has no direction.
                let is_noise = found.values[a] < rounding;
                assert!((right - wanted).abs() < 1e-12 || is_noise);
            }
        }
    }

    #[test]
    fn graded_matrices_keep_their_small_singular_values() {
        // Columns and rows whose sizes span twelve orders of magnitude.
        let grade = |i: usize| 10f64.powf(-(i as f64));
        let matrix = |rows: usize, columns: usize| {
            Mat::from_fn(rows, columns, |i, j| {
                grade(i)
                    * grade(j)
                    * if i == j { 1.0 } else { 0.3 * ((i * 7 + j * 3) as f64).sin() }
            })
        };
        for (rows, columns) in [(7, 7), (9, 6), (6, 9)] {
            let own = matrix(rows, columns);
            let found = singular_values(&own).unwrap();
            assert!(found.values.windows(2).all(|pair| pair[0] >= pair[1]));
            for i in 0..rows {
                for j in 0..columns {
                    let parts = found.values.iter().enumerate();
                    let sum: f64 =
                        parts.map(|(r, s)| found.left[(i, r)] * s * found.right[(j, r)]).sum();
                    assert!((sum - own[(i, j)]).abs() < 1e-14 * grade(i.min(j)), "{i} {j}");
                }
            }
            for (a, b) in [(0, 1), (2, 5), (3, 3)] {
                let product: f64 = (0..rows).map(|i| found.left[(i, a)] * found.left[(i, b)]).sum();
                assert!((product - if a == b { 1.0 } else { 0.0 }).abs() < 1e-13);
            }
        }
    }
}

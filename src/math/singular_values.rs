//! Singular value decompositions by one-sided rotations, on the thread that calls.
//!
//! Columns of `A` are turned against each other until all are orthogonal: then they are `σ u`, and the turns are `V` (M. R.
//! Hestenes 1958, doi 10.1137/0106005). Small singular values of graded matrices keep their digits (J. Demmel and K.
//! Veselić 1992, doi 10.1137/0613074), which methods that first make the matrix bidiagonal lose.

use faer::Mat;

/// `A = U diag(σ) Vᵀ` with as many columns as singular values that count, descending.
pub struct SingularValues {
    pub left: Mat<f64>,
    pub values: Vec<f64>,
    pub right: Mat<f64>,
}

/// Cosine of the angle between columns that counts as none, and sweeps at most.
const ORTHOGONAL: f64 = 1e-13;
const SWEEPS: usize = 40;
/// Columns shorter than this part of the longest are left out.
const SHORT: f64 = 1e-15;

/// Of a matrix; nothing where it holds no numbers.
pub fn singular_values(matrix: &Mat<f64>) -> Option<SingularValues> {
    // Turns cost as many operations as columns are long, for each pair of them.
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
    let mut kept: Vec<usize> = (0..own.len()).filter(|&j| lengths[j] > SHORT * longest).collect();
    // Long ones first: what is graded takes few sweeps then.
    kept.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
    let mut columns: Vec<Vec<f64>> = kept.iter().map(|&j| own[j].clone()).collect();
    let mut turns: Vec<Vec<f64>> = (0..kept.len())
        .map(|j| (0..kept.len()).map(|i| if i == j { 1.0 } else { 0.0 }).collect())
        .collect();
    for _ in 0..SWEEPS {
        if !sweep(&mut columns, &mut turns, SHORT * longest) {
            break;
        }
    }
    let values: Vec<f64> = columns.iter().map(|column| length(column)).collect();
    let mut order: Vec<usize> = (0..values.len()).filter(|&j| values[j] > 0.0).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let left =
        Mat::from_fn(matrix.nrows(), order.len(), |i, r| columns[order[r]][i] / values[order[r]]);
    let mut right = Mat::zeros(matrix.ncols(), order.len());
    for (r, &j) in order.iter().enumerate() {
        for (i, &column) in kept.iter().enumerate() {
            right[(column, r)] = turns[j][i];
        }
    }
    Some(SingularValues { left, values: order.iter().map(|&j| values[j]).collect(), right })
}

/// Turns all pairs once; whether any was not orthogonal.
fn sweep(columns: &mut [Vec<f64>], turns: &mut [Vec<f64>], short: f64) -> bool {
    let mut any = false;
    for p in 0..columns.len() {
        for q in p + 1..columns.len() {
            let (first, second) = columns.split_at_mut(q);
            let (a, b) = (&mut first[p], &mut second[0]);
            let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
            // What is as short as rounding has no direction.
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
    fn graded_matrices_keep_their_small_singular_values() {
        // Columns and rows that fall by twelve orders.
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

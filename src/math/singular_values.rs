//! Singular value decompositions by one-sided rotations, on the thread that calls.
//!
//! `A P = Q R` with the longest column that is left first, then the columns of `Rᵀ`, as many as the rank, are turned
//! against each other until all are orthogonal: they are `σ u` then, and the turns are `V` (M. R. Hestenes 1958, doi
//! 10.1137/0106005; Z. Drmač and K. Veselić 2008, doi 10.1137/050639193). Small singular values of graded matrices keep
//! their digits (J. Demmel and K. Veselić 1992, doi 10.1137/0613074), which methods that first make the matrix bidiagonal
//! lose.

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
    let Orthogonal { basis, rows } = orthogonal(own)?;
    let mut columns = rows;
    let mut turns: Vec<Vec<f64>> = (0..columns.len())
        .map(|j| (0..columns.len()).map(|i| if i == j { 1.0 } else { 0.0 }).collect())
        .collect();
    let longest = columns.iter().map(|column| length(column)).fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        if !sweep(&mut columns, &mut turns, SHORT * longest) {
            break;
        }
    }
    let values: Vec<f64> = columns.iter().map(|column| length(column)).collect();
    let mut order: Vec<usize> = (0..values.len()).filter(|&j| values[j] > 0.0).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let mut left = Mat::zeros(matrix.nrows(), order.len());
    for (r, &j) in order.iter().enumerate() {
        for (column, turn) in basis.iter().zip(&turns[j]) {
            left.col_mut(r).iter_mut().zip(column).for_each(|(out, q)| *out += turn * q);
        }
    }
    let right =
        Mat::from_fn(matrix.ncols(), order.len(), |i, r| columns[order[r]][i] / values[order[r]]);
    Some(SingularValues { left, values: order.iter().map(|&j| values[j]).collect(), right })
}

/// `A = Q R`: orthonormal columns of `Q`, and the rows of `R`, columns where those of `A` are.
struct Orthogonal {
    basis: Vec<Vec<f64>>,
    rows: Vec<Vec<f64>>,
}

/// Orthogonalises columns, the longest that is left first, until all that are left are short; nothing where any holds no
/// numbers.
///
/// What a column loses is taken twice, so that the basis is orthogonal to rounding (L. Giraud, J. Langou, M. Rozložník and
/// J. van den Eshof 2005, doi 10.1007/s00211-005-0615-4).
fn orthogonal(mut columns: Vec<Vec<f64>>) -> Option<Orthogonal> {
    let mut lengths: Vec<f64> = columns.iter().map(|column| length(column)).collect();
    if !lengths.iter().all(|length| length.is_finite()) {
        return None;
    }
    let short = SHORT * lengths.iter().copied().fold(0.0, f64::max);
    let (mut basis, mut rows): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    while let Some(longest) = (0..columns.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
    {
        if lengths[longest] <= short || basis.len() == columns[longest].len() {
            break;
        }
        let mut own = columns[longest].clone();
        for column in &basis {
            let part = dot(column, &own);
            own.iter_mut().zip(column).for_each(|(own, q)| *own -= part * q);
        }
        let norm = length(&own);
        if norm <= short {
            lengths[longest] = 0.0;
            continue;
        }
        own.iter_mut().for_each(|value| *value /= norm);
        let mut row = vec![0.0; columns.len()];
        for (j, column) in columns.iter_mut().enumerate() {
            if lengths[j] == 0.0 {
                continue;
            }
            row[j] = dot(&own, column);
            column.iter_mut().zip(&own).for_each(|(value, q)| *value -= row[j] * q);
            lengths[j] = if j == longest { 0.0 } else { length(column) };
        }
        basis.push(own);
        rows.push(row);
    }
    Some(Orthogonal { basis, rows })
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

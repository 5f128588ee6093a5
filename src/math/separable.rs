//! Transforms of three-dimensional arrays by one small matrix along each axis.
//!
//! An array of shape `(nx, ny, nz)` is stored with the x index running fastest.

use faer::{Mat, MatRef};

use super::product::product;

/// Use of a matrix as is or transposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Direct,
    Transposed,
}

/// `out[a, b, c] = Σ A[a, i] B[b, j] C[c, k] in[i, j, k]`, each matrix transposed for
/// [`Side::Transposed`].
pub fn transform(values: &[f64], matrices: [&Mat<f64>; 3], side: Side) -> Vec<f64> {
    let [a, b, c] = matrices.map(|m| match side {
        Side::Direct => m.as_ref(),
        Side::Transposed => m.transpose(),
    });
    let nz = c.ncols();
    let (mx, my, mz) = (a.nrows(), b.nrows(), c.nrows());
    assert_eq!(values.len(), a.ncols() * b.ncols() * nz, "array and matrices disagree in shape");

    let along_y = planes(values, [a, b]);
    let mut out = vec![0.0; mx * my * mz];
    let source = MatRef::from_column_major_slice(&along_y, mx * my, nz);
    product(&mut out, source, c.transpose());
    out
}

/// `out[a, b, k] = Σ A[a, i] B[b, j] in[i, j, k]`, for any number of planes k.
pub fn transform_planes(values: &[f64], [a, b]: [&Mat<f64>; 2]) -> Vec<f64> {
    planes(values, [a.as_ref(), b.as_ref()])
}

fn planes(values: &[f64], [a, b]: [MatRef<'_, f64>; 2]) -> Vec<f64> {
    let (nx, ny, mx, my) = (a.ncols(), b.ncols(), a.nrows(), b.nrows());
    let count = values.len() / (nx * ny);
    let mut along_x = vec![0.0; mx * ny * count];
    let source = MatRef::from_column_major_slice(values, nx, ny * count);
    product(&mut along_x, a, source);

    let mut along_y = vec![0.0; mx * my * count];
    for k in 0..count {
        let source = MatRef::from_column_major_slice(&along_x[k * mx * ny..][..mx * ny], mx, ny);
        let target = &mut along_y[k * mx * my..][..mx * my];
        product(target, source, b.transpose());
    }
    along_y
}

/// `out[i, j, c] = Σ C[c, k] in[i, j, k]`, for planes of any shape.
pub fn transform_depth(values: &[f64], rows: &Mat<f64>) -> Vec<f64> {
    let plane = values.len() / rows.ncols();
    let mut out = vec![0.0; plane * rows.nrows()];
    let source = MatRef::from_column_major_slice(values, plane, rows.ncols());
    product(&mut out, source, rows.transpose());
    out
}

/// `Σ values[i, j, k] a[i] b[j] c[k]`.
pub fn contract(values: &[f64], [a, b, c]: [&[f64]; 3]) -> f64 {
    let mut total = 0.0;
    for (slab, ck) in values.chunks_exact(a.len() * b.len()).zip(c) {
        let mut plane = 0.0;
        for (row, bj) in slab.chunks_exact(a.len()).zip(b) {
            plane += bj * dot(row, a);
        }
        total += ck * plane;
    }
    total
}

/// `values[i, j, k] += factor a[i] b[j] c[k]`.
pub fn add_product(values: &mut [f64], factor: f64, [a, b, c]: [&[f64]; 3]) {
    for (slab, ck) in values.chunks_exact_mut(a.len() * b.len()).zip(c) {
        for (row, bj) in slab.chunks_exact_mut(a.len()).zip(b) {
            let scale = factor * bj * ck;
            for (value, ai) in row.iter_mut().zip(a) {
                *value += scale * ai;
            }
        }
    }
}

/// Dot product in eight interleaved partial sums, which the compiler turns into vector code.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_blocks, a_rest) = a.as_chunks::<8>();
    let (b_blocks, b_rest) = b.as_chunks::<8>();
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: usize, columns: usize, seed: f64) -> Mat<f64> {
        Mat::from_fn(rows, columns, |i, j| (seed + 1.7 * i as f64 - 0.9 * (j * j) as f64).sin())
    }

    #[test]
    fn transform_matches_its_definition() {
        let (a, b, c) = (matrix(2, 3, 0.1), matrix(4, 2, 0.5), matrix(3, 5, 0.9));
        let values: Vec<f64> = (0..30).map(|i| (0.3 * i as f64).cos()).collect();
        let out = transform(&values, [&a, &b, &c], Side::Direct);
        for (p, q, r) in [(0, 0, 0), (1, 3, 2), (1, 2, 0)] {
            let mut sum = 0.0;
            for k in 0..5 {
                for j in 0..2 {
                    for i in 0..3 {
                        sum += a[(p, i)] * b[(q, j)] * c[(r, k)] * values[i + 3 * (j + 2 * k)];
                    }
                }
            }
            assert!((out[p + 2 * (q + 4 * r)] - sum).abs() < 1e-13);
        }
    }

    #[test]
    fn planes_and_depth_are_parts_of_the_transform() {
        let (a, b, c) = (matrix(2, 3, 0.1), matrix(4, 2, 0.5), matrix(3, 5, 0.9));
        let values: Vec<f64> = (0..30).map(|i| (0.3 * i as f64).cos()).collect();
        let whole = transform(&values, [&a, &b, &c], Side::Direct);
        assert_eq!(transform_depth(&transform_planes(&values, [&a, &b]), &c), whole);
        let other = transform_planes(&transform_depth(&values, &c), [&a, &b]);
        assert!(other.iter().zip(&whole).all(|(o, w)| (o - w).abs() < 1e-13));
    }

    #[test]
    fn contract_and_add_product_are_adjoint() {
        let (a, b, c) = ([1.0, -2.0, 0.5], [0.3, 2.0], [1.5, -1.0]);
        let values: Vec<f64> = (0..12).map(|i| (i as f64).sin()).collect();
        let mut product = vec![0.0; 12];
        add_product(&mut product, 1.0, [&a, &b, &c]);
        assert!((dot(&product, &values) - contract(&values, [&a, &b, &c])).abs() < 1e-14);
    }
}

//! Products of dense matrices, on the calling thread and without memory that outlives the call.
//!
//! General libraries keep scratch memory per thread. On a host's thread that memory would outlive
//! the last instance of a unit, and keep the library loaded.

use faer::{Mat, MatRef};
use num_traits::Float;

/// Lets the library that other methods multiply with query the cache sizes, which it does once per
/// process.
///
/// Threads that multiply meanwhile wait for the query, so it is made before a fork could interrupt
/// it.
pub fn look_up_caches() {
    // The smallest size that is cut into blocks.
    let square = Mat::<f64>::identity(32, 32);
    let product = &square * &square;
    debug_assert_eq!(product, square);
}

/// Computes `out = left right`, by columns, in single or double precision. Every entry is the sum
/// of its terms in ascending order, for all vector instructions; rounding differs only on
/// processors without fused multiply–add.
pub fn product<T: Float>(out: &mut [T], left: MatRef<'_, T>, right: MatRef<'_, T>) {
    assert_eq!(left.ncols(), right.nrows(), "matrices disagree in shape");
    assert_eq!(out.len(), left.nrows() * right.ncols(), "the product has another size");
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has the features that the function requires.
            return unsafe { product_avx512(out, left, right) };
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has the features that the function requires.
            return unsafe { product_avx2(out, left, right) };
        }
    }
    // Every processor of this kind has fused multiply–add.
    #[cfg(target_arch = "aarch64")]
    by_tiles::<T, 8, 6, true>(out, left, right);
    #[cfg(not(target_arch = "aarch64"))]
    by_tiles::<T, 4, 4, false>(out, left, right);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn product_avx512<T: Float>(out: &mut [T], left: MatRef<'_, T>, right: MatRef<'_, T>) {
    match size_of::<T>() {
        4 => by_tiles::<T, 32, 6, true>(out, left, right),
        _ => by_tiles::<T, 16, 6, true>(out, left, right),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn product_avx2<T: Float>(out: &mut [T], left: MatRef<'_, T>, right: MatRef<'_, T>) {
    match size_of::<T>() {
        4 => by_tiles::<T, 16, 6, true>(out, left, right),
        _ => by_tiles::<T, 8, 6, true>(out, left, right),
    }
}

/// Works on tiles of `M` rows and `N` columns, whose sums stay in registers. The smaller matrix is
/// laid out by tiles once, the other one strip by strip. There are no closures: these are compiled
/// for every processor.
#[inline(always)]
fn by_tiles<T: Float, const M: usize, const N: usize, const FUSED: bool>(
    out: &mut [T],
    left: MatRef<'_, T>,
    right: MatRef<'_, T>,
) {
    let (rows, columns, depth) = (left.nrows(), right.ncols(), left.ncols());
    if depth == 0 {
        return out.fill(T::zero());
    }
    let right = right.transpose();
    let (panels, strips) = ((0..rows).step_by(M), (0..columns).step_by(N));
    if rows <= columns {
        let mut all = vec![[T::zero(); M]; depth * panels.len()];
        let mut strip = vec![[T::zero(); N]; depth];
        for (i, panel) in panels.clone().zip(all.chunks_exact_mut(depth)) {
            lay_out(panel, left, i);
        }
        for j in strips {
            lay_out(&mut strip, right, j);
            for (i, panel) in panels.clone().zip(all.chunks_exact(depth)) {
                store(out, rows, i, j, &sums::<T, M, N, FUSED>(panel, &strip));
            }
        }
    } else {
        let mut all = vec![[T::zero(); N]; depth * strips.len()];
        let mut panel = vec![[T::zero(); M]; depth];
        for (j, strip) in strips.clone().zip(all.chunks_exact_mut(depth)) {
            lay_out(strip, right, j);
        }
        for i in panels {
            lay_out(&mut panel, left, i);
            for (j, strip) in strips.clone().zip(all.chunks_exact(depth)) {
                store(out, rows, i, j, &sums::<T, M, N, FUSED>(&panel, strip));
            }
        }
    }
}

/// Sets `strip[k]` to the rows from `first` on of column k, with zeros beyond the last row.
#[inline(always)]
fn lay_out<T: Float, const N: usize>(strip: &mut [[T; N]], matrix: MatRef<'_, T>, first: usize) {
    assert!(first < matrix.nrows() && strip.len() <= matrix.ncols());
    let count = N.min(matrix.nrows() - first);
    for (k, entries) in strip.iter_mut().enumerate() {
        for (i, entry) in entries.iter_mut().enumerate() {
            // SAFETY: row and column are within the matrix by the assertion above.
            *entry = match i < count {
                true => unsafe { *matrix.get_unchecked(first + i, k) },
                false => T::zero(),
            };
        }
    }
}

/// `Σ_k panel[k][i] strip[k][j]` for every column j and row i of a tile.
#[inline(always)]
fn sums<T: Float, const M: usize, const N: usize, const FUSED: bool>(
    panel: &[[T; M]],
    strip: &[[T; N]],
) -> [[T; M]; N] {
    let mut sums = [[T::zero(); M]; N];
    for (left, right) in panel.iter().zip(strip) {
        for j in 0..N {
            for i in 0..M {
                let (a, b) = (left[i], right[j]);
                sums[j][i] = if FUSED { a.mul_add(b, sums[j][i]) } else { a * b + sums[j][i] };
            }
        }
    }
    sums
}

/// Stores the part of a tile at row i and column j that lies inside `out`.
#[inline(always)]
fn store<T: Copy, const M: usize>(out: &mut [T], rows: usize, i: usize, j: usize, tile: &[[T; M]]) {
    let high = M.min(rows - i);
    for (sums, column) in tile.iter().zip(out.chunks_exact_mut(rows).skip(j)) {
        column[i..i + high].copy_from_slice(&sums[..high]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    #[test]
    fn product_matches_its_definition_for_all_sizes_and_layouts() {
        for (rows, depth, columns) in [(1, 1, 1), (17, 5, 3), (3, 40, 17), (33, 12, 64), (5, 0, 4)]
        {
            let left = Mat::from_fn(rows, depth, |i, k| (1.3 * i as f64 - 0.7 * k as f64).sin());
            let right = Mat::from_fn(depth, columns, |k, j| (0.2 * (k * j) as f64 + 0.1).cos());
            let (turned_left, turned_right) =
                (left.transpose().to_owned(), right.transpose().to_owned());
            let mut exact = Vec::new();
            for j in 0..columns {
                for i in 0..rows {
                    exact.push((0..depth).map(|k| left[(i, k)] * right[(k, j)]).sum::<f64>());
                }
            }
            for left in [left.as_ref(), turned_left.transpose()] {
                for right in [right.as_ref(), turned_right.transpose()] {
                    let mut out = vec![f64::NAN; rows * columns];
                    product(&mut out, left, right);
                    assert!(out.iter().zip(&exact).all(|(x, e)| (x - e).abs() < 1e-13));
                }
            }
        }
    }

    #[test]
    fn tiles_sum_in_the_same_order_on_all_processors() {
        let left = Mat::from_fn(30, 41, |i, k| ((i * 41 + k) as f64).sin());
        let right = Mat::from_fn(41, 23, |k, j| ((k * 23 + j) as f64).cos());
        let run = |by_tiles: fn(&mut [f64], MatRef<f64>, MatRef<f64>)| {
            let mut out = vec![0.0; 30 * 23];
            by_tiles(&mut out, left.as_ref(), right.as_ref());
            out
        };
        let wide = run(by_tiles::<f64, 16, 6, true>);
        assert!(wide == run(by_tiles::<f64, 8, 6, true>));
        assert!(run(by_tiles::<f64, 16, 6, false>) == run(by_tiles::<f64, 4, 4, false>));
    }
}

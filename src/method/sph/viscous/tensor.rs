//! Symmetric tensors of particles' neighbours, as six numbers: xx, yy, zz, xy, yz, xz.

/// Axes of the six products of two coordinates.
pub const AXES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

/// The six products of two coordinates, from which a quadratic form follows as a scalar product.
pub type Products = [f64; 6];

/// A matrix of N rows.
pub type Square<const N: usize> = [[f64; N]; N];

/// Distinct products of four coordinates, by their powers of x, y and z.
pub const POWERS: [[u8; 3]; 15] = [
    [4, 0, 0],
    [0, 4, 0],
    [0, 0, 4],
    [2, 2, 0],
    [0, 2, 2],
    [2, 0, 2],
    [3, 1, 0],
    [1, 3, 0],
    [0, 3, 1],
    [0, 1, 3],
    [3, 0, 1],
    [1, 0, 3],
    [2, 1, 1],
    [1, 2, 1],
    [1, 1, 2],
];

/// Places of the products of four coordinates in a matrix over pairs of coordinates.
pub const PLACES: [[usize; 6]; 6] = places();

const fn places() -> [[usize; 6]; 6] {
    let mut places = [[0; 6]; 6];
    let mut n = 0;
    while n < 36 {
        let ((a, b), (c, d)) = (AXES[n / 6], AXES[n % 6]);
        let mut powers = [0_u8; 3];
        powers[a] += 1;
        powers[b] += 1;
        powers[c] += 1;
        powers[d] += 1;
        let mut k = 0;
        while POWERS[k][0] != powers[0] || POWERS[k][1] != powers[1] || POWERS[k][2] != powers[2] {
            k += 1;
        }
        places[n / 6][n % 6] = k;
        n += 1;
    }
    places
}

pub fn times<const N: usize>(matrix: &Square<N>, vector: &[f64; N]) -> [f64; N] {
    let mut result = [0.0; N];
    for (sum, row) in result.iter_mut().zip(matrix) {
        (0..N).for_each(|n| *sum += row[n] * vector[n]);
    }
    result
}

/// `Aᵀ v`.
pub fn transposed_times<const N: usize>(matrix: &Square<N>, vector: &[f64; N]) -> [f64; N] {
    let mut result = [0.0; N];
    for (row, factor) in matrix.iter().zip(vector) {
        (0..N).for_each(|n| result[n] += factor * row[n]);
    }
    result
}

pub fn product<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let mut result = [[0.0; N]; N];
    for (row, a) in result.iter_mut().zip(a) {
        for (&factor, b) in a.iter().zip(b) {
            (0..N).for_each(|n| row[n] += factor * b[n]);
        }
    }
    result
}

/// Solves `A X = B` for a symmetric positive definite A by Cholesky's factorisation.
pub fn solve<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let mut factor = *a;
    for i in 0..N {
        for j in 0..=i {
            let mut rest = factor[i][j];
            (0..j).for_each(|k| rest -= factor[i][k] * factor[j][k]);
            factor[i][j] = if i == j { rest.sqrt().recip() } else { rest * factor[j][j] };
        }
    }
    let mut x = *b;
    for i in 0..N {
        for k in 0..i {
            (0..N).for_each(|n| x[i][n] -= factor[i][k] * x[k][n]);
        }
        (0..N).for_each(|n| x[i][n] *= factor[i][i]);
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            (0..N).for_each(|n| x[i][n] -= factor[k][i] * x[k][n]);
        }
        (0..N).for_each(|n| x[i][n] *= factor[i][i]);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_satisfies_its_equation() {
        let root: Square<6> =
            std::array::from_fn(|i| std::array::from_fn(|j| ((3 * i + 5 * j + i * j) % 7) as f64));
        let transposed: Square<6> = std::array::from_fn(|i| std::array::from_fn(|j| root[j][i]));
        let mut a = product(&root, &transposed);
        (0..6).for_each(|i| a[i][i] += 1.0);
        let x = solve(&a, &root);
        let found = product(&a, &x);
        for (found, wanted) in found.as_flattened().iter().zip(root.as_flattened()) {
            assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
        }
    }

    #[test]
    fn fourth_moments_of_a_single_neighbour() {
        let x = [0.3_f64, -0.7, 0.4];
        let power = |n: [u8; 3]| (0..3).map(|a| x[a].powi(i32::from(n[a]))).product();
        let moments: [f64; 15] = POWERS.map(power);
        let products = AXES.map(|(a, b)| x[a] * x[b]);
        for i in 0..6 {
            for j in 0..6 {
                assert!((moments[PLACES[i][j]] - products[i] * products[j]).abs() < 1e-15);
            }
        }
    }
}

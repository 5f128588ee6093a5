//! Matrices of three rows and columns.

pub type Matrix3 = [[f64; 3]; 3];

pub const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub fn product(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub fn transposed(a: &Matrix3) -> Matrix3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// Vector product a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Sum of the products of all entries.
pub fn contraction(a: &Matrix3, b: &Matrix3) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| x * y).sum()
}

/// Scales the deviator of a matrix.
pub fn scale_deviator(m: &mut Matrix3, factor: f64) {
    let mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    for (a, row) in m.iter_mut().enumerate() {
        for (b, value) in row.iter_mut().enumerate() {
            let spherical = mean * IDENTITY[a][b];
            *value = spherical + factor * (*value - spherical);
        }
    }
}

/// Inverse and determinant.
pub fn inverse(m: &Matrix3) -> (Matrix3, f64) {
    let minor = |a: usize, b: usize| {
        let ([i, j], [k, l]) = ([(a + 1) % 3, (a + 2) % 3], [(b + 1) % 3, (b + 2) % 3]);
        m[i][k] * m[j][l] - m[i][l] * m[j][k]
    };
    let determinant = (0..3).map(|b| m[0][b] * minor(0, b)).sum::<f64>();
    (std::array::from_fn(|a| std::array::from_fn(|b| minor(b, a) / determinant)), determinant)
}

/// Upper bound on the magnitude of a symmetric matrix's eigenvalues, exact for multiples of the identity.
pub fn eigenvalue_bound(m: &Matrix3) -> f64 {
    m.iter().map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as columns, by cyclic rotations (C. G. J. Jacobi 1846).
pub fn eigen(m: &Matrix3) -> ([f64; 3], Matrix3) {
    let (mut m, mut vectors) = (*m, IDENTITY);
    for _ in 0..SWEEPS {
        let beside = m[0][1].abs() + m[0][2].abs() + m[1][2].abs();
        let along = m[0][0].abs() + m[1][1].abs() + m[2][2].abs();
        // False for what is not a number, too.
        let is_rough = beside > f64::EPSILON * f64::EPSILON * along;
        if !is_rough {
            break;
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut m, &mut vectors, i, j);
        }
    }
    ([m[0][0], m[1][1], m[2][2]], vectors)
}

/// Sweeps of rotations after which any matrix is diagonal to rounding; they converge quadratically.
const SWEEPS: usize = 12;

/// Turns the axes i and j so that the entry between them vanishes.
fn rotate(m: &mut Matrix3, vectors: &mut Matrix3, i: usize, j: usize) {
    if m[i][j] == 0.0 {
        return;
    }
    let half = 0.5 * (m[j][j] - m[i][i]) / m[i][j];
    // Where the square overflows the turn is zero.
    let tangent = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    let turned = |[a, b]: [f64; 2]| [cosine * a - sine * b, sine * a + cosine * b];
    for row in m.iter_mut().chain(vectors.iter_mut()) {
        [row[i], row[j]] = turned([row[i], row[j]]);
    }
    let pairs = [0, 1, 2].map(|k| turned([m[i][k], m[j][k]]));
    (m[i], m[j]) = (pairs.map(|[a, _]| a), pairs.map(|[_, b]| b));
    (m[i][j], m[j][i]) = (0.0, 0.0);
}

/// Symmetric matrices as xx, yy, zz, xy, yz, xz.
pub type Symmetric = [f64; 6];

pub fn full([xx, yy, zz, xy, yz, xz]: Symmetric) -> Matrix3 {
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// The symmetric part.
pub fn packed(m: &Matrix3) -> Symmetric {
    let mean = |a: usize, b: usize| 0.5 * (m[a][b] + m[b][a]);
    [m[0][0], m[1][1], m[2][2], mean(0, 1), mean(1, 2), mean(0, 2)]
}

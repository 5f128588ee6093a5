//! Gauss–Legendre quadrature.

/// Points and weights of Gauss–Legendre quadrature on [−1, 1], exact to degree `2 n − 1`.
///
/// The points are the roots of the Legendre polynomial `P_n`, found by Newton's method from
/// Tricomi's estimate (Davis and Rabinowitz 1984, *Methods of Numerical Integration*, §2.7).
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (value, derivative) = legendre(n, x);
                slope = derivative;
                let change = value / derivative;
                x -= change;
                if change.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Gauss–Legendre points and weights on `[a, b]`.
pub fn gauss_on(n: usize, a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
    let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
    gauss_legendre(n).into_iter().map(move |(x, w)| (mid + half * x, half * w))
}

/// `P_n(x)` and `P_n'(x)` by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_polynomials_exactly_to_degree_2n_minus_1() {
        for n in 1..=12 {
            for degree in 0..2 * n {
                let sum: f64 =
                    gauss_legendre(n).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                let exact = if degree % 2 == 0 { 2.0 / (degree as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-14, "n = {n}, degree {degree}: {sum} != {exact}");
            }
        }
    }
}

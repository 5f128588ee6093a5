//! Tridiagonal systems of equations, for oracles in one dimension.

/// Solves `lower[i] x[i−1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i]` by elimination without pivoting, which is
/// stable for diagonally dominant and for symmetric positive definite systems. The ends of `lower` and `upper` that
/// lie outside do not matter.
pub fn solve(lower: &[f64], diagonal: &[f64], upper: &[f64], right: &[f64]) -> Vec<f64> {
    let count = right.len();
    let (mut ratio, mut x) = (vec![0.0; count], vec![0.0; count]);
    for i in 0..count {
        let (before, known) =
            if i == 0 { (0.0, 0.0) } else { (lower[i] * ratio[i - 1], lower[i] * x[i - 1]) };
        let pivot = diagonal[i] - before;
        ratio[i] = upper[i] / pivot;
        x[i] = (right[i] - known) / pivot;
    }
    for i in (1..count).rev() {
        x[i - 1] -= ratio[i - 1] * x[i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::super::checks::assert_within;
    use super::*;

    #[test]
    fn solution_satisfies_the_equations() {
        let count = 9;
        let wave = |i: usize, shift: f64| (1.7 * i as f64 + shift).sin();
        let band = |shift: f64| (0..count).map(|i| wave(i, shift)).collect::<Vec<f64>>();
        let (lower, upper, right) = (band(0.1), band(2.0), band(4.0));
        let diagonal: Vec<f64> = (0..count).map(|i| 2.5 + wave(i, 3.0)).collect();
        let x = solve(&lower, &diagonal, &upper, &right);
        for i in 0..count {
            let left = if i > 0 { lower[i] * x[i - 1] } else { 0.0 };
            let next = if i + 1 < count { upper[i] * x[i + 1] } else { 0.0 };
            assert_within(left + diagonal[i] * x[i] + next, right[i], 1e-14);
        }
        assert_eq!(solve(&[], &[], &[], &[]), Vec::<f64>::new());
    }
}

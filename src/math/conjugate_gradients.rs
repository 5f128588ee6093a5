//! Preconditioned conjugate gradients (M. R. Hestenes and E. Stiefel 1952, doi
//! 10.6028/jres.049.044).

use super::separable::dot;
use crate::runtime::parallel::Team;

/// A symmetric positive definite system, defined by its product with a vector.
pub trait Operator {
    /// Computes `out = A x`, zero at fixed unknowns.
    fn apply(&self, x: &[f64], out: &mut [f64]);

    /// Computes `out ≈ A⁻¹ r` by a symmetric positive definite operator, zero at fixed unknowns.
    fn precondition(&self, residual: &[f64], out: &mut [f64]);
}

/// Iteration limit, above what any system needs that suits its preconditioner.
pub const MOST_ITERATIONS: usize = 1000;

/// Iterations after which the rate of convergence is judged.
const FIRST: usize = 3;

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "conjugate gradients reached a relative residual of {residual:e} after {iterations} iterations; required: {tolerance:e}"
)]
pub struct NotConverged {
    pub residual: f64,
    pub iterations: usize,
    pub tolerance: f64,
}

/// Largest power of two up to the largest entry; `None` if that is zero or not finite.
fn scale_of(load: &[f64]) -> Option<f64> {
    let largest = load.iter().fold(0.0_f64, |largest, value| match value.is_nan() {
        true => f64::INFINITY,
        false => largest.max(value.abs()),
    });
    (largest.is_finite() && largest > 0.0).then(|| largest.log2().floor().exp2())
}

/// Entries that a thread processes as one piece. Sums are added in the order of the pieces, so they
/// do not depend on the number of threads.
const PIECE: usize = 1 << 12;

/// `aᵀ b`.
fn product(team: &Team, a: &[f64], b: &[f64]) -> f64 {
    let piece = |list: &[f64], i: usize| i * PIECE..list.len().min((i + 1) * PIECE);
    let sums = team.map(a.len().div_ceil(PIECE), |i| dot(&a[piece(a, i)], &b[piece(b, i)]));
    sums.into_iter().sum()
}

/// `target += factor source`.
fn add_scaled(team: &Team, target: &mut [f64], factor: f64, source: &[f64]) {
    let mut pieces: Vec<_> = target.chunks_mut(PIECE).zip(source.chunks(PIECE)).collect();
    team.for_each(&mut pieces, |_, (target, source)| {
        target.iter_mut().zip(*source).for_each(|(t, s)| *t += factor * s);
    });
}

/// `direction = improved + part direction`.
fn turn(team: &Team, direction: &mut [f64], part: f64, improved: &[f64]) {
    let mut pieces: Vec<_> = direction.chunks_mut(PIECE).zip(improved.chunks(PIECE)).collect();
    team.for_each(&mut pieces, |_, (direction, improved)| {
        direction.iter_mut().zip(*improved).for_each(|(d, z)| *d = z + part * *d);
    });
}

/// Solves `A x = load` from zero until `√(rᵀ P r)`, P the preconditioner, is below a fraction of
/// its initial value. Returns the solution and the number of iterations.
///
/// The load is zero at fixed unknowns.
pub fn solve(
    operator: &impl Operator,
    load: &[f64],
    tolerance: f64,
    team: &Team,
) -> Result<(Vec<f64>, usize), NotConverged> {
    iterate(operator, load, tolerance, (MOST_ITERATIONS, false), team)
}

/// Does the same in at most so many iterations, and gives up once the mean rate of convergence so far does not suffice
/// for that. An operator that is found not to be positive definite is none that converges.
pub fn solve_within(
    most: usize,
    operator: &impl Operator,
    load: &[f64],
    tolerance: f64,
    team: &Team,
) -> Result<(Vec<f64>, usize), NotConverged> {
    iterate(operator, load, tolerance, (most, true), team)
}

fn iterate(
    operator: &impl Operator,
    load: &[f64],
    tolerance: f64,
    (most, is_judged): (usize, bool),
    team: &Team,
) -> Result<(Vec<f64>, usize), NotConverged> {
    let mut solution = vec![0.0; load.len()];
    let Some(scale) = scale_of(load) else {
        // Not `all(0)` alone: a load of NaN has no solution.
        return match load.iter().all(|value| *value == 0.0) {
            true => Ok((solution, 0)),
            false => Err(NotConverged { residual: f64::NAN, iterations: 0, tolerance }),
        };
    };
    // Squares of very large and very small loads leave the range of numbers.
    let mut residual: Vec<f64> = load.iter().map(|value| value / scale).collect();
    let mut direction = vec![0.0; load.len()];
    operator.precondition(&residual, &mut direction);
    let mut energy = product(team, &residual, &direction);
    let (first, wanted) = (energy, tolerance * tolerance * energy);
    let failed = |energy: f64, iterations| {
        Err(NotConverged { residual: (energy / first).sqrt(), iterations, tolerance })
    };
    let (mut force, mut improved) = (vec![0.0; load.len()], vec![0.0; load.len()]);
    for iteration in 0..most {
        // Not `energy > wanted`, because NaN would then count as solved.
        if energy <= wanted {
            solution.iter_mut().for_each(|value| *value *= scale);
            return Ok((solution, iteration));
        }
        if !energy.is_finite() {
            return Err(NotConverged { residual: f64::NAN, iterations: iteration, tolerance });
        }
        let is_judged = is_judged && iteration >= FIRST;
        if is_judged && is_too_slow(energy / first, tolerance, [iteration, most]) {
            return failed(energy, iteration);
        }
        operator.apply(&direction, &mut force);
        let curvature = product(team, &direction, &force);
        if curvature <= 0.0 {
            return failed(energy, iteration);
        }
        let step = energy / curvature;
        add_scaled(team, &mut solution, step, &direction);
        add_scaled(team, &mut residual, -step, &force);
        operator.precondition(&residual, &mut improved);
        let next = product(team, &residual, &improved);
        turn(team, &mut direction, next / energy, &improved);
        energy = next;
    }
    failed(energy, most)
}

/// Returns true if iterations that go on at their mean rate do not reach the tolerance within `most`. `left` is the
/// square of the relative residual.
fn is_too_slow(left: f64, tolerance: f64, [iterations, most]: [usize; 2]) -> bool {
    left.ln() * most as f64 > 2.0 * tolerance.ln() * iterations as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `−u″` on equidistant points between two fixed ones, with its diagonal as preconditioner.
    struct Rod;

    impl Operator for Rod {
        fn apply(&self, x: &[f64], out: &mut [f64]) {
            for i in 0..x.len() {
                let [left, right] = [i.checked_sub(1), Some(i + 1)]
                    .map(|n| n.and_then(|n| x.get(n)).unwrap_or(&0.0));
                out[i] = 2.0 * x[i] - left - right;
            }
        }

        fn precondition(&self, residual: &[f64], out: &mut [f64]) {
            out.iter_mut().zip(residual).for_each(|(z, r)| *z = 0.5 * r);
        }
    }

    #[test]
    fn uniformly_loaded_rod_is_a_parabola() {
        const N: usize = 40;
        let (solution, iterations) = solve(&Rod, &[1.0; N], 1e-13, &Team::new(1)).unwrap();
        assert!(iterations <= N);
        for (i, u) in solution.iter().enumerate() {
            let wanted = 0.5 * (i as f64 + 1.0) * (N - i) as f64;
            assert!((u / wanted - 1.0).abs() < 1e-11, "{u} {wanted}");
        }
    }

    /// A diagonal matrix, without a preconditioner.
    struct Diagonal(Vec<f64>);

    impl Operator for Diagonal {
        fn apply(&self, x: &[f64], out: &mut [f64]) {
            (0..x.len()).for_each(|n| out[n] = self.0[n] * x[n]);
        }

        fn precondition(&self, residual: &[f64], out: &mut [f64]) {
            out.copy_from_slice(residual);
        }
    }

    #[test]
    fn iterations_are_given_up_where_they_are_too_slow() {
        let (matrix, team) =
            (Diagonal((0..40).map(|n| 1.0 + 0.1 * f64::from(n)).collect()), Team::new(1));
        let within = |most| solve_within(most, &matrix, &[1.0; 40], 1e-10, &team);
        assert_eq!(within(40).unwrap(), solve(&matrix, &[1.0; 40], 1e-10, &team).unwrap());
        assert_eq!(within(10).unwrap_err().iterations, FIRST);
    }

    #[test]
    fn negative_directions_of_a_load_are_found() {
        let (matrix, team) = (Diagonal(vec![1.0, 1.1, 0.9, -1e-3]), Team::new(1));
        let solved = |part: f64| solve_within(9, &matrix, &[1.0, -1.0, 0.5, part], 1e-6, &team);
        assert!(solved(0.0).is_ok());
        assert!(solved(1e-3).is_err() && solved(1.0).is_err());
    }

    #[test]
    fn solution_scales_with_the_load() {
        let (one, _) = solve(&Rod, &[1.0; 9], 1e-13, &Team::new(1)).unwrap();
        for size in [1e-300, 1e-160, 1e160, 1e300] {
            let (solution, _) = solve(&Rod, &[size; 9], 1e-13, &Team::new(1)).unwrap();
            for (u, one) in solution.iter().zip(&one) {
                assert!((u / one / size - 1.0).abs() < 1e-12, "{size}");
            }
        }
    }

    #[test]
    fn zero_and_nan_loads() {
        assert_eq!(solve(&Rod, &[0.0; 5], 1e-10, &Team::new(1)).unwrap(), (vec![0.0; 5], 0));
        for odd in [f64::NAN, f64::INFINITY] {
            let refused = solve(&Rod, &[0.0, odd, 1.0], 1e-10, &Team::new(1)).unwrap_err();
            assert_eq!(refused.iterations, 0);
        }
    }
}

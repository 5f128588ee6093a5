//! Preconditioned, stabilised biconjugate gradients for nonsymmetric systems (H. A. van der Vorst
//! 1992, doi 10.1137/0913035).

use super::conjugate_gradients::{MOST_ITERATIONS, NotConverged, Operator};
use super::separable::dot;

/// Solves `P A x = P load` from zero, P the preconditioner, until the 2-norm of the residual is
/// below a fraction of its initial value. Returns the solution and the number of iterations, with
/// two products each.
///
/// Neither A nor P need be symmetric. The load is zero at fixed unknowns.
pub fn solve(
    operator: &impl Operator,
    load: &[f64],
    tolerance: f64,
) -> Result<(Vec<f64>, usize), NotConverged> {
    let mut solution = vec![0.0; load.len()];
    if load.iter().all(|value| *value == 0.0) {
        return Ok((solution, 0));
    }
    let mut product = vec![0.0; load.len()];
    let mut apply = |x: &[f64], out: &mut [f64]| {
        operator.apply(x, &mut product);
        operator.precondition(&product, out);
    };
    let mut residual = vec![0.0; load.len()];
    operator.precondition(load, &mut residual);
    let shadow = residual.clone();
    let mut direction = residual.clone();
    let (mut along, mut onward) = (vec![0.0; load.len()], vec![0.0; load.len()]);
    let first = dot(&residual, &residual);
    let wanted = tolerance * tolerance * first;
    let mut overlap = first;
    let mut left = first;
    for iteration in 0..MOST_ITERATIONS {
        if !left.is_finite() {
            return Err(failure(left, first, iteration, tolerance));
        }
        if left <= wanted {
            return Ok((solution, iteration));
        }
        apply(&direction, &mut along);
        let step = overlap / dot(&shadow, &along);
        residual.iter_mut().zip(&along).for_each(|(r, v)| *r -= step * v);
        apply(&residual, &mut onward);
        let size = dot(&onward, &onward);
        // The first half of the iteration sufficed: nothing remains to be smoothed.
        let smoothing = if size > 0.0 { dot(&onward, &residual) / size } else { 0.0 };
        for ((x, d), r) in solution.iter_mut().zip(&direction).zip(&residual) {
            *x += step * d + smoothing * r;
        }
        residual.iter_mut().zip(&onward).for_each(|(r, t)| *r -= smoothing * t);
        left = dot(&residual, &residual);
        if left <= wanted {
            continue;
        }
        let next = dot(&shadow, &residual);
        let part = next / overlap * (step / smoothing);
        overlap = next;
        if !part.is_finite() {
            return Err(failure(left, first, iteration, tolerance));
        }
        for ((d, r), v) in direction.iter_mut().zip(&residual).zip(&along) {
            *d = r + part * (*d - smoothing * v);
        }
    }
    Err(failure(left, first, MOST_ITERATIONS, tolerance))
}

fn failure(left: f64, first: f64, iterations: usize, tolerance: f64) -> NotConverged {
    NotConverged { residual: (left / first).sqrt(), iterations, tolerance }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Diffusion and transport on equidistant points between two fixed ones.
    struct Stream(f64);

    impl Operator for Stream {
        fn apply(&self, x: &[f64], out: &mut [f64]) {
            for i in 0..x.len() {
                let [left, right] = [i.checked_sub(1), Some(i + 1)]
                    .map(|n| n.and_then(|n| x.get(n)).unwrap_or(&0.0));
                out[i] = 2.0 * x[i] - (1.0 + self.0) * left - (1.0 - self.0) * right;
            }
        }

        fn precondition(&self, residual: &[f64], out: &mut [f64]) {
            out.iter_mut().zip(residual).for_each(|(z, r)| *z = 0.5 * r);
        }
    }

    #[test]
    fn solves_nonsymmetric_systems() {
        for transport in [0.0, 0.1, 0.5] {
            let stream = Stream(transport);
            let wanted: Vec<f64> = (0..30).map(|i| (0.7 * f64::from(i)).sin() + 0.2).collect();
            let mut load = vec![0.0; 30];
            stream.apply(&wanted, &mut load);
            let (solution, iterations) = solve(&stream, &load, 1e-13).unwrap();
            assert!(iterations < 100, "{iterations}");
            for (x, exact) in solution.iter().zip(&wanted) {
                assert!((x - exact).abs() < 1e-10, "{transport}: {x} {exact}");
            }
        }
    }

    #[test]
    fn zero_and_nan_loads() {
        assert_eq!(solve(&Stream(0.3), &[0.0; 5], 1e-10).unwrap(), (vec![0.0; 5], 0));
        for odd in [f64::NAN, f64::INFINITY] {
            assert!(solve(&Stream(0.3), &[0.0, odd, 1.0], 1e-10).is_err());
        }
    }
}

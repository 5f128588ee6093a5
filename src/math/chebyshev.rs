//! Linear evolution `u' = A u + b` over a step, by Chebyshev expansion of the exponential.
//!
//! With A's eigenvalues in [−Λ, 0], `u(τ) = u₀ + τ φ₁(τA) (A u₀ + b)` and
//! `∫₀^τ u dt = τ u₀ + τ² φ₂(τA) (A u₀ + b)`, where `φ₁(z) = (e^z − 1)/z`, `φ₂(z) = (φ₁(z) − 1)/z`.
//! Both are expanded in Chebyshev polynomials of `X = 1 + 2A/Λ`. The number of products with A that
//! reaches rounding grows as √(τΛ), where one-stage explicit steps need τΛ/2 for stability alone.
//!
//! Source: H. Tal-Ezer (1989), SIAM J. Numer. Anal. 26, 1–11, doi 10.1137/0726001 (Chebyshev methods
//! for parabolic problems); the recurrences for the coefficients are derived below.

use super::separable::dot;

/// Largest half width `τΛ/2` of one expansion. Longer steps are cut in equal parts: eigenvalues a
/// little off the real axis would make terms of the sum grow as `exp(ρ δ²/2)`, δ being their
/// distance in half widths, and cost digits.
const WIDEST: f64 = 1e4;
/// What the truncated terms of an expansion may sum up to.
const TRUNCATION: f64 = 1e-14;

/// Coefficients of `φ₁(ρ(x − 1))` and `φ₂(ρ(x − 1))` in T_k(x), as many as rounding asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    pub first: Vec<f64>,
    pub second: Vec<f64>,
}

impl Expansion {
    /// The expansion for the half width `ρ = τΛ/2 > 0`.
    ///
    /// From `z φ₁ = e^z − 1` with `z = ρ(x − 1)` and `x T_k = (T_{k+1} + T_{k−1})/2` the coefficients
    /// of φ₁ follow as double sums `a_k = 2/ρ Σ_{j>k} (j − k) e_j` of those of e^z, which are
    /// `e_k = 2 e^{−ρ} I_k(ρ)`; those of φ₂ likewise from `a_k`. All terms are positive, so that
    /// nothing cancels. The coefficient of T₀ is half of what the formula gives.
    pub fn new(half_width: f64) -> Self {
        let exponential = exponential_coefficients(half_width);
        let mut first = double_sums(&exponential, half_width);
        let mut second = double_sums(&first, half_width);
        for list in [&mut first, &mut second] {
            list[0] *= 0.5;
        }
        let mut tail = 0.0;
        let beyond = first.iter().rev().take_while(|&&a| {
            tail += a;
            tail < TRUNCATION
        });
        let count = (first.len() - beyond.count()).max(2);
        first.truncate(count);
        second.truncate(count);
        Self { first, second }
    }
}

/// How a step is cut: `(equal parts, products with the matrix in each)`.
pub fn products(bound: f64, dt: f64) -> (usize, usize) {
    let parts = parts(bound, dt);
    (parts, Expansion::new(half_width(bound, dt / parts as f64)).first.len())
}

/// A system `u' = A u + b` whose matrix has its eigenvalues in `[−bound, 0]` [1/s].
///
/// `apply(row, u)` gives `(A u)_row`.
pub struct Evolution<'a, F: Fn(usize, &[f64]) -> f64 + Sync> {
    pub apply: F,
    pub bound: f64,
    pub constant: &'a [f64],
    pub threads: usize,
}

impl<F: Fn(usize, &[f64]) -> f64 + Sync> Evolution<'_, F> {
    /// Replaces `u` by its value a time `dt` later and returns `∫ ℓ·u dt` over the step.
    pub fn advance(&self, u: &mut [f64], functional: &[f64], dt: f64) -> f64 {
        let parts = parts(self.bound, dt);
        let dt = dt / parts as f64;
        let expansion = Expansion::new(half_width(self.bound, dt));
        (0..parts).map(|_| self.advance_part(u, functional, dt, &expansion)).sum()
    }

    fn advance_part(&self, u: &mut [f64], l: &[f64], dt: f64, expansion: &Expansion) -> f64 {
        let scale = if self.bound > 0.0 { 2.0 / self.bound } else { 0.0 };
        // X v = v + 2/Λ A v.
        let shifted = |row: usize, v: &[f64]| v[row] + scale * (self.apply)(row, v);
        let mut integral = dt * dot(l, u);
        let mut before = vec![0.0; u.len()];
        let rate = |row: usize, out: &mut f64| *out = (self.apply)(row, u) + self.constant[row];
        super::parallel::for_each(self.threads, &mut before, rate);
        let mut now = vec![0.0; u.len()];
        super::parallel::for_each(self.threads, &mut now, |row, out| *out = shifted(row, &before));
        let mut terms = expansion.first.iter().zip(&expansion.second);
        for term in [&before, &now] {
            if let Some((a, b)) = terms.next() {
                add(u, dt * a, term);
                integral += dt * dt * b * dot(l, term);
            }
        }
        for (a, b) in terms {
            // T_{k+1} = 2 X T_k − T_{k−1}, in the place of the latter.
            super::parallel::for_each(self.threads, &mut before, |row, out| {
                *out = 2.0 * shifted(row, &now) - *out;
            });
            std::mem::swap(&mut before, &mut now);
            add(u, dt * a, &now);
            integral += dt * dt * b * dot(l, &now);
        }
        integral
    }
}

fn half_width(bound: f64, dt: f64) -> f64 {
    (0.5 * bound * dt).max(f64::MIN_POSITIVE.sqrt())
}

fn parts(bound: f64, dt: f64) -> usize {
    (half_width(bound, dt) / WIDEST).ceil().max(1.0) as usize
}

fn add(u: &mut [f64], factor: f64, v: &[f64]) {
    for (a, b) in u.iter_mut().zip(v) {
        *a += factor * b;
    }
}

/// `2 e^{−ρ} I_k(ρ)` for k = 0, 1 …, by Miller's recurrence downwards, scaled by `Σ' = e⁰ = 1`.
fn exponential_coefficients(rho: f64) -> Vec<f64> {
    // From here on the coefficients are far below rounding: e_k < exp(−k²/2(ρ + k/3)).
    let last = (14.0 + (196.0 + 84.0 * rho).sqrt()).ceil() as usize + 8;
    let mut values = vec![0.0; last + 2];
    values[last] = 1.0;
    for k in (1..=last).rev() {
        values[k - 1] = values[k + 1] + 2.0 * k as f64 / rho * values[k];
        if values[k - 1] > 1e200 {
            let shrink = 1.0 / values[k - 1];
            values[k - 1..].iter_mut().for_each(|v| *v *= shrink);
        }
    }
    let sum = 0.5 * values[0] + values[1..].iter().sum::<f64>();
    values.iter_mut().for_each(|v| *v /= sum);
    values
}

/// `2/ρ Σ_{j>k} (j − k) c_j` for every k.
fn double_sums(c: &[f64], rho: f64) -> Vec<f64> {
    let mut out = vec![0.0; c.len()];
    let (mut sum, mut value) = (0.0, 0.0);
    for k in (0..c.len() - 1).rev() {
        sum += 2.0 / rho * c[k + 1];
        value += sum;
        out[k] = value;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(coefficients: &[f64], x: f64) -> f64 {
        let angle = x.acos();
        coefficients.iter().enumerate().map(|(k, a)| a * (k as f64 * angle).cos()).sum()
    }

    #[test]
    fn the_expansions_are_the_functions_for_any_width() {
        for half_width in [1e-9, 1e-3, 0.5, 7.0, 300.0, WIDEST] {
            let expansion = Expansion::new(half_width);
            for x in [-1.0, -0.6, 0.0, 0.7, 0.99, 0.9999] {
                let z: f64 = half_width * (x - 1.0);
                let first = z.exp_m1() / z;
                assert!((series(&expansion.first, x) - first).abs() < 4e-14, "{half_width} {x}");
                if z < -1e-2 {
                    let second = (first - 1.0) / z;
                    assert!((series(&expansion.second, x) - second).abs() < 2e-13, "{half_width}");
                }
            }
            let at_zero: f64 = expansion.first.iter().sum();
            assert!((at_zero - 1.0).abs() < 1e-14, "{at_zero}");
        }
    }

    #[test]
    fn products_grow_as_the_root_of_the_width() {
        let [few, many] = [1e2, 1e4].map(|w| Expansion::new(w).first.len() as f64);
        assert!((many / few - 10.0).abs() < 2.5, "{few} {many}");
        assert_eq!(products(2.0, 3.5 * WIDEST).0, 4);
    }

    /// Two coupled bodies: `u' = −(u − v)`, `v' = 3(u − v) + 1`.
    #[test]
    fn a_small_system_follows_its_closed_form_in_steps_of_any_length() {
        let apply = |row: usize, u: &[f64]| [-1.0, 3.0][row] * (u[0] - u[1]);
        for dt in [1e-9, 0.01, 1.0, 40.0, 2.0e4] {
            let constant = [0.0, 1.0];
            let evolution = Evolution { apply, bound: 6.0, constant: &constant, threads: 1 };
            let mut u = [1.0, 0.0];
            let integral = evolution.advance(&mut u, &[1.0, 0.0], dt);
            // d = u − v: d' = −4 d − 1; 3u + v grows by 1.
            let d0 = 1.25;
            let d = d0 * (-4.0 * dt).exp() - 0.25;
            let wanted = (3.0 + dt + d) / 4.0;
            assert!((u[0] / wanted - 1.0).abs() < 1e-12, "{dt}: {} {wanted}", u[0]);
            let exact =
                (3.0 * dt + 0.5 * dt * dt + d0 * -(-4.0 * dt).exp_m1() / 4.0 - 0.25 * dt) / 4.0;
            assert!((integral / exact - 1.0).abs() < 1e-12, "{dt}: {integral} {exact}");
        }
    }
}

//! Linear evolution `u' = A u + Σ b_k t^k/k!` over a step, by Chebyshev expansion of φ-functions.
//!
//! With A's eigenvalues in [−Λ, 0], `u(τ) = u₀ + Σ τ^{k+1} φ_{k+1}(τA) v_k` and
//! `∫₀^τ u dt = τ u₀ + Σ τ^{k+2} φ_{k+2}(τA) v_k`, where `v₀ = A u₀ + b₀`, `v_k = b_k` for k > 0,
//! `φ₀ = e^z` and `φ_{k+1}(z) = (φ_k(z) − 1/k!)/z` (M. Hochbruck and A. Ostermann 2010,
//! doi 10.1017/S0962492910000048, section 2.1). All are expanded in Chebyshev polynomials of
//! `X = 1 + 2A/Λ`. The number of products with A that reaches rounding grows as √(τΛ), where
//! one-stage explicit steps need τΛ/2 for stability alone; each `b_k ≠ 0` of k > 0 takes as many
//! again.
//!
//! Source: H. Tal-Ezer (1989), SIAM J. Numer. Anal. 26, 1–11, doi 10.1137/0726001 (Chebyshev methods
//! for parabolic problems); the recurrences for the coefficients are derived below.

use super::separable::dot;
use crate::runtime::allowance::{Allowance, Halt};

/// Largest half width `τΛ/2` of one expansion. Longer steps are cut into equal parts: eigenvalues
/// slightly off the real axis would make terms grow as `exp(ρ δ²/2)`, δ being their distance in
/// half widths, and lose digits.
const WIDEST: f64 = 1e4;
/// Bound on the sum of the truncated terms of an expansion.
const TRUNCATION: f64 = 1e-14;

/// Coefficients of `φ₁(ρ(x − 1))`, `φ₂(ρ(x − 1))` … in T_j(x), truncated at rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion(pub Vec<Vec<f64>>);

impl Expansion {
    /// Expands the first `count` functions for the half width `ρ = τΛ/2 > 0`.
    ///
    /// From `z φ_{k+1} = φ_k − 1/k!` with `z = ρ(x − 1)` and `x T_j = (T_{j+1} + T_{j−1})/2`, the
    /// coefficients of φ₁ follow as double sums `a_j = 2/ρ Σ_{i>j} (i − j) e_i` of those of e^z,
    /// which are `e_j = 2 e^{−ρ} I_j(ρ)`. Those of φ₂ follow likewise from `a_j`, and so on. All
    /// terms are positive, so there is no cancellation. The coefficient of T₀ is half of the
    /// formula's value.
    pub fn new(half_width: f64, count: usize) -> Self {
        let exponential = exponential_coefficients(half_width);
        let next = |list: &Vec<f64>| Some(double_sums(list, half_width));
        let functions = std::iter::successors(next(&exponential), next).take(count);
        let mut functions: Vec<Vec<f64>> = functions.collect();
        for list in &mut functions {
            list[0] *= 0.5;
        }
        let first = &functions[0];
        let mut tail = 0.0;
        let beyond = first.iter().rev().take_while(|&&a| {
            tail += a;
            tail < TRUNCATION
        });
        let terms = (first.len() - beyond.count()).max(2);
        functions.iter_mut().for_each(|list| list.truncate(terms));
        Self(functions)
    }
}

/// Partition of a step under constant loads: `(equal parts, products with the matrix in each)`.
pub fn products(bound: f64, dt: f64) -> (usize, usize) {
    let parts = parts(bound, dt);
    let width = half_width(bound, dt / parts).min(WIDEST);
    (parts as usize, Expansion::new(width, 1).0[0].len())
}

/// Name of the loop over products in messages.
const PRODUCTS: &str = "products of particles' conduction";

/// A system `u' = A u + Σ b_k t^k/k!` whose matrix has its eigenvalues in `[−bound, 0]` [1/s].
///
/// `apply(row, u)` returns `(A u)_row`; `sources` are the `b_k`: the load at the beginning, and its
/// time derivatives. There is at least one.
pub struct Evolution<'a, F: Fn(usize, &[f64]) -> f64 + Sync> {
    pub apply: F,
    pub bound: f64,
    pub sources: &'a [Vec<f64>],
    pub threads: usize,
}

impl<F: Fn(usize, &[f64]) -> f64 + Sync> Evolution<'_, F> {
    /// Replaces `u` by its value after a time `dt` and returns `∫ ℓ·u dt` over the step; an empty ℓ
    /// is zero. After a halt the values of `u` are undefined.
    pub fn advance(
        &self,
        u: &mut [f64],
        functional: &[f64],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<f64, Halt> {
        let parts = parts(self.bound, dt);
        // No expansion exists for infinite widths.
        allowance.foresee(parts, PRODUCTS, u.len())?;
        let dt = dt / parts;
        let Expansion(functions) =
            Expansion::new(half_width(self.bound, dt), self.sources.len() + 1);
        allowance.foresee(parts * functions[0].len() as f64, PRODUCTS, u.len())?;
        let mut sources = self.sources.to_vec();
        let mut integral = 0.0;
        for part in 0..parts as usize {
            if part > 0 {
                advance_polynomial(&mut sources, dt);
            }
            integral += dt * dot(functional, u);
            let now: &[f64] = u;
            let mut first = sources[0].clone();
            let add_rate = |row: usize, out: &mut f64| *out += (self.apply)(row, now);
            crate::runtime::parallel::for_each(self.threads, &mut first, add_rate);
            let mut power = dt;
            for (k, source) in std::iter::once(&first).chain(&sources[1..]).enumerate() {
                if source.iter().any(|&v| v != 0.0) {
                    let weights = [&functions[k], &functions[k + 1]].map(Vec::as_slice);
                    let sum =
                        self.add_driven(u, source, functional, (weights, power), allowance)?;
                    integral += dt * sum;
                }
                power *= dt;
            }
        }
        Ok(integral)
    }

    /// Adds `τ^{k+1} φ_{k+1}(τA) v` to `u` and returns `τ^{k+1} ℓ·φ_{k+2}(τA) v`; `power` is
    /// `τ^{k+1}`.
    fn add_driven(
        &self,
        u: &mut [f64],
        v: &[f64],
        l: &[f64],
        ([value, integral], power): ([&[f64]; 2], f64),
        allowance: &Allowance,
    ) -> Result<f64, Halt> {
        let scale = if self.bound > 0.0 { 2.0 / self.bound } else { 0.0 };
        // X v = v + 2/Λ A v.
        let shifted = |row: usize, v: &[f64]| v[row] + scale * (self.apply)(row, v);
        let mut before = v.to_vec();
        let mut now = vec![0.0; v.len()];
        crate::runtime::parallel::for_each(self.threads, &mut now, |row, out| {
            *out = shifted(row, &before)
        });
        let mut sum = 0.0;
        let mut terms = value.iter().zip(integral);
        for term in [&before, &now] {
            if let Some((a, b)) = terms.next() {
                add(u, power * a, term);
                sum += power * b * dot(l, term);
            }
        }
        for (a, b) in terms {
            allowance.spend(1.0, PRODUCTS, v.len())?;
            // T_{j+1} = 2 X T_j − T_{j−1}, stored over the latter.
            crate::runtime::parallel::for_each(self.threads, &mut before, |row, out| {
                *out = 2.0 * shifted(row, &now) - *out;
            });
            std::mem::swap(&mut before, &mut now);
            add(u, power * a, &now);
            sum += power * b * dot(l, &now);
        }
        Ok(sum)
    }
}

/// Advances a polynomial's value and derivatives by a time `dt`.
fn advance_polynomial(derivatives: &mut [Vec<f64>], dt: f64) {
    for k in 0..derivatives.len() {
        let (own, higher) = derivatives[k..].split_at_mut(1);
        let mut weight = 1.0;
        for (j, list) in higher.iter().enumerate() {
            weight *= dt / (j + 1) as f64;
            add(&mut own[0], weight, list);
        }
    }
}

fn half_width(bound: f64, dt: f64) -> f64 {
    (0.5 * bound * dt).max(f64::MIN_POSITIVE.sqrt())
}

fn parts(bound: f64, dt: f64) -> f64 {
    (half_width(bound, dt) / WIDEST).ceil().max(1.0)
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
    use crate::math::exponential;

    fn series(coefficients: &[f64], x: f64) -> f64 {
        let angle = x.acos();
        coefficients.iter().enumerate().map(|(k, a)| a * (k as f64 * angle).cos()).sum()
    }

    #[test]
    fn expansions_match_functions_for_any_width() {
        for half_width in [1e-9, 1e-3, 0.5, 7.0, 300.0, WIDEST] {
            let Expansion(functions) = Expansion::new(half_width, 3);
            for x in [-1.0, -0.6, 0.0, 0.7, 0.99, 0.9999] {
                let z: f64 = half_width * (x - 1.0);
                let weights = exponential::weights(-z);
                for (k, list) in functions.iter().enumerate() {
                    let found = series(list, x);
                    assert!((found - weights[k + 1]).abs() < 4e-14, "{half_width} {x}, φ{}", k + 1);
                }
            }
            for (list, wanted) in functions.iter().zip([1.0, 1.0 / 2.0, 1.0 / 6.0]) {
                let at_zero: f64 = list.iter().sum();
                assert!((at_zero / wanted - 1.0).abs() < 1e-13, "{half_width}: {at_zero}");
            }
        }
    }

    #[test]
    fn number_of_products_grows_as_root_of_width() {
        let [few, many] = [1e2, 1e4].map(|w| Expansion::new(w, 1).0[0].len() as f64);
        assert!((many / few - 10.0).abs() < 2.5, "{few} {many}");
        assert_eq!(products(2.0, 3.5 * WIDEST).0, 4);
    }

    /// Two coupled bodies: `u' = −(u − v)`, `v' = 3(u − v) + 1`.
    #[test]
    fn two_body_system_matches_closed_form() {
        let apply = |row: usize, u: &[f64]| [-1.0, 3.0][row] * (u[0] - u[1]);
        for dt in [1e-9, 0.01, 1.0, 40.0, 2.0e4] {
            let sources = [vec![0.0, 1.0]];
            let evolution = Evolution { apply, bound: 6.0, sources: &sources, threads: 1 };
            let mut u = [1.0, 0.0];
            let integral =
                evolution.advance(&mut u, &[1.0, 0.0], dt, &Allowance::default()).unwrap();
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

    /// `u' = −λ u + 1 + 2 t + 3 t²/2` compared with its φ-functions.
    #[test]
    fn quadratic_source_is_integrated_exactly() {
        let rates: [f64; 3] = [0.0, 0.7, 5.0];
        let apply = |row: usize, u: &[f64]| -rates[row] * u[row];
        let sources = [1.0, 2.0, 3.0].map(|b| vec![b; 3]);
        for dt in [1e-9, 0.01, 3.0, 1.2e4] {
            let evolution = Evolution { apply, bound: 5.0, sources: &sources, threads: 1 };
            let solution = |rate: f64, shift: usize| {
                let phi = exponential::weights(rate * dt);
                let term = |(k, b): (usize, &Vec<f64>)| {
                    b[0] * dt.powi((k + 1 + shift) as i32) * phi[k + 1 + shift]
                };
                let driven: f64 = sources.iter().enumerate().map(term).sum();
                0.25 * dt.powi(shift as i32) * phi[shift] + driven
            };
            for (row, rate) in rates.into_iter().enumerate() {
                let mut functional = [0.0; 3];
                functional[row] = 1.0;
                let mut u = [0.25; 3];
                let integral =
                    evolution.advance(&mut u, &functional, dt, &Allowance::default()).unwrap();
                for (shift, value) in [u[row], integral].into_iter().enumerate() {
                    let (wanted, undamped) = (solution(rate, shift), solution(0.0, shift));
                    let error = (value - wanted).abs();
                    assert!(error < 1e-13 * undamped, "{dt}, {rate}: {value}, not {wanted}");
                }
            }
        }
    }

    #[test]
    fn infinite_step_is_refused() {
        for bound in [1e40, f64::INFINITY] {
            let apply = |row: usize, u: &[f64]| -bound * u[row];
            let evolution = Evolution { apply, bound, sources: &[vec![1.0]], threads: 1 };
            let halt = evolution.advance(&mut [1.0], &[], 1.0, &Allowance::default());
            assert!(matches!(halt, Err(Halt::TooLong { .. })), "{halt:?}");
            let (_, terms) = products(bound, 1.0);
            assert!(terms < 2000, "{terms}");
        }
    }
}

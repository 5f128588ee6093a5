//! A bound of what a reduced system errs by under any inputs within limits.
//!
//! If an input stays within `|u_j| ≤ U_j` for all time, outputs of two systems that both start from rest differ by no more
//! than `Σ_j U_j ∫₀^∞ |h_kj − ĥ_kj| dt`. The difference of impulse responses is a sum of exponentials
//! `f(t) = Σ w_i e^{−α_i t}`. Over cells of `s = ln t`, short beside 1, it is bounded by its Taylor polynomial in s at the
//! middle, whose derivatives are sums again (`d/ds = t d/dt`), and by the remainder, term by term: with
//! `D⁶ e^{−x} = (x⁶ − 15x⁵ + 65x⁴ − 90x³ + 31x² − x) e^{−x}`, `x = αt`. What is before the first cell and behind the last
//! one is bounded in closed form. No point of time is left out.

use super::balanced::Truncated;

/// Half the length of a cell along ln t.
const HALF: f64 = 0.025;
/// Where cells begin and end: over the fastest and the slowest rate.
const BEGIN: f64 = 1e-6;
const END: f64 = 45.0;
/// Order of the remainder.
const ORDER: usize = 6;
/// Rounding of a term, over it.
const ROUNDING: f64 = 1e-14;

/// Whether a bound is wanted, or an estimate that is cheaper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Bound,
    Estimate,
}

/// Differences of all outputs' answers to all inputs, over the same rates.
struct Differences {
    rates: Vec<f64>,
    /// For each output and input, a weight for each rate.
    weights: Vec<Vec<f64>>,
}

/// For each output and input `∫₀^∞ |h − ĥ| dt` of residues at points and a truncated system.
pub fn integrals(
    points: &[f64],
    residues: &[Vec<&[f64]>],
    truncated: &Truncated,
    wanted: Wanted,
) -> Vec<Vec<f64>> {
    let inputs = truncated.inputs.len();
    let weights = |(row, outputs): (&Vec<&[f64]>, &Vec<f64>)| {
        let of_pair = |(values, inputs): (&&[f64], &Vec<f64>)| {
            let own = inputs.iter().zip(outputs).map(|(b, c)| -b * c);
            values.iter().copied().chain(own).collect::<Vec<f64>>()
        };
        row.iter().zip(&truncated.inputs).map(of_pair).collect::<Vec<_>>()
    };
    let all = residues.iter().zip(&truncated.outputs).flat_map(weights);
    let rates = points.iter().chain(&truncated.rates).copied().collect();
    let found = Differences { rates, weights: all.collect() }.integrals(wanted);
    found.chunks(inputs.max(1)).map(<[f64]>::to_vec).collect()
}

/// Estimate of `∫₀^∞ |h| dt` of one answer.
pub fn integral(points: &[f64], values: &[f64]) -> f64 {
    let all = Differences { rates: points.to_vec(), weights: vec![values.to_vec()] };
    all.integrals(Wanted::Estimate)[0]
}

impl Differences {
    fn integrals(&self, wanted: Wanted) -> Vec<f64> {
        let least = self.rates.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.rates.iter().copied().fold(0.0, f64::max);
        if self.rates.is_empty() {
            return vec![0.0; self.weights.len()];
        }
        let (begin, end) = (BEGIN / most, END / least);
        let cells = ((end / begin).ln() / (2.0 * HALF)).ceil();
        let mut sums: Vec<f64> = self.weights.iter().map(|w| self.ends(w, begin, end)).collect();
        for cell in 0..cells as usize {
            let middle = begin * ((2.0 * cell as f64 + 1.0) * HALF).exp();
            let length = 2.0 * middle * HALF.sinh();
            let terms = self.terms(middle, wanted);
            for (sum, weights) in sums.iter_mut().zip(&self.weights) {
                *sum += length * bound(&terms, weights);
            }
        }
        sums
    }

    /// Before the first cell, where exponents are small, and behind the last one.
    fn ends(&self, weights: &[f64], begin: f64, end: f64) -> f64 {
        let value: f64 = weights.iter().sum();
        let parts = weights.iter().zip(&self.rates);
        let (mut change, mut tail) = (0.0, 0.0);
        for (weight, rate) in parts {
            change += weight.abs() * (rate * begin + ROUNDING);
            tail += weight.abs() / rate * (-rate * end).exp();
        }
        begin * (value.abs() + change) + tail
    }

    /// Of each rate that has not died out `D^k e^{−x} δ^k/k!` for k = 0 … 5, and the remainder.
    fn terms(&self, t: f64, wanted: Wanted) -> Vec<(usize, [f64; ORDER + 1])> {
        let live = self.rates.iter().enumerate().filter(|(_, rate)| *rate * t < 600.0);
        live.map(|(i, rate)| (i, derivatives(rate * t, wanted))).collect()
    }
}

fn derivatives(x: f64, wanted: Wanted) -> [f64; ORDER + 1] {
    let decay = (-x).exp();
    let mut out = [0.0; ORDER + 1];
    out[0] = decay;
    if wanted == Wanted::Estimate {
        return out;
    }
    let powers = [
        -x,
        x * (x - 1.0),
        x * (-1.0 + x * (3.0 - x)),
        x * (-1.0 + x * (7.0 + x * (-6.0 + x))),
        x * (-1.0 + x * (15.0 + x * (-25.0 + x * (10.0 - x)))),
    ];
    let mut scale = 1.0;
    for (k, polynomial) in powers.into_iter().enumerate() {
        scale *= HALF / (k + 1) as f64;
        out[k + 1] = scale * polynomial * decay;
    }
    // The highest that any x of the cell may make of it.
    let y = x * HALF.exp();
    let sixth = y * (1.0 + y * (31.0 + y * (90.0 + y * (65.0 + y * (15.0 + y)))));
    out[ORDER] = scale * HALF / 6.0 * sixth * (-x * (-HALF).exp()).exp() + ROUNDING * decay;
    out
}

/// Bound of |f| over a cell.
fn bound(terms: &[(usize, [f64; ORDER + 1])], weights: &[f64]) -> f64 {
    let mut sums = [0.0; ORDER + 1];
    for (i, term) in terms {
        let weight = weights[*i];
        for (sum, value) in sums[..ORDER].iter_mut().zip(term) {
            *sum += weight * value;
        }
        sums[ORDER] += weight.abs() * term[ORDER];
    }
    sums.iter().map(|sum| sum.abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral_of(points: &[f64], values: &[f64], wanted: Wanted) -> f64 {
        let none =
            Truncated { rates: Vec::new(), inputs: vec![Vec::new()], outputs: vec![Vec::new()] };
        integrals(points, &[vec![values]], &none, wanted)[0][0]
    }

    #[test]
    fn integrals_with_changes_of_sign_are_bounded_closely() {
        // e^{−t} − 3 e^{−2t}: zero at ln 3, ∫|f| = −F(0) + 2 F(ln 3), with F = −e^{−t} + 1.5 e^{−2t}.
        let antiderivative = |t: f64| -(-t).exp() + 1.5 * (-2.0 * t).exp();
        let exact = antiderivative(0.0) - 2.0 * antiderivative(3f64.ln());
        let found = integral_of(&[1.0, 2.0], &[1.0, -3.0], Wanted::Bound);
        assert!(found >= exact && found < 1.1 * exact, "{found} {exact}");
    }

    #[test]
    fn exponentials_of_all_rates_are_bounded_by_their_integrals() {
        for rate in [1e-9, 1.0, 1e12] {
            let found = integral_of(&[rate], &[2.0], Wanted::Bound) * rate / 2.0;
            assert!((1.0..1.06).contains(&found), "{found}");
        }
        // What cancels leaves next to nothing.
        let found = integral_of(&[1.0, 1.0], &[1e3, -1e3], Wanted::Bound);
        assert!(found < 3e-6, "{found:e}");
    }

    #[test]
    fn a_bound_is_never_below_a_fine_sum() {
        let rates: [f64; 6] = [0.1, 0.9, 1.1, 30.0, 1e4, 2e4];
        let values = [0.01, -5.0, 5.2, 40.0, -3e4, 2.9e4];
        let (steps, from, to) = (200_000, 1e-9_f64.ln(), 400_f64.ln());
        let ds = (to - from) / f64::from(steps);
        let f = |t: f64| rates.iter().zip(&values).map(|(a, w)| w * (-a * t).exp()).sum::<f64>();
        let fine: f64 = (0..=steps)
            .map(|i| (from + f64::from(i) * ds).exp())
            .map(|t| t * ds * f(t).abs())
            .sum();
        let found = integral_of(&rates, &values, Wanted::Bound);
        assert!(found >= fine * (1.0 - 1e-6) && found < 1.1 * fine, "{found} {fine}");
    }
}

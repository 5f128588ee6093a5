//! A bound of what a reduced system errs by under any inputs within limits.
//!
//! If an input stays within `|u_j| ≤ U_j` for all time, outputs of two systems that both start from rest differ by no more
//! than `Σ_j U_j ∫₀^∞ |h_kj − ĥ_kj| dt`. The difference of impulse responses is a sum of exponentials
//! `f(t) = Σ w_i e^{−α_i t}`. Over cells of `s = ln t`, short beside 1, it is bounded by its Taylor polynomial in s at the
//! middle, whose derivatives are sums again (`d/ds = t d/dt`), and by the remainder, term by term: with
//! `D⁶ e^{−x} = (x⁶ − 15x⁵ + 65x⁴ − 90x³ + 31x² − x) e^{−x}`, `x = αt`. What is before the first cell and behind the last
//! one is bounded in closed form. No point of time is left out.

use super::balanced::{Complex, Truncated};

/// Half the length of a cell along ln t, of a bound and of an estimate.
const HALF: f64 = 0.025;
const HALF_OF_ESTIMATE: f64 = 0.1;
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

/// Differences of all outputs' answers to all inputs, over the same rates and poles.
struct Differences<'a> {
    rates: Vec<f64>,
    poles: &'a [Complex],
    /// For each output and input.
    weights: Vec<Weights>,
}

/// A weight for each rate, and one for each pole with its size.
struct Weights {
    of_rates: Vec<f64>,
    of_poles: Vec<Complex>,
    sizes: Vec<f64>,
}

impl Weights {
    fn new(of_rates: Vec<f64>, of_poles: Vec<Complex>) -> Self {
        let sizes = of_poles.iter().map(size).collect();
        Self { of_rates, of_poles, sizes }
    }
}

/// For each output and input `∫₀^∞ |h − ĥ| dt` of residues at points and a truncated system.
pub fn integrals(
    points: &[f64],
    residues: &[Vec<&[f64]>],
    truncated: &Truncated,
    wanted: Wanted,
) -> Vec<Vec<f64>> {
    let inputs = truncated.inputs.len();
    let weights = |(row, outputs): (&Vec<&[f64]>, &Vec<Complex>)| {
        let of_pair = |(values, inputs): (&&[f64], &Vec<Complex>)| {
            let own = inputs.iter().zip(outputs).map(|(b, c)| times(*b, *c).map(|part| -part));
            Weights::new(values.to_vec(), own.collect())
        };
        row.iter().zip(&truncated.inputs).map(of_pair).collect::<Vec<_>>()
    };
    let all = residues.iter().zip(&truncated.outputs).flat_map(weights);
    let differences =
        Differences { rates: points.to_vec(), poles: &truncated.poles, weights: all.collect() };
    let found = differences.integrals(wanted);
    found.chunks(inputs.max(1)).map(<[f64]>::to_vec).collect()
}

/// Estimate of `∫₀^∞ |h| dt` of one answer.
pub fn integral(points: &[f64], values: &[f64]) -> f64 {
    let all = Differences {
        rates: points.to_vec(),
        poles: &[],
        weights: vec![Weights::new(values.to_vec(), Vec::new())],
    };
    all.integrals(Wanted::Estimate)[0]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn size(a: &Complex) -> f64 {
    a[0].hypot(a[1])
}

/// Of an exponential `D^k e^{−x} δ^k/k!` for k = 0 … 5, and the remainder.
type Terms = ([Complex; ORDER], f64);

impl Differences<'_> {
    fn integrals(&self, wanted: Wanted) -> Vec<f64> {
        let slowest = self.rates.iter().copied().chain(self.poles.iter().map(|pole| pole[0]));
        let fastest = self.rates.iter().copied().chain(self.poles.iter().map(size));
        let least = slowest.fold(f64::INFINITY, f64::min);
        let most = fastest.fold(0.0, f64::max);
        if most == 0.0 {
            return vec![0.0; self.weights.len()];
        }
        let half = if wanted == Wanted::Estimate { HALF_OF_ESTIMATE } else { HALF };
        let (begin, end) = (BEGIN / most, END / least);
        let cells = ((end / begin).ln() / (2.0 * half)).ceil();
        let mut sums: Vec<f64> = self.weights.iter().map(|w| self.ends(w, begin, end)).collect();
        for cell in 0..cells as usize {
            let middle = begin * ((2.0 * cell as f64 + 1.0) * half).exp();
            let length = 2.0 * middle * half.sinh();
            let live = self.rates.iter().enumerate().filter(|(_, rate)| *rate * middle < 600.0);
            let real: Vec<(usize, Terms)> =
                live.map(|(i, rate)| (i, derivatives([rate * middle, 0.0], wanted))).collect();
            let of_pole = |pole: &Complex| derivatives(pole.map(|part| part * middle), wanted);
            let complex: Vec<Terms> = self.poles.iter().map(of_pole).collect();
            for (sum, weights) in sums.iter_mut().zip(&self.weights) {
                *sum += length * bound(&real, &complex, weights, wanted);
            }
        }
        sums
    }

    /// Before the first cell, where exponents are small, and behind the last one.
    fn ends(&self, weights: &Weights, begin: f64, end: f64) -> f64 {
        let Weights { of_rates, of_poles, sizes } = weights;
        let value = of_rates.iter().chain(of_poles.iter().map(|weight| &weight[0])).sum::<f64>();
        let (mut change, mut tail) = (0.0, 0.0);
        let mut add = |weight: f64, [least, most]: [f64; 2]| {
            change += weight * (most * begin + ROUNDING);
            tail += weight / least * (-least * end).exp();
        };
        of_rates.iter().zip(&self.rates).for_each(|(weight, rate)| add(weight.abs(), [*rate; 2]));
        let poles = sizes.iter().zip(self.poles);
        poles.for_each(|(weight, pole)| add(*weight, [pole[0], size(pole)]));
        begin * (value.abs() + change) + tail
    }
}

fn derivatives(x: Complex, wanted: Wanted) -> Terms {
    let decay = (-x[0]).exp();
    let decay = [decay * x[1].cos(), -decay * x[1].sin()];
    let mut out = [[0.0; 2]; ORDER];
    out[0] = decay;
    if wanted == Wanted::Estimate {
        return (out, 0.0);
    }
    // `D^k e^{−x}` over `e^{−x}`, by their coefficients from x on.
    const POLYNOMIALS: [&[f64]; 5] = [
        &[-1.0],
        &[-1.0, 1.0],
        &[-1.0, 3.0, -1.0],
        &[-1.0, 7.0, -6.0, 1.0],
        &[-1.0, 15.0, -25.0, 10.0, -1.0],
    ];
    let mut scale = 1.0;
    for (k, coefficients) in POLYNOMIALS.into_iter().enumerate() {
        scale *= HALF / (k + 1) as f64;
        let mut sum = [0.0; 2];
        for coefficient in coefficients.iter().rev() {
            sum = times(sum, x);
            sum[0] += coefficient;
        }
        out[k + 1] = times(times(sum, x), decay).map(|part| scale * part);
    }
    // The highest that any x of the cell may make of it.
    let y = size(&x) * HALF.exp();
    let sixth = y * (1.0 + y * (31.0 + y * (90.0 + y * (65.0 + y * (15.0 + y)))));
    let rest = scale * HALF / 6.0 * sixth * (-x[0] * (-HALF).exp()).exp();
    (out, rest + ROUNDING * size(&decay))
}

/// Bound of |f| over a cell; of terms without derivatives an estimate.
fn bound(real: &[(usize, Terms)], complex: &[Terms], weights: &Weights, wanted: Wanted) -> f64 {
    let poles = weights.of_poles.iter().zip(complex);
    if wanted == Wanted::Estimate {
        let own: f64 = real.iter().map(|(i, (terms, _))| weights.of_rates[*i] * terms[0][0]).sum();
        let others: f64 = poles.map(|(weight, (terms, _))| times(*weight, terms[0])[0]).sum();
        return (own + others).abs();
    }
    let (mut sums, mut rest) = ([0.0; ORDER], 0.0);
    for (i, (terms, remainder)) in real {
        let weight = weights.of_rates[*i];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term[0]);
        rest += weight.abs() * remainder;
    }
    for ((weight, (terms, remainder)), size) in poles.zip(&weights.sizes) {
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += times(*weight, *term)[0]);
        rest += size * remainder;
    }
    rest + sums.iter().map(|sum| sum.abs()).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral_of(points: &[f64], values: &[f64], wanted: Wanted) -> f64 {
        let none =
            Truncated { poles: Vec::new(), inputs: vec![Vec::new()], outputs: vec![Vec::new()] };
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
        // What cancels leaves the remainders alone: δ⁶/6! ∫ (x⁶ + 15x⁵ + …) e^{−x} dx = 1.6e-9 of each integral, a third more
        // for the cell's width.
        let found = integral_of(&[1.0, 1.0], &[1e3, -1e3], Wanted::Bound);
        assert!(found < 2.2e-9 * 2e3, "{found:e}");
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

//! A bound on the error of a reduced system for all inputs within limits.
//!
//! If an input stays within `|u_j| ≤ U_j` for all time, outputs of two systems that both start from
//! rest differ by no more than `Σ_j U_j ∫₀^∞ |h_kj − ĥ_kj| dt`. The difference of impulse responses
//! is a sum of exponentials `f(t) = Σ w_i e^{−α_i t}`. Over cells of `s = ln t` much shorter than
//! 1, its Taylor polynomial in s at the middle bounds it, term by term, together with the
//! remainder. The derivatives are sums again (`d/ds = t d/dt`), with
//! `D⁶ e^{−x} = (x⁶ − 15x⁵ + 65x⁴ − 90x³ + 31x² − x) e^{−x}`, `x = αt`. Closed forms bound the
//! times before the first cell and behind the last one, so the bound covers all times.

use faer::Mat;

use super::balanced::{Complex, Truncated};
use crate::math::product::product;

/// Half the length of a cell along ln t, for a bound and for an estimate.
const HALF: f64 = 0.025;
const HALF_OF_ESTIMATE: f64 = 0.1;
/// First and last end of the cells, over the fastest and the slowest rate.
const BEGIN: f64 = 1e-6;
const END: f64 = 45.0;
/// Exponent beyond which a term vanishes.
const GONE: f64 = 600.0;
/// Order of the remainder.
const ORDER: usize = 6;
/// Relative rounding error of a term.
const ROUNDING: f64 = 1e-14;

/// Kind of result: a bound, or a cheaper estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Bound,
    Estimate,
}

/// Differences of all impulse responses, over the same rates and poles.
struct Differences<'a> {
    rates: Vec<f64>,
    poles: &'a [Complex],
    /// For each output and input, a weight for each rate, and one for each pole.
    weights: Vec<(Vec<f64>, Vec<Complex>)>,
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
            (values.to_vec(), own.collect::<Vec<Complex>>())
        };
        row.iter().zip(&truncated.inputs).map(of_pair).collect::<Vec<_>>()
    };
    let all = residues.iter().zip(&truncated.outputs).flat_map(weights);
    let differences =
        Differences { rates: points.to_vec(), poles: &truncated.poles, weights: all.collect() };
    let found = differences.integrals(wanted);
    found.chunks(inputs.max(1)).map(<[f64]>::to_vec).collect()
}

/// Estimate of `∫₀^∞ |h| dt` of one impulse response.
pub fn integral(points: &[f64], values: &[f64]) -> f64 {
    let all = Differences {
        rates: points.to_vec(),
        poles: &[],
        weights: vec![(values.to_vec(), Vec::new())],
    };
    all.integrals(Wanted::Estimate)[0]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn size(a: &Complex) -> f64 {
    a[0].hypot(a[1])
}

/// `D^k e^{−x} δ^k/k!` of an exponential for k = 0 … 5, and the remainder.
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
        let (begin, end) = (BEGIN / most, END / least);
        let half = if wanted == Wanted::Estimate { HALF_OF_ESTIMATE } else { HALF };
        let cells = ((end / begin).ln() / (2.0 * half)).ceil() as usize;
        let middle = |cell: usize| begin * ((2.0 * cell as f64 + 1.0) * half).exp();
        let lengths: Vec<f64> = (0..cells).map(|cell| 2.0 * middle(cell) * half.sinh()).collect();
        let heights = self.heights(&(0..cells).map(middle).collect::<Vec<_>>(), wanted);
        let pairs = self.weights.iter().zip(heights.chunks(cells));
        let sum = |(weights, heights): (&(Vec<f64>, Vec<Complex>), &[f64])| {
            let parts = heights.iter().zip(&lengths).map(|(height, length)| height * length);
            self.ends(weights, begin, end) + parts.sum::<f64>()
        };
        pairs.map(sum).collect()
    }

    /// Bounds (or estimates) of |f| over cells about these times, grouped by pairs of output and
    /// input.
    fn heights(&self, middles: &[f64], wanted: Wanted) -> Vec<f64> {
        let (rates, poles) = (self.rates.len(), self.poles.len());
        let (cells, pairs) = (middles.len(), self.weights.len());
        let powers = if wanted == Wanted::Bound { ORDER } else { 1 };
        // The real and the imaginary part of a pole are adjacent.
        let mut terms = vec![Mat::<f64>::zeros(cells, rates + 2 * poles); powers];
        let mut rests = Mat::<f64>::zeros(cells, rates + poles);
        for (cell, middle) in middles.iter().enumerate() {
            let of_rates = self.rates.iter().map(|rate| [rate * middle, 0.0]);
            let of_poles = self.poles.iter().map(|pole| pole.map(|part| part * middle));
            for (i, x) in of_rates.chain(of_poles).enumerate() {
                if x[0] >= GONE {
                    continue;
                }
                let (values, rest) = derivatives(x, wanted);
                rests[(cell, i)] = rest;
                for (terms, value) in terms.iter_mut().zip(values) {
                    match i.checked_sub(rates) {
                        None => terms[(cell, i)] = value[0],
                        Some(pole) => {
                            terms[(cell, rates + 2 * pole)] = value[0];
                            terms[(cell, rates + 2 * pole + 1)] = -value[1];
                        }
                    }
                }
            }
        }
        let weights = Mat::from_fn(rates + 2 * poles, pairs, |i, pair| {
            let (of_rates, of_poles) = &self.weights[pair];
            i.checked_sub(rates).map_or_else(|| of_rates[i], |at| of_poles[at / 2][at % 2])
        });
        let mut heights = vec![0.0; cells * pairs];
        let mut sums = vec![0.0; cells * pairs];
        for terms in &terms {
            product(&mut sums, terms.as_ref(), weights.as_ref());
            heights.iter_mut().zip(&sums).for_each(|(height, sum)| *height += sum.abs());
        }
        if wanted == Wanted::Bound {
            let sizes = Mat::from_fn(rates + poles, pairs, |i, pair| {
                let (of_rates, of_poles) = &self.weights[pair];
                i.checked_sub(rates).map_or_else(|| of_rates[i].abs(), |at| size(&of_poles[at]))
            });
            product(&mut sums, rests.as_ref(), sizes.as_ref());
            heights.iter_mut().zip(&sums).for_each(|(height, sum)| *height += sum);
        }
        heights
    }

    /// Bounds before the first cell, where exponents are small, and behind the last one.
    fn ends(&self, (real, complex): &(Vec<f64>, Vec<Complex>), begin: f64, end: f64) -> f64 {
        let value = real.iter().sum::<f64>() + complex.iter().map(|weight| weight[0]).sum::<f64>();
        let (mut change, mut tail) = (0.0, 0.0);
        let mut add = |weight: f64, [least, most]: [f64; 2]| {
            change += weight * (most * begin + ROUNDING);
            tail += weight / least * (-least * end).exp();
        };
        real.iter().zip(&self.rates).for_each(|(weight, rate)| add(weight.abs(), [*rate; 2]));
        let poles = complex.iter().zip(self.poles);
        poles.for_each(|(weight, pole)| add(size(weight), [pole[0], size(pole)]));
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
    // Largest value over all x of the cell.
    let y = size(&x) * HALF.exp();
    let sixth = y * (1.0 + y * (31.0 + y * (90.0 + y * (65.0 + y * (15.0 + y)))));
    let rest = scale * HALF / 6.0 * sixth * (-x[0] * (-HALF).exp()).exp();
    (out, rest + ROUNDING * size(&decay))
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
    fn bounds_are_tight_across_sign_changes() {
        // e^{−t} − 3 e^{−2t}: zero at ln 3, ∫|f| = −F(0) + 2 F(ln 3), with F = −e^{−t} + 1.5 e^{−2t}.
        let antiderivative = |t: f64| -(-t).exp() + 1.5 * (-2.0 * t).exp();
        let exact = antiderivative(0.0) - 2.0 * antiderivative(3f64.ln());
        let found = integral_of(&[1.0, 2.0], &[1.0, -3.0], Wanted::Bound);
        assert!(found >= exact && found < 1.1 * exact, "{found} {exact}");
    }

    #[test]
    fn bounds_of_exponentials_match_their_integrals() {
        for rate in [1e-9, 1.0, 1e12] {
            let found = integral_of(&[rate], &[2.0], Wanted::Bound) * rate / 2.0;
            assert!((1.0..1.06).contains(&found), "{found}");
        }
        // Cancelling terms leave the remainders alone: δ⁶/6! ∫ (x⁶ + 15x⁵ + …) e^{−x} dx = 1.6e-9
        // of each integral, a third more for the cell's width.
        let found = integral_of(&[1.0, 1.0], &[1e3, -1e3], Wanted::Bound);
        assert!(found < 2.2e-9 * 2e3, "{found:e}");
    }

    #[test]
    fn bound_is_never_below_fine_quadrature() {
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

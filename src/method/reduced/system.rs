//! A reduced system: a few scalar equations `ẋ_r = −ν_r x_r + Σ_j b_rj u_j`, outputs
//! `y_k = Σ_r c_kr x_r + Σ_j d_kj u_j`. Where ν is one of a pair of complex poles, x is complex,
//! stored as its real and then its imaginary part.

use super::balanced::{Balanced, ReductionError, Truncated};
use super::certificate::{Wanted, integrals};
use super::clumped::{Clumped, Residues};
use crate::math::exponential;
use crate::math::separable::dot;

/// Rates, matrices by rows, and bounds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReducedSystem {
    pub inputs: usize,
    pub outputs: usize,
    /// Real part of ν of each unknown [1/s]; the first is that of the slowest mode, which is exact.
    pub rates: Vec<f64>,
    /// Imaginary part: zero, or that of both unknowns of a pair.
    pub turns: Vec<f64>,
    /// `b`: for each rate one value per input.
    pub entering: Vec<f64>,
    /// `c`: for each output one value per rate.
    pub leaving: Vec<f64>,
    /// `d`: for each output one value per input.
    pub direct: Vec<f64>,
    /// For each output and input the error bound of the output per unit of the input's largest
    /// magnitude.
    pub bounds: Vec<f64>,
    /// For each output and input the largest response to a unit step up to the horizon.
    pub ranges: Vec<f64>,
}

/// Inputs of a reduction: residues of all outputs, direct terms, and allowed errors.
pub struct Request<'a> {
    pub clumped: &'a Clumped,
    /// Residues of each output.
    pub residues: &'a [Residues],
    /// For each output its coefficient of the slowest mode.
    pub slow: &'a [f64],
    /// For each output one direct term per input.
    pub direct: &'a [Vec<f64>],
    /// Horizon of the step responses [s].
    pub horizon: f64,
    /// Inputs of the default experiment.
    pub start: &'a [f64],
    /// For each output and input the error of the inputs' own representation: part of the bound,
    /// but independent of the order.
    pub missed: &'a [Vec<f64>],
    /// Returns for each output and input the allowed error, given the step responses.
    pub allowed: &'a dyn Fn(&Ranges) -> Vec<Vec<f64>>,
}

/// Largest step responses up to the horizon.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ranges {
    /// Responses of each output to a unit step of each input.
    pub single: Vec<Vec<f64>>,
    /// Responses of each output to the inputs of the default experiment.
    pub together: Vec<f64>,
}

/// Number of times at which step responses are evaluated, over a horizon.
const LOOKS: usize = 120;
/// First of these times over the horizon.
const FIRST_LOOK: f64 = 1e-9;

impl ReducedSystem {
    /// Finds the smallest system whose bounds are within the allowed errors, or else the one with
    /// the smallest excess. Also returns the evaluated ranges.
    pub fn new(request: &Request) -> Result<(Self, Ranges), ReductionError> {
        let Request { clumped, residues, .. } = request;
        let ranges = request.ranges();
        let allowed = (request.allowed)(&ranges);
        // Singular values then count inputs and outputs in fractions of the allowed errors.
        let scale = scales(&allowed, clumped.slow_inputs().len());
        let scaled = request.scaled(&scale);
        let rows: Vec<Vec<&[f64]>> =
            scaled.iter().map(|row| row.iter().map(Vec::as_slice).collect()).collect();
        let balanced = Balanced::new(&clumped.points, &rows)?;
        let judge = |truncated: &Truncated, wanted: Wanted| {
            let found = integrals(&clumped.points, &rows, truncated, wanted);
            let parts = found.iter().zip(residues.iter().zip(&allowed).zip(&scale.0));
            let excess = parts.map(|(found, ((residues, allowed), output))| {
                let own = found.iter().zip(&residues.error).zip(allowed.iter().zip(&scale.1));
                own.map(|((found, error), (allowed, input))| {
                    (found / (output * input) + error) / allowed
                })
                .fold(0.0, f64::max)
            });
            (excess.fold(0.0, f64::max), found)
        };
        let hopeless = 2.0 * ((rows.len() * scale.1.len()) as f64).sqrt();
        let (truncated, found) =
            smallest(&balanced, hopeless, judge).ok_or(ReductionError::Decomposition)?;
        Ok((request.system(&truncated, &scale, &found, &ranges), ranges))
    }

    pub fn order(&self) -> usize {
        self.rates.len()
    }

    /// Advances `x` by `dt` [s] under inputs that are polynomials in time: their values at the beginning, then their
    /// derivatives.
    pub fn advance(&self, x: &mut [f64], inputs: &[&[f64]], dt: f64) {
        let mut i = 0;
        while i < self.order() {
            let nu = [self.rates[i], self.turns[i]];
            if nu[1] == 0.0 {
                let weights = exponential::weights(nu[0] * dt);
                let (mut end, mut power) = (weights[0] * x[i], dt);
                for (k, input) in inputs.iter().enumerate() {
                    end += weights[k + 1] * power * self.driven(i, input);
                    power *= dt;
                }
                x[i] = end;
                i += 1;
                continue;
            }
            let weights = exponential::complex_weights(nu.map(|part| part * dt));
            let (mut end, mut power) = (times(weights[0], [x[i], x[i + 1]]), dt);
            for (k, input) in inputs.iter().enumerate() {
                let source = [self.driven(i, input), self.driven(i + 1, input)];
                let part = times(weights[k + 1], source);
                end = [end[0] + power * part[0], end[1] + power * part[1]];
                power *= dt;
            }
            x[i..i + 2].copy_from_slice(&end);
            i += 2;
        }
    }

    /// Sum of the inputs that drive an unknown.
    fn driven(&self, unknown: usize, inputs: &[f64]) -> f64 {
        dot(&self.entering[unknown * self.inputs..][..self.inputs], inputs)
    }

    /// `ẋ` under inputs.
    pub fn rates_of(&self, x: &[f64], inputs: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> =
            (0..self.order()).map(|i| self.driven(i, inputs) - self.rates[i] * x[i]).collect();
        let mut i = 0;
        while i < self.order() {
            if self.turns[i] == 0.0 {
                i += 1;
                continue;
            }
            out[i] += self.turns[i] * x[i + 1];
            out[i + 1] -= self.turns[i] * x[i];
            i += 2;
        }
        out
    }

    /// Value of an output.
    pub fn output(&self, x: &[f64], inputs: &[f64], place: usize) -> f64 {
        self.from_unknowns(x, place) + self.at_once(inputs, place)
    }

    /// Contribution of the unknowns to an output.
    pub fn from_unknowns(&self, x: &[f64], place: usize) -> f64 {
        let order = self.order();
        dot(&self.leaving[place * order..][..order], x)
    }

    /// Direct contribution of the inputs to an output.
    pub fn at_once(&self, inputs: &[f64], place: usize) -> f64 {
        dot(&self.direct[place * self.inputs..][..self.inputs], inputs)
    }

    /// Bounds on the unknowns for inputs that never exceeded these magnitudes.
    pub fn reach(&self, sizes: &[f64]) -> Vec<f64> {
        let driven = |i: usize| {
            let row = &self.entering[i * self.inputs..][..self.inputs];
            row.iter().zip(sizes).map(|(b, size)| (b * size).abs()).sum::<f64>()
        };
        let mut out = Vec::with_capacity(self.order());
        while out.len() < self.order() {
            let i = out.len();
            let is_pair = self.turns[i] != 0.0;
            let all = if is_pair { driven(i) + driven(i + 1) } else { driven(i) };
            let bound = match all {
                0.0 => 0.0,
                _ if self.rates[i] > 0.0 => all / self.rates[i],
                _ => f64::INFINITY,
            };
            out.resize(i + if is_pair { 2 } else { 1 }, bound);
        }
        out
    }

    /// Error bound of an output for inputs that never exceeded these magnitudes.
    pub fn bound(&self, sizes: &[f64], place: usize) -> f64 {
        dot(&self.bounds[place * self.inputs..][..self.inputs], sizes)
    }
}

/// Number of unknowns of a pole.
fn parts_of(turn: f64) -> usize {
    if turn == 0.0 { 1 } else { 2 }
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Request<'_> {
    fn ranges(&self) -> Ranges {
        let times: Vec<f64> = (0..LOOKS)
            .map(|i| self.horizon * FIRST_LOOK.powf(1.0 - (i + 1) as f64 / LOOKS as f64))
            .collect();
        let grown = |rate: f64, t: f64| t * exponential::weights(rate * t)[1];
        let points: Vec<Vec<f64>> = times
            .iter()
            .map(|&t| self.clumped.points.iter().map(|&rate| grown(rate, t)).collect())
            .collect();
        let slow: Vec<f64> = times.iter().map(|&t| grown(self.clumped.slow_rate(), t)).collect();
        let answers = |(residues, direct): (&Residues, &Vec<f64>), j: usize| {
            let at = |(points, slow): (&Vec<f64>, &f64)| {
                dot(points, &residues.values[j]) + slow * residues.slow[j] + direct[j]
            };
            std::iter::once(direct[j]).chain(points.iter().zip(&slow).map(at)).collect::<Vec<f64>>()
        };
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut ranges = Ranges::default();
        for output in self.residues.iter().zip(self.direct) {
            let mut sum = vec![0.0; LOOKS + 1];
            let mut single = Vec::new();
            for (j, start) in self.start.iter().enumerate() {
                let answers = answers(output, j);
                sum.iter_mut().zip(&answers).for_each(|(sum, value)| *sum += start * value);
                single.push(largest(&answers));
            }
            ranges.single.push(single);
            ranges.together.push(largest(&sum));
        }
        ranges
    }

    fn scaled(&self, (outputs, inputs): &(Vec<f64>, Vec<f64>)) -> Vec<Vec<Vec<f64>>> {
        let of_output = |(residues, output): (&Residues, &f64)| {
            let of_input = |(values, input): (&Vec<f64>, &f64)| {
                values.iter().map(|value| value * output * input).collect()
            };
            residues.values.iter().zip(inputs).map(of_input).collect()
        };
        self.residues.iter().zip(outputs).map(of_output).collect()
    }

    fn system(
        &self,
        truncated: &Truncated,
        (outputs, inputs): &(Vec<f64>, Vec<f64>),
        found: &[Vec<f64>],
        ranges: &Ranges,
    ) -> ReducedSystem {
        let slow = self.clumped.slow_inputs();
        let mut system = ReducedSystem {
            inputs: inputs.len(),
            outputs: outputs.len(),
            rates: vec![self.clumped.slow_rate()],
            turns: vec![0.0],
            ..ReducedSystem::default()
        };
        system.entering.extend(&slow);
        for (r, &[rate, turn]) in truncated.poles.iter().enumerate() {
            for part in 0..parts_of(turn) {
                system.rates.push(rate);
                system.turns.push(turn);
                let entering = truncated.inputs.iter().zip(inputs);
                system.entering.extend(entering.map(|(b, s)| b[r][part] / s));
            }
        }
        for (k, output) in outputs.iter().enumerate() {
            system.leaving.push(self.slow[k]);
            for (r, pole) in truncated.poles.iter().enumerate() {
                let [real, imaginary] = truncated.outputs[k][r];
                let parts = [real, -imaginary];
                system.leaving.extend(parts[..parts_of(pole[1])].iter().map(|c| c / output));
            }
            system.direct.extend(&self.direct[k]);
            system.ranges.extend(&ranges.single[k]);
            let pairs = found[k].iter().zip(&self.residues[k].error).zip(inputs);
            let bounds = pairs.map(|((found, error), s)| found / (output * s) + error);
            system.bounds.extend(bounds.zip(&self.missed[k]).map(|(bound, missed)| bound + missed));
        }
        system
    }
}

/// Integrals of the neglected impulse responses, output by output and input by input.
type Integrals = Vec<Vec<f64>>;

/// Finds the truncated system of the smallest order whose bounds are within the allowed errors,
/// between the orders whose singular values exceed `hopeless` and the highest. If none is, returns
/// the tried one with the smallest excess.
///
/// Errors fall with the order except for rounding, so the order is found by bisection, first on
/// estimates; the bound then may require a few more unknowns. `judge` returns the excess of a
/// system over the allowed errors, and the integrals behind it; the bounding ones are returned with
/// the system.
fn smallest(
    balanced: &Balanced,
    hopeless: f64,
    judge: impl Fn(&Truncated, Wanted) -> (f64, Integrals),
) -> Option<(Truncated, Integrals)> {
    let most = balanced.most();
    let mut best: Option<(f64, Truncated, Option<Integrals>)> = None;
    let mut keeps = |order: usize, wanted: Wanted| {
        let Some(truncated) = balanced.truncated(order) else { return false };
        let (excess, found) = judge(&truncated, wanted);
        // An estimate within the allowed errors does not yet imply such a bound.
        let kept = excess <= 1.0;
        let counts = !kept || wanted == Wanted::Bound;
        if counts && best.as_ref().is_none_or(|(least, ..)| excess < *least) {
            best = Some((excess, truncated, (wanted == Wanted::Bound).then_some(found)));
        }
        kept
    };
    // The total error is at least the first neglected singular value.
    let first = balanced.singular.iter().take_while(|&&value| value > hopeless).count().min(most);
    let [mut low, mut high] = [first, most];
    while low < high {
        let middle = low + (high - low) / 2;
        if keeps(middle, Wanted::Estimate) { high = middle } else { low = middle + 1 }
    }
    let _ = (low..=most).any(|order| keeps(order, Wanted::Bound));
    best.map(|(_, truncated, found)| {
        let found = found.unwrap_or_else(|| judge(&truncated, Wanted::Bound).1);
        (truncated, found)
    })
}

/// Factors of outputs and inputs that normalise the allowed errors to about one:
/// `s_k t_j a_kj ≤ 1`, close to it where possible.
fn scales(allowed: &[Vec<f64>], inputs: usize) -> (Vec<f64>, Vec<f64>) {
    // For each input the smallest allowed error; then for each output.
    let is_some = |value: &f64| *value > 0.0 && value.is_finite();
    let least = |values: &mut dyn Iterator<Item = f64>| {
        let least = values.filter(is_some).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 1.0 }
    };
    let rows: Vec<f64> = allowed.iter().map(|row| least(&mut row.iter().copied())).collect();
    let column = |j: usize| {
        let mut parts = allowed.iter().zip(&rows).map(|(row, least)| row[j] / least);
        least(&mut parts)
    };
    let columns: Vec<f64> = (0..inputs).map(|j| 1.0 / column(j)).collect();
    (rows.into_iter().map(|least| 1.0 / least).collect(), columns)
}

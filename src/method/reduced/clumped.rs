//! Many modes clumped into few rates.
//!
//! The impulse response of a diagonal system is `h(t) = Σ_i c_i b_i e^{−λ_i t}`. Over a panel
//! `λ ∈ [a, 4a]` the function `e^{−λt}` of `ln λ` is interpolated at Chebyshev points μ_q. This
//! turns the sum into `Σ_q R_q e^{−μ_q t}` with `R_q = Σ_i ℓ_q(λ_i) c_i b_i`: some hundred rates
//! for any number of modes. The integral over time of the error of one exponential is at most
//! [`ERROR`]` / λ`, for every λ. The slowest mode, which may conserve heat for ever, is kept
//! exactly.

use std::f64::consts::PI;

/// Ratio of the rates at the ends of a panel, and points in each.
const RATIO: f64 = 4.0;
const POINTS: usize = 16;
/// Upper bound of `λ ∫₀^∞ |e^{−λt} − Σ ℓ_q(λ) e^{−μ_q t}| dt`.
pub const ERROR: f64 = 2e-10;
/// Rounding error of sums of very many terms, over the sum of their sizes.
const ROUNDING: f64 = 1e-13;

/// The modes and inputs of a system, ready for rows of outputs.
pub struct Clumped {
    modes: usize,
    /// `B`: for each input one value per mode.
    inputs: Vec<Vec<f64>>,
    /// Rates of the modes.
    rates: Vec<f64>,
    slowest: usize,
    /// First point of each mode's panel, and its weights there; empty for the slowest mode.
    first: Vec<usize>,
    weights: Vec<[f64; POINTS]>,
    /// Rates of the points [1/s].
    pub points: Vec<f64>,
}

/// Impulse responses of an output to the inputs: sums of exponentials.
#[derive(Debug, Clone, PartialEq)]
pub struct Residues {
    /// For each input the residue of the slowest mode.
    pub slow: Vec<f64>,
    /// For each input the residues at the points.
    pub values: Vec<Vec<f64>>,
    /// For each input a bound of the integral over time of the neglected part.
    pub error: Vec<f64>,
}

impl Clumped {
    /// Clumps modes with these rates of decay [1/s], at least one, and with these input rows.
    pub fn new(rates: Vec<f64>, inputs: Vec<Vec<f64>>) -> Self {
        let modes = rates.len();
        let slowest = (0..modes).min_by(|&a, &b| rates[a].total_cmp(&rates[b])).unwrap_or(0);
        let others = || rates.iter().enumerate().filter(|(i, _)| *i != slowest);
        let least = others().fold(f64::INFINITY, |least, (_, &rate)| least.min(rate));
        let panel = |rate: f64| ((rate / least).ln() / RATIO.ln()).floor().max(0.0);
        let mut place_of = std::collections::BTreeMap::new();
        for (_, &rate) in others() {
            place_of.insert(panel(rate) as usize, 0);
        }
        let nodes = chebyshev();
        let mut points = Vec::new();
        for (&number, place) in &mut place_of {
            *place = points.len();
            let middle = least * RATIO.powf(number as f64 + 0.5);
            points.extend(nodes.map(|node| middle * (0.5 * RATIO.ln() * node).exp()));
        }
        let (mut first, mut weights) = (vec![0; modes], vec![[0.0; POINTS]; modes]);
        for (i, &rate) in others() {
            let number = panel(rate);
            let place = (rate / least).ln() / RATIO.ln() - number;
            first[i] = place_of[&(number as usize)];
            weights[i] = lagrange(&nodes, (2.0 * place - 1.0).clamp(-1.0, 1.0));
        }
        Self { modes, inputs, rates, slowest, first, weights, points }
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Rate of the slowest mode [1/s]; for one that conserves heat, rounding leaves it slightly off
    /// zero.
    pub fn slow_rate(&self) -> f64 {
        self.rates[self.slowest].max(0.0)
    }

    /// `B` of the slowest mode.
    pub fn slow_inputs(&self) -> Vec<f64> {
        self.inputs.iter().map(|column| column[self.slowest]).collect()
    }

    /// `C` of the slowest mode, from an output's row.
    pub fn slow_output(&self, row: &[f64]) -> f64 {
        row[self.slowest]
    }

    /// Impulse responses of the output with a row of `C`.
    pub fn residues(&self, row: &[f64]) -> Residues {
        assert_eq!(row.len(), self.modes(), "a row has an entry for each mode");
        let of_input = |column: &Vec<f64>| {
            let (mut values, mut sizes) = (vec![0.0; self.points.len()], 0.0);
            for i in (0..self.modes).filter(|&i| i != self.slowest) {
                let product = row[i] * column[i];
                if product == 0.0 {
                    continue;
                }
                sizes += product.abs() / self.rates[i];
                let target = &mut values[self.first[i]..][..POINTS];
                target.iter_mut().zip(&self.weights[i]).for_each(|(v, w)| *v += product * w);
            }
            (values, (ERROR + ROUNDING) * sizes)
        };
        let (values, error) = self.inputs.iter().map(of_input).unzip();
        let slow = self.inputs.iter().map(|column| row[self.slowest] * column[self.slowest]);
        Residues { slow: slow.collect(), values, error }
    }
}

fn angle(point: usize) -> f64 {
    PI * (point as f64 + 0.5) / POINTS as f64
}

/// Chebyshev points of the first kind on [−1, 1].
fn chebyshev() -> [f64; POINTS] {
    std::array::from_fn(|point| -angle(point).cos())
}

/// Values at a place of the Lagrange polynomials, by the barycentric formula (J.-P. Berrut and L.
/// N. Trefethen 2004, doi 10.1137/S0036144502417715).
fn lagrange(nodes: &[f64; POINTS], place: f64) -> [f64; POINTS] {
    if let Some(at) = nodes.iter().position(|&node| node == place) {
        return std::array::from_fn(|point| if point == at { 1.0 } else { 0.0 });
    }
    let part = |point: usize| {
        let sign = if point.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * angle(point).sin() / (place - nodes[point])
    };
    let parts: [f64; POINTS] = std::array::from_fn(part);
    let sum: f64 = parts.iter().sum();
    parts.map(|part| part / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_of_any_rate_stay_within_the_error_bound() {
        // λ ∫ |…| dt, by the trapezoidal rule over ln t on a fine grid.
        let mut worst: f64 = 0.0;
        for place in 0..=60 {
            let rate = 4f64.powf(f64::from(place) / 60.0);
            // A second slow mode makes the panel begin at 1.
            let clumped = Clumped::new(vec![0.0, 1.0, rate], vec![vec![0.0, 0.0, 1.0]]);
            let residues = &clumped.residues(&[0.0, 0.0, 1.0]).values[0];
            let (steps, from, to) = (3000, (1e-9_f64).ln(), (60.0_f64).ln());
            let ds = (to - from) / f64::from(steps);
            let error = |t: f64| {
                let parts = residues.iter().zip(&clumped.points);
                parts.map(|(r, mu)| r * (-mu * t).exp()).sum::<f64>() - (-rate * t).exp()
            };
            let integral: f64 = (0..=steps)
                .map(|i| (from + f64::from(i) * ds).exp())
                .map(|t| t * ds * error(t).abs())
                .sum();
            worst = worst.max(rate * integral);
        }
        assert!(worst < 0.7 * ERROR && worst > 0.05 * ERROR, "{worst:e}");
    }

    #[test]
    fn clumping_preserves_magnitudes() {
        let rates: Vec<f64> = (0..500).map(|i| 0.3 * 1.05f64.powi(i)).collect();
        let column: Vec<f64> = (0..500).map(|i| (f64::from(i)).sin()).collect();
        let row: Vec<f64> = (0..500).map(|i| (0.7 * f64::from(i)).cos()).collect();
        let clumped = Clumped::new(rates.clone(), vec![column.clone()]);
        let found = clumped.residues(&row);
        for t in [0.0, 1e-9, 1e-4, 0.3, 2.0] {
            let exact: f64 = (0..500).map(|i| row[i] * column[i] * (-rates[i] * t).exp()).sum();
            let points = clumped.points.iter().zip(&found.values[0]);
            let sum: f64 = points.map(|(mu, r)| r * (-mu * t).exp()).sum();
            let slow = found.slow[0] * (-clumped.slow_rate() * t).exp();
            assert!((sum + slow - exact).abs() < 1e-8, "{t}: {} {exact}", sum + slow);
        }
    }
}

//! Balanced truncation from residues.
//!
//! The Gramians of `ẋ = −M x + …` with rates μ_q are Cauchy matrices `1/(μ_q + μ_s)`, whose Cholesky factor `L` with
//! pivots has a closed form: `L_{qp} = g_q √(2 μ_p)/(μ_q + μ_p)` with `g_q ← g_q (μ_q − μ_p)/(μ_q + μ_p)` after each
//! pivot p, to full relative accuracy. With residues `R_q` between inputs and outputs the products of the Gramians'
//! roots are the blocks `Lᵀ diag(R) L`: their singular values are those of Hankel, and the truncated system follows (B.
//! C. Moore 1981, doi 10.1109/TAC.1981.1102568; A. J. Laub, M. T. Heath, C. C. Paige and R. C. Ward 1987, doi
//! 10.1109/TAC.1987.1104549).
//!
//! Such systems are stable. Their poles are real or, with several inputs and outputs, some of them pairs.

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

use crate::math::singular_values::{SingularValues, singular_values};

/// Fraction of a Gramian that its low-rank factor omits.
const LEFT_OUT: f64 = 1e-26;

/// Reasons why there is no reduced system.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    #[error("its singular values could not be found")]
    Decomposition,
}

/// A balanced system, from which systems of any order follow.
pub struct Balanced {
    inputs: usize,
    outputs: usize,
    /// Hankel singular values, descending.
    pub singular: Vec<f64>,
    /// `Lᵀ diag(M R) L` in blocks, `Lᵀ R` and `R L`, between the singular vectors over the roots of
    /// their values; the leading part of these is the system of an order.
    matrix: Mat<f64>,
    entering: Mat<f64>,
    leaving: Mat<f64>,
}

/// A complex number.
pub type Complex = [f64; 2];

/// A diagonal system with the impulse response `Σ Re(c b e^{−ν t})`: poles ν [1/s], of each pair
/// the one with the positive imaginary part, `B` by inputs, `C` by outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Truncated {
    pub poles: Vec<Complex>,
    pub inputs: Vec<Vec<Complex>>,
    pub outputs: Vec<Vec<Complex>>,
}

impl Balanced {
    /// Balances a system with these rates and, for each output and input, residues there.
    pub fn new(rates: &[f64], residues: &[Vec<&[f64]>]) -> Result<Self, ReductionError> {
        let factor = cauchy_factor(rates);
        let rank = factor.len();
        let (outputs, inputs) = (residues.len(), residues.first().map_or(0, Vec::len));
        let mut hankel = Mat::zeros(outputs * rank, inputs * rank);
        let mut shifted = Mat::zeros(outputs * rank, inputs * rank);
        let mut entering = Mat::zeros(outputs * rank, inputs);
        let mut leaving = Mat::zeros(outputs, inputs * rank);
        for (k, row) in residues.iter().enumerate() {
            for (j, values) in row.iter().enumerate() {
                for a in 0..rank {
                    let scaled: Vec<f64> =
                        factor[a].iter().zip(*values).map(|(l, r)| l * r).collect();
                    let sum: f64 = scaled.iter().sum();
                    entering[(k * rank + a, j)] = sum;
                    leaving[(k, j * rank + a)] = sum;
                    for (b, column) in factor[..=a].iter().enumerate() {
                        let (mut plain, mut weighted) = (0.0, 0.0);
                        for ((l, s), mu) in column.iter().zip(&scaled).zip(rates) {
                            plain += l * s;
                            weighted += l * s * mu;
                        }
                        for (row, column) in [(a, b), (b, a)] {
                            hankel[(k * rank + row, j * rank + column)] = plain;
                            shifted[(k * rank + row, j * rank + column)] = weighted;
                        }
                    }
                }
            }
        }
        let SingularValues { left, values: singular, right } =
            singular_values(&hankel).ok_or(ReductionError::Decomposition)?;
        let most = above_rounding(&singular);
        let scaled = |vectors: &Mat<f64>| {
            Mat::from_fn(vectors.nrows(), most, |i, r| vectors[(i, r)] / singular[r].sqrt())
        };
        let (left, right) = (scaled(&left), scaled(&right));
        let matrix = left.transpose() * (&shifted * &right);
        let entering = left.transpose() * &entering;
        let leaving = &leaving * &right;
        Ok(Self { inputs, outputs, singular, matrix, entering, leaving })
    }

    /// Highest order for which singular values exceed rounding.
    pub fn most(&self) -> usize {
        above_rounding(&self.singular)
    }

    /// The system of an order; `None` where rounding makes it unstable.
    pub fn truncated(&self, order: usize) -> Option<Truncated> {
        if order == 0 {
            return Some(Truncated {
                poles: Vec::new(),
                inputs: vec![Vec::new(); self.inputs],
                outputs: vec![Vec::new(); self.outputs],
            });
        }
        let matrix = self.matrix.submatrix(0, 0, order, order).to_owned();
        let entering = self.entering.subrows(0, order).to_owned();
        let leaving = self.leaving.subcols(0, order).to_owned();
        let modes = matrix.eigen().ok()?;
        let values = modes.S().column_vector();
        if !(0..order).all(|i| values[i].re > 0.0 && values[i].re.is_finite()) {
            return None;
        }
        let complex = |real: &Mat<f64>| {
            Mat::from_fn(real.nrows(), real.ncols(), |i, j| c64::new(real[(i, j)], 0.0))
        };
        let vectors = modes.U().to_owned();
        let entering = Solve::solve(&vectors.full_piv_lu(), complex(&entering));
        let leaving = complex(&leaving) * vectors;
        let mut places: Vec<usize> = (0..order).filter(|&i| values[i].im >= 0.0).collect();
        places.sort_by(|&a, &b| values[a].re.total_cmp(&values[b].re));
        // Real values are real to the bit; the other of a pair contributes the same real part.
        let pick = |i: usize, value: c64, factor: f64| match values[i].im > 0.0 {
            true => [factor * value.re, factor * value.im],
            false => [value.re, 0.0],
        };
        let of_input =
            |j: usize| places.iter().map(|&i| pick(i, entering[(i, j)], 1.0)).collect::<Vec<_>>();
        let of_output =
            |k: usize| places.iter().map(|&i| pick(i, leaving[(k, i)], 2.0)).collect::<Vec<_>>();
        let found = Truncated {
            poles: places.iter().map(|&i| [values[i].re, values[i].im]).collect(),
            inputs: (0..self.inputs).map(of_input).collect(),
            outputs: (0..self.outputs).map(of_output).collect(),
        };
        let all = found.inputs.iter().chain(&found.outputs).flatten().flatten();
        let unknowns: usize =
            found.poles.iter().map(|pole| if pole[1] > 0.0 { 2 } else { 1 }).sum();
        (unknowns == order && all.copied().all(f64::is_finite)).then_some(found)
    }
}

/// Number of singular values above rounding.
fn above_rounding(singular: &[f64]) -> usize {
    let largest = singular.first().copied().unwrap_or(0.0);
    singular.iter().filter(|&&value| value > 1e-13 * largest).count()
}

/// Columns of the factor of a Cauchy matrix.
fn cauchy_factor(rates: &[f64]) -> Vec<Vec<f64>> {
    let mut generator = vec![1.0_f64; rates.len()];
    let mut columns = Vec::new();
    while columns.len() < rates.len() {
        let largest = |&a: &usize, &b: &usize| generator[a].abs().total_cmp(&generator[b].abs());
        let Some(pivot) = (0..rates.len()).max_by(largest) else { break };
        if generator[pivot].powi(2) < LEFT_OUT {
            break;
        }
        let at = rates[pivot];
        let column = |(g, rate): (&f64, &f64)| g * (2.0 * at).sqrt() / (rate + at);
        columns.push(generator.iter().zip(rates).map(column).collect());
        let next = |(g, rate): (&mut f64, &f64)| *g *= (rate - at) / (rate + at);
        generator.iter_mut().zip(rates).for_each(next);
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_reproduces_the_cauchy_matrix() {
        let rates: Vec<f64> = (0..80).map(|i| 1.5f64.powi(i)).collect();
        let factor = cauchy_factor(&rates);
        for i in 0..80 {
            for j in 0..80 {
                let product: f64 = factor.iter().map(|column| column[i] * column[j]).sum();
                assert!((product * (rates[i] + rates[j]) - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn three_pole_system_is_recovered() {
        // Residues at many rates, all but three of them zero.
        let rates: Vec<f64> = (0..30).map(|i| 2f64.powi(i - 5)).collect();
        let mut values = vec![0.0; 30];
        for (at, value) in [(3, 2.0), (11, -0.7), (20, 30.0)] {
            values[at] = value;
        }
        let balanced = Balanced::new(&rates, &[vec![&values]]).unwrap();
        assert!(balanced.singular[3..].iter().all(|value| *value < 1e-12 * balanced.singular[0]));
        let found = balanced.truncated(3).unwrap();
        for (i, at) in [3, 11, 20].into_iter().enumerate() {
            assert!((found.poles[i][0] / rates[at] - 1.0).abs() < 1e-9);
            let residue = found.inputs[0][i][0] * found.outputs[0][i][0];
            assert!((residue / values[at] - 1.0).abs() < 1e-8, "{residue} {}", values[at]);
        }
    }

    #[test]
    fn truncation_error_is_within_glovers_bound() {
        // At frequency zero and at some others: K. Glover 1984, doi 10.1080/00207178408933239.
        let rates: Vec<f64> = (0..60).map(|i| 0.1 * 1.4f64.powi(i)).collect();
        let values: Vec<f64> = rates.iter().map(|rate| rate.powf(0.4)).collect();
        let balanced = Balanced::new(&rates, &[vec![&values]]).unwrap();
        for order in [2, 5, 9] {
            let system = balanced.truncated(order).unwrap();
            let rest = 2.0 * balanced.singular[order..].iter().sum::<f64>();
            for s in [0.0, 0.3, 10.0, 1e4] {
                let full: f64 = values.iter().zip(&rates).map(|(r, mu)| r / (s + mu)).sum();
                let parts = system.inputs[0].iter().zip(&system.outputs[0]).zip(&system.poles);
                let reduced: f64 = parts.map(|((b, c), pole)| b[0] * c[0] / (s + pole[0])).sum();
                assert!((full - reduced).abs() <= rest * (1.0 + 1e-9), "{order} {s}");
            }
        }
    }
}

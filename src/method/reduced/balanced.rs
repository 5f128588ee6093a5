//! Balanced truncation from residues.
//!
//! The Gramians of `ẋ = −M x + …` with rates μ_q are Cauchy matrices `1/(μ_q + μ_s)`, whose Cholesky factor `L` with
//! pivots has a closed form: `L_{qp} = g_q √(2 μ_p)/(μ_q + μ_p)` with `g_q ← g_q (μ_q − μ_p)/(μ_q + μ_p)` after each
//! pivot p, to full relative accuracy. With residues `R_q` between inputs and outputs the products of the Gramians' roots
//! are the blocks `Lᵀ diag(R) L`: their singular values are those of Hankel, and the truncated system follows (B. C. Moore
//! 1981, doi 10.1109/TAC.1981.1102568; A. J. Laub, M. T. Heath, C. C. Paige and R. C. Ward 1987, doi
//! 10.1109/TAC.1987.1104549).
//!
//! Such systems are stable, and where their poles are real they become diagonal again. With several inputs and outputs some
//! orders have pairs of complex poles. There the system is projected on the space that left and right vectors of half the
//! order span together: symmetric as `M` is, its poles are real and positive whatever the space, and so are those of
//! every order for which it is asked.

use faer::Mat;

use crate::math::eigenvectors::eigenvectors;
use crate::math::singular_values::{SingularValues, singular_values};

/// Part of a Gramian that its low-rank factor leaves out.
const LEFT_OUT: f64 = 1e-26;
/// Singular values below this part of the largest tell that vectors depend on each other.
const DEPENDENT: f64 = 1e-11;

/// Why there is no reduced system.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    #[error("its singular values could not be found")]
    Decomposition,
}

/// A system balanced: what systems of any order follow from.
pub struct Balanced {
    inputs: usize,
    outputs: usize,
    rank: usize,
    /// Hankel singular values, descending.
    pub singular: Vec<f64>,
    left: Mat<f64>,
    right: Mat<f64>,
    /// `Lᵀ diag(M R) L` in blocks, `Lᵀ R` and `R L`.
    shifted: Mat<f64>,
    entering: Mat<f64>,
    leaving: Mat<f64>,
    rates: Vec<f64>,
    factor: Vec<Vec<f64>>,
    /// Of each output and input.
    residues: Vec<Vec<Vec<f64>>>,
}

/// A diagonal system: rates [1/s], `B` by inputs, `C` by outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Truncated {
    pub rates: Vec<f64>,
    pub inputs: Vec<Vec<f64>>,
    pub outputs: Vec<Vec<f64>>,
}

impl Balanced {
    /// Of a system with these rates and, for each output and input, residues there.
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
                    for b in 0..=a {
                        let (mut plain, mut weighted) = (0.0, 0.0);
                        for ((l, s), mu) in factor[b].iter().zip(&scaled).zip(rates) {
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
        let own = |row: &Vec<&[f64]>| row.iter().map(|values| values.to_vec()).collect();
        Ok(Self {
            inputs,
            outputs,
            rank,
            singular,
            left,
            right,
            shifted,
            entering,
            leaving,
            rates: rates.to_vec(),
            factor,
            residues: residues.iter().map(own).collect(),
        })
    }

    /// Highest order that singular values above rounding allow.
    pub fn most(&self) -> usize {
        let largest = self.singular.first().copied().unwrap_or(0.0);
        self.singular.iter().filter(|&&value| value > 1e-13 * largest).count()
    }

    /// The system of an order at most, by whatever way makes its poles real.
    pub fn truncated(&self, order: usize) -> Truncated {
        self.two_sided(order).unwrap_or_else(|| self.projected(order.div_ceil(2)))
    }

    /// The system of an order; nothing where its poles are not all real and stable.
    fn two_sided(&self, order: usize) -> Option<Truncated> {
        let root = |i: usize| self.singular[i].sqrt();
        let left =
            Mat::from_fn(self.outputs * self.rank, order, |i, r| self.left[(i, r)] / root(r));
        let right =
            Mat::from_fn(self.inputs * self.rank, order, |i, r| self.right[(i, r)] / root(r));
        let matrix = left.transpose() * (&self.shifted * &right);
        let entering = left.transpose() * &self.entering;
        let leaving = &self.leaving * &right;
        if order == 0 {
            return Some(Truncated::none(self.inputs, self.outputs));
        }
        let modes = matrix.eigen().ok()?;
        let values = modes.S().column_vector();
        let is_fine =
            |i: usize| values[i].re > 0.0 && values[i].im == 0.0 && values[i].re.is_finite();
        if !(0..order).all(is_fine) {
            return None;
        }
        let vectors = Mat::from_fn(order, order, |i, k| modes.U()[(i, k)].re);
        let inverse = faer::linalg::solvers::Solve::solve(
            &vectors.full_piv_lu(),
            Mat::<f64>::identity(order, order),
        );
        let (entering, leaving) = (inverse * entering, leaving * vectors);
        let all = entering.col_iter().chain(leaving.col_iter());
        if !all.flat_map(|column| column.iter().copied()).all(f64::is_finite) {
            return None;
        }
        let mut places: Vec<usize> = (0..order).collect();
        places.sort_by(|&a, &b| values[a].re.total_cmp(&values[b].re));
        let of_input = |j: usize| places.iter().map(|&i| entering[(i, j)]).collect();
        let of_output = |k: usize| places.iter().map(|&i| leaving[(k, i)]).collect();
        Some(Truncated {
            rates: places.iter().map(|&i| values[i].re).collect(),
            inputs: (0..self.inputs).map(of_input).collect(),
            outputs: (0..self.outputs).map(of_output).collect(),
        })
    }

    /// The system on the space that left and right vectors of an order span together.
    fn projected(&self, order: usize) -> Truncated {
        let points = self.rates.len();
        let along = |vectors: &Mat<f64>, block: usize, r: usize| -> Vec<f64> {
            let mut sum = vec![0.0; points];
            for (a, column) in self.factor.iter().enumerate() {
                let weight = vectors[(block * self.rank + a, r)];
                sum.iter_mut().zip(column).for_each(|(sum, l)| *sum += weight * l);
            }
            sum
        };
        let mut span = Mat::zeros(points * self.inputs, 2 * order);
        for r in 0..order {
            for j in 0..self.inputs {
                for (q, value) in along(&self.right, j, r).into_iter().enumerate() {
                    span[(j * points + q, 2 * r)] = value;
                }
            }
            for k in 0..self.outputs {
                for (q, value) in along(&self.left, k, r).into_iter().enumerate() {
                    for j in 0..self.inputs {
                        span[(j * points + q, 2 * r + 1)] += self.residues[k][j][q] * value;
                    }
                }
            }
        }
        for r in 0..2 * order {
            let length = span.col(r).iter().map(|value| value * value).sum::<f64>().sqrt();
            if length > 0.0 {
                span.col_mut(r).iter_mut().for_each(|value| *value /= length);
            }
        }
        let Some(SingularValues { left, values, .. }) = singular_values(&span) else {
            return Truncated::none(self.inputs, self.outputs);
        };
        let count = values.iter().filter(|&&value| value > DEPENDENT * values[0]).count();
        let place = |i: usize| self.rates[i % points];
        let matrix = Mat::from_fn(count, count, |a, b| {
            (0..points * self.inputs).map(|i| left[(i, a)] * place(i) * left[(i, b)]).sum()
        });
        let turn = eigenvectors(&matrix);
        let basis = left.subcols(0, count) * &turn;
        let rate = |r: usize| {
            (0..points * self.inputs).map(|i| place(i) * basis[(i, r)].powi(2)).sum::<f64>()
        };
        let input = |j: usize, r: usize| (0..points).map(|q| basis[(j * points + q, r)]).sum();
        let output = |k: usize, r: usize| {
            let of_input = |(j, values): (usize, &Vec<f64>)| {
                let parts = values.iter().enumerate();
                parts.map(|(q, value)| value * basis[(j * points + q, r)]).sum::<f64>()
            };
            self.residues[k].iter().enumerate().map(of_input).sum()
        };
        Truncated {
            rates: (0..count).map(rate).collect(),
            inputs: (0..self.inputs).map(|j| (0..count).map(|r| input(j, r)).collect()).collect(),
            outputs: (0..self.outputs)
                .map(|k| (0..count).map(|r| output(k, r)).collect())
                .collect(),
        }
    }
}

impl Truncated {
    /// Of no order.
    fn none(inputs: usize, outputs: usize) -> Self {
        Self {
            rates: Vec::new(),
            inputs: vec![Vec::new(); inputs],
            outputs: vec![Vec::new(); outputs],
        }
    }
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
    fn the_factor_is_that_of_the_cauchy_matrix() {
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
    fn a_system_of_three_poles_comes_back_from_sums_that_hide_it() {
        // Residues at many rates, of which all but three are zero.
        let rates: Vec<f64> = (0..30).map(|i| 2f64.powi(i - 5)).collect();
        let mut values = vec![0.0; 30];
        for (at, value) in [(3, 2.0), (11, -0.7), (20, 30.0)] {
            values[at] = value;
        }
        let balanced = Balanced::new(&rates, &[vec![&values]]).unwrap();
        assert!(balanced.singular[3] < 1e-12 * balanced.singular[0]);
        let found = balanced.two_sided(3).unwrap();
        for (i, at) in [3, 11, 20].into_iter().enumerate() {
            assert!((found.rates[i] / rates[at] - 1.0).abs() < 1e-9);
            let residue = found.inputs[0][i] * found.outputs[0][i];
            assert!((residue / values[at] - 1.0).abs() < 1e-8, "{residue} {}", values[at]);
        }
    }

    #[test]
    fn the_error_of_a_truncation_stays_below_twice_the_rest_of_singular_values() {
        // At frequency zero and at some others: K. Glover 1984, doi 10.1080/00207178408933239.
        let rates: Vec<f64> = (0..60).map(|i| 0.1 * 1.4f64.powi(i)).collect();
        let values: Vec<f64> = rates.iter().map(|rate| rate.powf(0.4)).collect();
        let balanced = Balanced::new(&rates, &[vec![&values]]).unwrap();
        for order in [2, 5, 9] {
            let system = balanced.truncated(order);
            let rest = 2.0 * balanced.singular[order..].iter().sum::<f64>();
            for s in [0.0, 0.3, 10.0, 1e4] {
                let full: f64 = values.iter().zip(&rates).map(|(r, mu)| r / (s + mu)).sum();
                let parts = system.inputs[0].iter().zip(&system.outputs[0]).zip(&system.rates);
                let reduced: f64 = parts.map(|((b, c), mu)| b * c / (s + mu)).sum();
                assert!((full - reduced).abs() <= rest * (1.0 + 1e-9), "{order} {s}");
            }
        }
    }
}

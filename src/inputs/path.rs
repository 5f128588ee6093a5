//! Inputs as polynomials in time over a step.

/// Highest time derivative of inputs that a step takes into account.
pub const HIGHEST_INPUT_DERIVATIVE: usize = 2;

/// Inputs over a step: `u(s) = u₀ + u₁ s + u₂ s²/2`.
#[derive(Debug, Clone, PartialEq)]
pub struct InputPath {
    /// `u₀`, `u₁`, … of all inputs.
    derivatives: Vec<Vec<f64>>,
}

impl InputPath {
    /// Creates the path through `inputs` with these derivatives; trailing zero derivatives are dropped.
    pub fn new(inputs: &[f64], derivatives: &[Vec<f64>]) -> Self {
        let last = derivatives.iter().rposition(|list| list.iter().any(|&v| v != 0.0));
        let higher = &derivatives[..last.map_or(0, |last| last + 1)];
        let first = std::iter::once(inputs.to_vec());
        Self { derivatives: first.chain(higher.iter().cloned()).collect() }
    }

    /// The path with other values at its beginning, and constant slopes, of some inputs.
    pub fn with(&self, changes: &[(usize, [f64; 2])]) -> Self {
        let mut derivatives = self.derivatives.clone();
        if derivatives.len() == 1 {
            derivatives.push(vec![0.0; derivatives[0].len()]);
        }
        for (place, numbers) in changes {
            for (order, list) in derivatives.iter_mut().enumerate() {
                list[*place] = numbers.get(order).copied().unwrap_or(0.0);
            }
        }
        Self { derivatives }
    }

    /// Value and slope of an input that goes evenly from a value to its own within a time [s]; `None` if derivatives
    /// move it.
    pub fn approach(&self, place: usize, from: f64, time: f64) -> Option<(usize, [f64; 2])> {
        let (start, higher) = self.derivatives.split_first()?;
        let is_held = higher.iter().all(|list| list[place] == 0.0);
        is_held.then(|| (place, [from, (start[place] - from) / time]))
    }

    pub fn is_held(&self) -> bool {
        self.derivatives.len() == 1
    }

    /// `u₀`.
    pub fn start(&self) -> &[f64] {
        &self.derivatives[0]
    }

    /// `u₀`, `u₁`, … of all inputs.
    pub fn derivatives(&self) -> &[Vec<f64>] {
        &self.derivatives
    }

    /// Derivatives of this order at `s` [s] into the step, the inputs themselves for 0.
    pub fn at(&self, order: usize, s: f64) -> Vec<f64> {
        let from = &self.derivatives[order.min(self.derivatives.len())..];
        let mut sum = from.first().cloned().unwrap_or_default();
        let mut weight = 1.0;
        for (k, list) in from.iter().enumerate().skip(1) {
            weight *= s / k as f64;
            for (value, derivative) in sum.iter_mut().zip(list) {
                *value += weight * derivative;
            }
        }
        sum
    }

    /// Sizes of the terms whose sums are the inputs at `s` [s] into the step.
    pub fn sizes(&self, s: f64) -> Vec<f64> {
        let size = |list: &Vec<f64>| list.iter().map(|value| value.abs()).collect();
        Self { derivatives: self.derivatives.iter().map(size).collect() }.at(0, s)
    }

    /// Remainder of the path from `s` [s] on.
    pub fn from(&self, s: f64) -> Self {
        Self { derivatives: (0..self.derivatives.len()).map(|order| self.at(order, s)).collect() }
    }

    /// Times in a step of length `dt` at which some input is at an extreme.
    pub fn turns(&self, dt: f64) -> Vec<f64> {
        let [_, slopes, bends] = &self.derivatives[..] else { return Vec::new() };
        let turn = |(slope, bend): (&f64, &f64)| -slope / bend;
        let times = slopes.iter().zip(bends).map(turn);
        let mut times: Vec<f64> = times.filter(|&s| s > 0.0 && s < dt).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_remainder_continues_the_path() {
        let path = InputPath::new(&[1.0, -2.0], &[vec![3.0, 0.5], vec![-4.0, 2.0]]);
        let rest = path.from(0.3);
        for s in [0.0, 0.2, 0.7] {
            let pairs = rest.at(0, s).into_iter().zip(path.at(0, 0.3 + s));
            pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-15));
        }
        assert_eq!(path.turns(1.0), [0.75]);
    }

    #[test]
    fn changed_inputs_have_constant_slopes() {
        for derivatives in [vec![], vec![vec![3.0, 0.5], vec![-4.0, 2.0]]] {
            let path = InputPath::new(&[1.0, -2.0], &derivatives);
            let changed = path.with(&[(1, [5.0, -1.0])]);
            assert_eq!(changed.at(0, 0.5)[0], path.at(0, 0.5)[0]);
            assert_eq!(changed.at(0, 0.5)[1], 4.5);
        }
    }

    #[test]
    fn inputs_without_derivatives_are_approached() {
        let path = InputPath::new(&[1.0, -2.0], &[vec![3.0, 0.0]]);
        assert_eq!(path.approach(0, 0.0, 2.0), None);
        let approach = path.approach(1, 2.0, 8.0).unwrap();
        assert_eq!(path.with(&[approach]).at(0, 8.0), [25.0, -2.0]);
        assert_eq!(path.with(&[approach]).at(0, 2.0), [7.0, 1.0]);
    }

    #[test]
    fn derivatives_that_are_zero_leave_inputs_held() {
        assert!(InputPath::new(&[1.0], &[vec![0.0], vec![0.0]]).is_held());
        assert!(!InputPath::new(&[1.0], &[vec![0.0], vec![2.0]]).is_held());
    }
}

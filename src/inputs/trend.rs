//! One input as a polynomial in time.

/// An input from a time on [s]: its value then, and its first and second derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Trend {
    pub begin: f64,
    pub derivatives: [f64; 3],
}

impl Trend {
    /// An input that does not change.
    pub fn held(value: f64) -> Self {
        Self { begin: 0.0, derivatives: [value, 0.0, 0.0] }
    }

    /// The trend above a reference.
    pub fn above(self, reference: f64) -> Self {
        let [value, slope, bend] = self.derivatives;
        Self { derivatives: [value - reference, slope, bend], ..self }
    }

    /// The trend where times count from another zero [s].
    pub fn since(self, zero: f64) -> Self {
        Self { begin: self.begin - zero, ..self }
    }

    /// Mean between two times [s].
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let [value, slope, bend] = self.derivatives;
        let (middle, duration) = (0.5 * (from + to) - self.begin, to - from);
        value + middle * (slope + 0.5 * middle * bend) + bend * duration * duration / 24.0
    }

    /// Bound of the difference from the mean between two times [s].
    pub fn variation(&self, [from, to]: [f64; 2]) -> f64 {
        let [_, slope, bend] = self.derivatives;
        let steepest = [from, to].map(|time| (slope + (time - self.begin) * bend).abs());
        (to - from) * steepest[0].max(steepest[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `3 − 2 s + 2 s²`, with s from 1 s on.
    #[test]
    fn means_are_those_of_integrals() {
        let trend = Trend { begin: 1.0, derivatives: [3.0, -2.0, 4.0] };
        let integral = |s: f64| s * (3.0 + s * (-1.0 + s * 2.0 / 3.0));
        for [from, to] in [[1.0, 3.0], [1.5, 1.75], [2.0, 4.0]] {
            let mean = (integral(to - 1.0) - integral(from - 1.0)) / (to - from);
            assert!((trend.mean([from, to]) - mean).abs() < 1e-13);
            assert!((trend.since(0.5).mean([from - 0.5, to - 0.5]) - mean).abs() < 1e-13);
            let at = |time: f64| trend.mean([time, time]);
            let apart = [from, to].map(|time| (at(time) - mean).abs());
            assert!(apart.iter().all(|&apart| apart <= trend.variation([from, to])));
        }
        assert_eq!(Trend::held(280.0).mean([0.1, 0.7]), 280.0);
        assert_eq!(trend.above(1.0).mean([1.0, 1.0]), 2.0);
    }
}

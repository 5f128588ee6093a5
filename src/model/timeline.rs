//! Times of equal steps.

/// Equal steps from time zero to the stop time, the last one shortened to end there exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timeline {
    step: f64,
    stop: f64,
    /// Number of steps.
    pub count: usize,
}

impl Timeline {
    /// Relative difference below which the stop time counts as a multiple of the step.
    const ROUNDING: f64 = 1e-12;

    /// Both arguments are positive [s].
    pub fn new(step: f64, stop: f64) -> Self {
        let ratio = stop / step;
        let whole = ratio.round();
        let is_multiple = (ratio - whole).abs() <= Self::ROUNDING * whole;
        let count = if is_multiple { whole } else { ratio.ceil() };
        Self { step, stop, count: (count as usize).max(1) }
    }

    /// Time after `i` steps [s], free of accumulated rounding.
    pub fn time(&self, i: usize) -> f64 {
        if i < self.count { i as f64 * self.step } else { self.stop }
    }

    /// Length of the step that begins after `i` steps [s]. It is bitwise equal for all steps but a shortened last one,
    /// so that a model can reuse its factorisations.
    pub fn length(&self, i: usize) -> f64 {
        let rest = self.stop - self.time(i);
        let is_shortened = rest < self.step - Self::ROUNDING * self.stop;
        if is_shortened { rest } else { self.step }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_multiple_takes_equal_steps() {
        let timeline = Timeline::new(1e-8, 3.5e-6);
        assert_eq!(timeline.count, 350);
        assert!((0..350).all(|i| timeline.length(i) == 1e-8));
        assert_eq!(timeline.time(350), 3.5e-6);
        assert_eq!(timeline.time(100), 100.0 * 1e-8);
    }

    #[test]
    fn last_step_is_shortened_to_the_end() {
        let timeline = Timeline::new(1.0, 2.5);
        assert_eq!(timeline.count, 3);
        assert_eq!([0, 1, 2].map(|i| timeline.length(i)), [1.0, 1.0, 0.5]);
        assert_eq!([0, 1, 2, 3].map(|i| timeline.time(i)), [0.0, 1.0, 2.0, 2.5]);
    }

    #[test]
    fn step_past_the_end_is_shortened() {
        let timeline = Timeline::new(2.0, 0.5);
        assert_eq!((timeline.count, timeline.length(0), timeline.time(1)), (1, 0.5, 0.5));
    }
}

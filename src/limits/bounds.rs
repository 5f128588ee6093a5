//! Intervals of numbers.

use std::fmt;

use super::number;

/// An end of an interval, and whether the interval includes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    pub value: f64,
    pub is_included: bool,
}

/// The interval of allowed numbers; a missing end is unbounded.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounds {
    pub low: Option<End>,
    pub high: Option<End>,
}

/// Side of an interval on which a number lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Below,
    Above,
}

impl End {
    const fn included(value: f64) -> Self {
        Self { value, is_included: true }
    }
}

impl Bounds {
    /// The numbers from `low` on.
    pub const fn from(low: f64) -> Self {
        Self { low: Some(End::included(low)), high: None }
    }

    /// The numbers between two others, these included.
    pub const fn between(low: f64, high: f64) -> Self {
        Self { low: Some(End::included(low)), high: Some(End::included(high)) }
    }

    /// Returns the side on which `value` lies beyond the interval; NaN counts as above.
    pub fn side(&self, value: f64) -> Option<Side> {
        let Self { low, high } = self;
        if low.is_some_and(|low| value < low.value || (value == low.value && !low.is_included)) {
            return Some(Side::Below);
        }
        let is_below = |high: &End| value < high.value || (value == high.value && high.is_included);
        (value.is_nan() || high.is_some_and(|high| !is_below(&high))).then_some(Side::Above)
    }

    /// Returns true if the interval holds `value`.
    pub fn hold(&self, value: f64) -> bool {
        self.side(value).is_none()
    }

    /// Returns the included end that a value exceeds by no more than `slack`, or else the value.
    pub fn rounded(&self, value: f64, slack: f64) -> f64 {
        let end = match self.side(value) {
            Some(Side::Below) => self.low,
            Some(Side::Above) => self.high,
            None => None,
        };
        let near = end.filter(|end| end.is_included && (value - end.value).abs() <= slack);
        near.map_or(value, |end| end.value)
    }

    /// Length of the interval; infinite without both ends.
    pub fn span(&self) -> f64 {
        match (self.low, self.high) {
            (Some(low), Some(high)) => high.value - low.value,
            _ => f64::INFINITY,
        }
    }

    /// Requirement for a number beyond that end, such as `must be at least 0`.
    pub fn requirement(&self, side: Side) -> String {
        let (end, words) = match side {
            Side::Below => (self.low, ["at least", "above"]),
            Side::Above => (self.high, ["at most", "below"]),
        };
        match end {
            Some(End { value, is_included }) => {
                format!("must be {} {}", words[usize::from(!is_included)], number(value))
            }
            None => "must be a number".to_owned(),
        }
    }
}

impl fmt::Display for Bounds {
    /// Writes `0 to 1`, `above 0 and at most 1`, `at least 0`; nothing without any end.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = |end: End, words: [&str; 2]| {
            format!("{} {}", words[usize::from(!end.is_included)], number(end.value))
        };
        let low = self.low.map(|low| said(low, ["at least", "above"]));
        let high = self.high.map(|high| said(high, ["at most", "below"]));
        match (self.low, self.high) {
            (
                Some(End { value: low, is_included: true }),
                Some(End { value: high, is_included: true }),
            ) => write!(f, "{} to {}", number(low), number(high)),
            _ => f.write_str(&[low, high].into_iter().flatten().collect::<Vec<_>>().join(" and ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_and_closed_ends() {
        let zero = End { value: 0.0, is_included: false };
        let open = Bounds { low: Some(zero), ..Bounds::between(0.0, 1.0) };
        assert_eq!([0.0, -0.0, -1.0].map(|v| open.side(v)), [Some(Side::Below); 3]);
        assert_eq!([1.5, f64::INFINITY, f64::NAN].map(|v| open.side(v)), [Some(Side::Above); 3]);
        assert_eq!([5e-324, 1.0].map(|v| open.side(v)), [None; 2]);
        assert_eq!(Bounds::default().side(f64::MAX), None);
        assert!(Bounds::from(0.0).hold(0.0) && !Bounds::from(0.0).hold(-5e-324));
    }

    #[test]
    fn bounds_describe_open_and_closed_ends() {
        let open = End { value: 0.0, is_included: false };
        assert_eq!(Bounds::between(-1e60, 1e60).to_string(), "-1e60 to 1e60");
        let temperature = Bounds { low: Some(open), ..Bounds::between(0.0, 1e9) };
        assert_eq!(temperature.to_string(), "above 0 and at most 1e9");
        assert_eq!(temperature.requirement(Side::Above), "must be at most 1e9");
        assert_eq!(temperature.requirement(Side::Below), "must be above 0");
        assert_eq!(Bounds::from(0.5).to_string(), "at least 0.5");
        assert_eq!(Bounds::default().to_string(), "");
    }
}

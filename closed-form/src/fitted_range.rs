//! Ranges of the dimensionless numbers over which laws were fitted to measurements or computations.

use std::fmt::{self, Display, Formatter};

/// A dimensionless number and the range of it over which a law was fitted or verified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedRange {
    pub symbol: &'static str,
    pub bounds: [f64; 2],
}

impl FittedRange {
    pub const fn of(symbol: &'static str, bounds: [f64; 2]) -> Self {
        Self { symbol, bounds }
    }

    pub fn contains(&self, value: f64) -> bool {
        (self.bounds[0]..=self.bounds[1]).contains(&value)
    }
}

/// Re 2 to 44000; We 3 and above.
impl Display for FittedRange {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let [low, high] = self.bounds;
        match high.is_finite() {
            true => write!(f, "{} {low} to {high}", self.symbol),
            false => write!(f, "{} {low} and above", self.symbol),
        }
    }
}

/// Describes the numbers outside their ranges, "Re 0.71 (fitted on Re 2 to 44000)"; `None` if all lie within.
pub fn outside(numbers: &[(FittedRange, f64)]) -> Option<String> {
    let describe = |&(range, value): &(FittedRange, f64)| {
        (!range.contains(value))
            .then(|| format!("{} {} (fitted on {range})", range.symbol, short(value)))
    };
    let found: Vec<String> = numbers.iter().filter_map(describe).collect();
    (!found.is_empty()).then(|| found.join(" and "))
}

/// A number to two digits.
fn short(value: f64) -> String {
    match value.abs() {
        size if !(1e-2..1e5).contains(&size) => format!("{value:.1e}"),
        size if size >= 10.0 => format!("{value:.0}"),
        size if size >= 1.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REYNOLDS: FittedRange = FittedRange::of("Re", [2.0, 4.4e4]);
    const WEBER: FittedRange = FittedRange::of("We", [3.0, f64::INFINITY]);

    #[test]
    fn values_within_their_ranges_and_at_the_bounds_are_not_described() {
        assert_eq!(outside(&[(REYNOLDS, 2.0), (WEBER, f64::INFINITY)]), None);
        assert_eq!(outside(&[(REYNOLDS, 4.4e4), (WEBER, 3.0)]), None);
    }

    #[test]
    fn values_outside_are_described_with_their_range() {
        let said = outside(&[(REYNOLDS, 0.714), (WEBER, 1.0)]).unwrap();
        assert_eq!(said, "Re 0.71 (fitted on Re 2 to 44000) and We 1.0 (fitted on We 3 and above)");
        assert!(outside(&[(REYNOLDS, f64::NAN)]).is_some());
        assert!(outside(&[(REYNOLDS, f64::INFINITY)]).unwrap().starts_with("Re inf"));
    }
}

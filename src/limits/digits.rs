//! Numbers in readable notation.

/// Formats a number with six digits in readable notation.
pub fn number(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    let magnitude = f64::abs(rounded);
    if magnitude == 0.0 || (1e-3..1e6).contains(&magnitude) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// Formats a number with two digits in readable notation.
pub fn two_digits(value: f64) -> String {
    number(format!("{value:.1e}").parse().unwrap_or(value))
}

/// Formats the largest number of two digits that is not above a positive one, in readable notation.
pub fn two_digits_below(value: f64) -> String {
    let step = value.log10().floor() as i32 - 1;
    let digits = (value / 10f64.powi(step) * (1.0 + ROUNDING)).floor();
    number(format!("{digits}e{step}").parse().unwrap_or(value))
}

/// Relative error of computed numbers that counts as none.
const ROUNDING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_briefly() {
        assert_eq!(number(1e-3 - 3e-5), "9.7e-4");
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-2e9), "-2e9");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(f64::INFINITY), "inf");
        assert_eq!([3.52, 0.0449, 1.26e-5].map(two_digits), ["3.5", "0.045", "1.3e-5"]);
        let found = [3.59, 0.0449, 1.26e-5, 0.1, 7e-3, 129.0].map(two_digits_below);
        assert_eq!(found, ["3.5", "0.044", "1.2e-5", "0.1", "0.007", "120"]);
    }
}

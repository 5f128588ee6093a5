/// A value with at most five significant digits and a suitable SI prefix.
pub fn engineering(value: f64, unit: &str) -> String {
    with_prefix(value, unit, 5)
}

fn with_prefix(value: f64, unit: &str, digits: usize) -> String {
    const PREFIXES: [(&str, i32); 10] = [
        ("f", -15),
        ("p", -12),
        ("n", -9),
        ("µ", -6),
        ("m", -3),
        ("", 0),
        ("k", 3),
        ("M", 6),
        ("G", 9),
        ("T", 12),
    ];
    let (digits, exponent) = scientific(value, digits);
    let fitting = PREFIXES.iter().find(|(_, power)| (0..3).contains(&(exponent - power)));
    match fitting {
        // The kilogram already has a prefix, and one of an area or a volume would be raised to its power.
        Some((prefix, power)) if value != 0.0 && !unit.starts_with("kg") && !is_power(unit) => {
            // The decimal point is moved in the text, so that no digit is lost to a multiplication.
            let shifted = format!("{digits}e{}", exponent - power);
            let shifted = shifted.parse().unwrap_or(value);
            format!("{shifted} {prefix}{unit}")
        }
        // Removes the sign of a negative zero.
        _ if value == 0.0 || !value.is_finite() => format!("{} {unit}", value + 0.0),
        _ => format!("{value:.4e} {unit}"),
    }
}

/// Returns true if a unit begins with a power, as m² does, "m2" or "m²".
fn is_power(unit: &str) -> bool {
    let mut rest = unit.chars().skip_while(|letter| letter.is_alphabetic());
    rest.next().is_some_and(|letter| letter.is_ascii_digit() || matches!(letter, '²' | '³'))
}

/// An estimated duration [s] in a readable unit.
pub fn lasting(seconds: f64) -> String {
    const UNITS: [(f64, &str); 4] =
        [(3.156e7, "years"), (86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    match UNITS.iter().find(|(unit, _)| seconds >= 2.0 * unit) {
        Some((unit, name)) => format!("{:.0} {name}", seconds / unit),
        None => with_prefix(seconds, "s", 2),
    }
}

/// A size of files in a readable unit, to two digits.
pub fn megabytes(bytes: f64) -> String {
    with_prefix(bytes.max(1e3), "B", 2)
}

/// Digits and power of ten of a value rounded to a number of significant digits.
fn scientific(value: f64, digits: usize) -> (String, i32) {
    let text = format!("{value:.*e}", digits - 1);
    match text.split_once('e') {
        Some((digits, exponent)) => (digits.to_owned(), exponent.parse().unwrap_or(0)),
        None => (text, 0),
    }
}

/// A value in full precision, with an exponent if it would be long without.
pub fn decimal(value: f64) -> String {
    let is_short = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if is_short { format!("{value}") } else { format!("{value:e}") }
}

/// A temperature [K].
pub fn kelvin(value: f64) -> String {
    format!("{value:.2} K")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_keep_numbers_short() {
        let cases = [
            (0.26e-3, "260 µm"),
            (2e-3, "2 mm"),
            (3.5e-6, "3.5 µm"),
            (999.999, "1 km"),
            (-1.5e11, "-150 Gm"),
            (0.0, "0 m"),
            (1.0, "1 m"),
        ];
        for (value, text) in cases {
            assert_eq!(engineering(value, "m"), text);
        }
    }

    #[test]
    fn durations_are_readable() {
        let cases = [
            (0.5, "500 ms"),
            (0.064013, "64 ms"),
            (114.0, "110 s"),
            (40_642.0, "11 hours"),
            (5.8e6, "67 days"),
            (1e9, "32 years"),
        ];
        for (seconds, text) in cases {
            assert_eq!(lasting(seconds), text);
        }
    }

    #[test]
    fn full_precision_is_readable() {
        let cases = [(3e11, "3e11"), (8.1e-6, "8.1e-6"), (0.0, "0"), (293.15, "293.15")];
        for (value, text) in cases {
            assert_eq!(decimal(value), text);
        }
    }

    #[test]
    fn values_beyond_all_prefixes_are_still_shown() {
        assert_eq!(engineering(f64::NAN, "J"), "NaN J");
        assert_eq!(engineering(f64::INFINITY, "J"), "inf J");
        assert_eq!(engineering(1e-20, "J"), "1.0000e-20 J");
        assert_eq!(engineering(5.236e-10, "kg"), "5.2360e-10 kg");
    }
}

//! Numbers with units, as in `"90 °C"`.

use super::decimal::Decimal;
use super::unit::{Dimension, NUMBER, Unit};

/// Reason why a text is not a number of the wanted unit, and what is allowed.
#[derive(Debug, PartialEq)]
pub struct Refusal {
    pub message: String,
    pub allowed: String,
}

/// The number that is wanted of a text.
#[derive(Clone, Copy)]
pub struct Wanted<'w> {
    /// SI unit of the number, in the words of the schema.
    pub unit: &'w str,
    /// False for differences of temperatures and for other constants in kelvin.
    pub is_temperature: bool,
}

/// Returns true if a text begins like a number, so that it is meant to be one.
pub fn is_meant_as_number(text: &str) -> bool {
    let text = text.trim_start().trim_start_matches(['+', '-', '−']);
    text.trim_start_matches('.').starts_with(|c: char| c.is_ascii_digit())
}

/// Returns true if texts with units may stand for numbers of a unit in the words of the schema.
pub fn is_convertible(unit: &str) -> bool {
    unit == "1" || Unit::read(unit).is_ok()
}

/// Converts a text to the number in SI units that it stands for.
pub fn read(text: &str, wanted: Wanted) -> Result<f64, Refusal> {
    let refusal = |message: String| Refusal { message, allowed: examples(wanted) };
    let si =
        Unit::read(wanted.unit).map_err(|part| refusal(format!("`{part}` cannot be converted")))?;
    let (number, unit) = split(text.trim());
    let Ok(value) = number.replace('−', "-").parse::<f64>() else {
        return Err(refusal(format!("`{number}` is not a number")));
    };
    if unit.starts_with(',') {
        return Err(refusal("decimals follow a point, not a comma".to_owned()));
    }
    if unit.is_empty() && si.dimension != NUMBER {
        return Err(refusal("this text has no unit".to_owned()));
    }
    let own = match unit {
        "" => si,
        text => {
            Unit::read(text).map_err(|part| refusal(format!("`{part}` is not a known unit")))?
        }
    };
    if own.dimension != si.dimension {
        let hint = slip(unit, si.dimension);
        return Err(refusal(format!("`{unit}` cannot be converted to {}{hint}", wanted.unit)));
    }
    if own.zero != 0.0 && !wanted.is_temperature {
        return Err(refusal(format!("`{unit}` is for temperatures; this is a constant in K")));
    }
    let number = number.replace('−', "-");
    let (factor, zero) = (own.factor / si.factor, own.zero);
    let value = exact(&number, zero, factor).unwrap_or(factor * (value + zero));
    if value.is_finite() { Ok(value) } else { Err(refusal("not a finite number".to_owned())) }
}

/// `factor · (number + zero)` to the bit, so that `2.1 µm` is 2.1e-6; `None` if it has too many digits.
fn exact(number: &str, zero: f64, factor: f64) -> Option<f64> {
    let sum = Decimal::read(number)?.plus(Decimal::of(zero)?)?;
    let shift = factor.log10().round();
    // Products of prefixes are powers of ten only to rounding.
    let is_power = (factor / 10f64.powf(shift) - 1.0).abs() < 1e-12;
    let factor = if is_power { Decimal::read(&format!("1e{shift}")) } else { Decimal::of(factor) };
    sum.times(factor?)?.value()
}

/// Hint for a unit that is not of the wanted dimension.
fn slip(unit: &str, wanted: Dimension) -> &'static str {
    let meant = unit.replace("mK", "(m K)");
    let denominator = unit.split_once('/').map_or("", |(_, after)| after);
    if meant != unit && Unit::read(&meant).is_ok_and(|meant| meant.dimension == wanted) {
        "; `mK` is a millikelvin: write `(m K)`"
    } else if denominator.contains(' ') && !denominator.contains('(') {
        "; units in a denominator stand in brackets"
    } else {
        ""
    }
}

/// Splits a text after its number.
fn split(text: &str) -> (&str, &str) {
    let mut end = 0;
    let mut characters = text.char_indices().peekable();
    while let Some((at, c)) = characters.next() {
        let is_sign = matches!(c, '+' | '-' | '−') && (at == 0 || text[..at].ends_with(['e', 'E']));
        // `e` belongs to the number only before an exponent.
        let is_exponent = matches!(c, 'e' | 'E')
            && characters
                .peek()
                .is_some_and(|(_, next)| next.is_ascii_digit() || matches!(next, '+' | '-' | '−'));
        if !(c.is_ascii_digit() || c == '.' || is_sign || is_exponent) {
            break;
        }
        end = at + c.len_utf8();
    }
    (&text[..end], text[end..].trim_start())
}

fn examples(wanted: Wanted) -> String {
    let example = match wanted.unit {
        "K" if wanted.is_temperature => "\"90 °C\" or \"363.15 K\"",
        "m" => "\"2 mm\" or \"50 µm\"",
        "s" => "\"50 µs\" or \"2 min\"",
        "m/s" => "\"2 m/s\" or \"600 mm/min\"",
        "Pa" => "\"210 GPa\" or \"2 bar\"",
        "rad" => "\"60°\"",
        "W/m²" => "\"10 W/mm²\"",
        "1" => "\"25 %\"",
        unit => &format!("\"1 {unit}\""),
    };
    format!("a number in {}, or a text with a unit such as {example}", wanted.unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_as(text: &str, unit: &str) -> Result<f64, String> {
        let wanted = Wanted { unit, is_temperature: unit == "K" };
        read(text, wanted).map_err(|refusal| refusal.message)
    }

    fn expect(text: &str, unit: &str, value: f64) {
        let found = read_as(text, unit).unwrap();
        assert!((found - value).abs() <= 1e-13 * value.abs(), "{text}: {found}");
    }

    #[test]
    fn texts_are_converted_to_si_units() {
        expect("90 °C", "K", 363.15);
        expect("-20°C", "K", 253.15);
        expect("−20 °C", "K", 253.15);
        expect("77 K", "K", 77.0);
        expect("212 °F", "K", 373.15);
        expect("2 mm", "m", 2e-3);
        expect("1.5e-3 in", "m", 3.81e-5);
        expect("50 µs", "s", 5e-5);
        expect("10 W/mm2", "W/m²", 1e7);
        expect("0.5 kJ/(kg K)", "J/(kg K)", 500.0);
        expect("17e-6/K", "1/K", 17e-6);
        expect("60°", "rad", std::f64::consts::FRAC_PI_3);
        expect("25 %", "1", 0.25);
        expect("0.3", "1", 0.3);
    }

    #[test]
    fn numbers_are_the_nearest_to_what_is_written() {
        assert_eq!(read_as("2.1 µm", "m"), Ok(2.1e-6));
        assert_eq!(read_as("0.3e-3 GPa", "Pa"), Ok(0.3e6));
        assert_eq!(read_as("-0.1 mm", "m"), Ok(-0.1e-3));
        assert_eq!(read_as("138.040 °C", "K"), Ok(411.19));
        assert_eq!(read_as("-40 °F", "K"), read_as("-40 °C", "K"));
        assert_eq!(read_as("29 cal", "J"), Ok(121.336));
    }

    #[test]
    fn misfits_are_explained() {
        let refuse = |text: &str, unit: &str, message: &str| {
            assert_eq!(read_as(text, unit).unwrap_err(), message);
        };
        refuse("2", "m", "this text has no unit");
        refuse("1,5 mm", "m", "decimals follow a point, not a comma");
        refuse("2 mn", "m", "`mn` is not a known unit");
        refuse("2 kg", "m", "`kg` cannot be converted to m");
        let brackets =
            "`W/m2 K` cannot be converted to W/(m² K); units in a denominator stand in brackets";
        refuse("5 W/m2 K", "W/(m² K)", brackets);
        refuse(
            "15 W/mK",
            "W/(m K)",
            "`W/mK` cannot be converted to W/(m K); `mK` is a millikelvin: write `(m K)`",
        );
        refuse("1e400 m", "m", "not a finite number");
        refuse("20°", "1", "`°` cannot be converted to 1");
        refuse("50 %", "rad", "`%` cannot be converted to rad");
        refuse("2", "rad", "this text has no unit");
        let constant = Wanted { unit: "K", is_temperature: false };
        assert!(read("20 °C", constant).is_err());
        assert_eq!(read("20 K", constant), Ok(20.0));
        assert!(read("3 1/s", Wanted { unit: "1/(s Paⁿ)", is_temperature: false }).is_err());
    }
}

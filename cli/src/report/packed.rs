//! Arrays of a document: short numbers, or 16 bits a value.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Code of a missing value.
const MISSING: u16 = u16::MAX;

/// Digits of a number that is written as text, besides the first.
const DIGITS: usize = 6;

/// Values of a document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Array {
    /// Numbers; missing ones are null.
    Numbers(Vec<Option<f64>>),
    /// `low + (high − low) code / 65534` with codes of 16 bits, the lower byte first, as base64.
    Packed { low: f64, high: f64, data: String },
}

impl Array {
    /// Keeps seven digits of each number.
    pub fn rounded(values: impl IntoIterator<Item = f64>) -> Self {
        let short = |value: f64| {
            let rounded = format!("{value:.DIGITS$e}").parse().unwrap_or(value);
            value.is_finite().then_some(rounded)
        };
        Self::Numbers(values.into_iter().map(short).collect())
    }

    /// Keeps each value to 1/65534 of their range.
    pub fn packed(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = finite()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        if low > high {
            return Self::Packed {
                low: 0.0,
                high: 0.0,
                data: STANDARD.encode(codes(values, 0.0, 0.0)),
            };
        }
        Self::Packed { low, high, data: STANDARD.encode(codes(values, low, high)) }
    }
}

/// Codes of values, two bytes each.
fn codes(values: &[f64], low: f64, high: f64) -> Vec<u8> {
    let scale = if high > low { f64::from(MISSING - 1) / (high - low) } else { 0.0 };
    let code = |value: &f64| match value.is_finite() {
        true => (((value - low) * scale).round() as u16).min(MISSING - 1),
        false => MISSING,
    };
    values.iter().flat_map(|value| code(value).to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_reach_both_ends_and_mark_what_is_missing() {
        let bytes = codes(&[1.0, 2.0, 3.0, f64::NAN], 1.0, 3.0);
        let words: Vec<u16> =
            bytes.chunks(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect();
        assert_eq!(words, [0, 32767, 65534, 65535]);
    }

    #[test]
    fn equal_values_are_packed_without_a_division_by_zero() {
        let Array::Packed { low, high, .. } = Array::packed(&[293.15; 3]) else { panic!() };
        assert_eq!((low, high), (293.15, 293.15));
    }

    #[test]
    fn rounded_numbers_keep_seven_digits() {
        let Array::Numbers(values) = Array::rounded([1.0 / 3.0, f64::INFINITY]) else { panic!() };
        assert_eq!(values, [Some(0.3333333), None]);
    }
}

//! Whole numbers, which scenes may write with an exponent.

use std::fmt;

use serde::Deserializer;
use serde::de::{Error, Unexpected, Visitor};

/// Reads a whole number, written as such or as a float without fraction: TOML treats `1e6` as a float.
pub fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<usize>, D::Error> {
    struct Reader;

    impl Visitor<'_> for Reader {
        type Value = usize;

        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("a whole number")
        }

        fn visit_i64<E: Error>(self, value: i64) -> Result<usize, E> {
            let refuse = || E::invalid_value(Unexpected::Signed(value), &self);
            usize::try_from(value).map_err(|_| refuse())
        }

        fn visit_u64<E: Error>(self, value: u64) -> Result<usize, E> {
            let refuse = || E::invalid_value(Unexpected::Unsigned(value), &self);
            usize::try_from(value).map_err(|_| refuse())
        }

        fn visit_f64<E: Error>(self, value: f64) -> Result<usize, E> {
            // Floats cannot represent a fraction of larger numbers.
            let is_exact = value.fract() == 0.0 && (0.0..=LARGEST).contains(&value);
            let refuse = || E::invalid_value(Unexpected::Float(value), &self);
            is_exact.then_some(value as usize).ok_or_else(refuse)
        }
    }

    deserializer.deserialize_any(Reader).map(Some)
}

/// Largest number up to which floats represent every whole number.
const LARGEST: f64 = 9_007_199_254_740_992.0;

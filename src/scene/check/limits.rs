//! Single numbers against the bounds that the schema gives their keys.

use super::{Checker, number};
use crate::scene::schema::{Limits, Schema};

/// Refuses every number that is beyond its bounds.
pub fn check(checker: &mut Checker, schema: &Schema) {
    schema.numbers(checker.source, &mut |place, limits, value| {
        if let Some((why, allowed)) = refusal(limits, value) {
            checker.refuse(&place.path(), why, allowed);
        }
    });
}

/// Why a number is refused, and what is allowed.
///
/// Bounds without words are looked at by checks that know more.
fn refusal(limits: &Limits, value: f64) -> Option<(String, String)> {
    let (low, low_is_allowed) = limits.low.unwrap_or((f64::NEG_INFINITY, true));
    let (high, high_is_allowed) = limits.high.unwrap_or((f64::INFINITY, true));
    let is_above = value > low || (low_is_allowed && value == low);
    let is_below = value < high || (high_is_allowed && value == high);
    if is_above && is_below {
        return None;
    }
    let words = if is_above { limits.too_high } else { limits.too_low };
    if let Some((why, allowed)) = words {
        return Some((why.to_owned(), allowed.to_owned()));
    }
    let noun = limits.noun?;
    let is_positive = low > 0.0 || (low == 0.0 && !low_is_allowed);
    let (why, allowed) = if is_positive && value <= 0.0 {
        ("must be positive", "> 0".to_owned())
    } else if low == 0.0 && value < 0.0 {
        ("is not negative", ">= 0".to_owned())
    } else {
        ("is beyond all bounds", format!("{} to {}", number(low), number(high)))
    };
    Some((format!("{noun} {why}"), allowed))
}

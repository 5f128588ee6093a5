//! Checks single numbers against the bounds that the schema sets for their keys.

use super::Checker;
use crate::limits::Side;
use crate::scene::schema::{Limits, Schema};

/// Refuses every number beyond its bounds.
pub fn check(checker: &mut Checker, schema: &Schema) {
    schema.numbers(checker.source, &mut |place, limits, value| {
        if let Some((why, allowed)) = refusal(limits, value) {
            checker.refuse(&place.path(), why, allowed);
        }
    });
}

/// Reason why a number is refused, and what is allowed.
///
/// Bounds without words are left to more specific checks.
fn refusal(limits: &Limits, value: f64) -> Option<(String, String)> {
    let side = limits.bounds.side(value)?;
    let words = match side {
        Side::Below => limits.too_low,
        Side::Above => limits.too_high,
    };
    if let Some((why, allowed)) = words {
        return Some((why.to_owned(), allowed.to_owned()));
    }
    let noun = limits.noun?;
    let low = limits.bounds.low.map_or(f64::NEG_INFINITY, |end| end.value);
    let is_positive = low > 0.0 || (low == 0.0 && !limits.bounds.hold(0.0));
    let (why, allowed) = if is_positive && value <= 0.0 {
        ("must be positive", "> 0".to_owned())
    } else if low == 0.0 && value < 0.0 {
        ("is not negative", ">= 0".to_owned())
    } else {
        ("is beyond all bounds", limits.bounds.to_string())
    };
    Some((format!("{noun} {why}"), allowed))
}

//! Constraints of the schema on numbers.

use serde::de::MapAccess;

use crate::limits::plausible::{Cold, Range};
use crate::limits::{Bounds, End, keyword};

/// Reason why a number is refused, and what is allowed.
pub type Words<'s> = (&'s str, &'s str);

/// Constraints of a schema on a number, or on the numbers of a value.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Limits<'s> {
    pub unit: Option<&'s str>,
    /// Noun for the number in messages.
    pub noun: Option<&'s str>,
    pub bounds: Bounds,
    pub too_low: Option<Words<'s>>,
    pub too_high: Option<Words<'s>>,
    plausible: Option<Range<'s>>,
    cryogenic: Option<f64>,
    beside_warm: Option<f64>,
}

impl<'s> Limits<'s> {
    /// Reads the value of a keyword; returns true if it is one of numbers.
    pub fn read<A: MapAccess<'s>>(&mut self, key: &str, map: &mut A) -> Result<bool, A::Error> {
        match key {
            "minimum" => self.bounds.low = end(map, true)?,
            "exclusiveMinimum" => self.bounds.low = end(map, false)?,
            "maximum" => self.bounds.high = end(map, true)?,
            "exclusiveMaximum" => self.bounds.high = end(map, false)?,
            keyword::UNIT => self.unit = map.next_value()?,
            keyword::NOUN => self.noun = map.next_value()?,
            keyword::TOO_LOW => self.too_low = map.next_value()?,
            keyword::TOO_HIGH => self.too_high = map.next_value()?,
            keyword::PLAUSIBLE => self.plausible = map.next_value()?,
            keyword::CRYOGENIC => self.cryogenic = map.next_value()?,
            keyword::BESIDE_WARM => self.beside_warm = map.next_value()?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The plausible range, if any, in a scene of this coldness.
    pub fn plausible(&self, cold: Cold) -> Option<Range<'s>> {
        let range = self.plausible.clone()?;
        let lowest = match cold {
            Cold::Meant => self.cryogenic,
            Cold::Throughout => None,
            Cold::BesideWarm => self.beside_warm,
        };
        Some(Range { lowest: lowest.unwrap_or(range.lowest), ..range })
    }

    /// Returns true if the value raises no warning in any scene.
    pub fn is_usual(&self, value: f64) -> bool {
        let is_warm = self.beside_warm.is_none_or(|lowest| value >= lowest);
        is_warm && self.plausible.as_ref().is_none_or(|range| range.holds(value))
    }
}

/// Reads the end of an interval from a keyword.
fn end<'s, A: MapAccess<'s>>(map: &mut A, is_included: bool) -> Result<Option<End>, A::Error> {
    Ok(Some(End { value: map.next_value()?, is_included }))
}

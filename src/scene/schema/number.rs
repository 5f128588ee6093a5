use serde::de::MapAccess;

use crate::limits::keyword;
use crate::limits::plausible::Range;

/// Why a number is refused, and what is allowed.
pub type Words<'s> = (&'s str, &'s str);

/// What a schema says of a number, or of those that a value is made of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Limits<'s> {
    pub unit: Option<&'s str>,
    /// What the number is, in words.
    pub noun: Option<&'s str>,
    /// Least and largest value, and whether these are allowed themselves.
    pub low: Option<(f64, bool)>,
    pub high: Option<(f64, bool)>,
    pub too_low: Option<Words<'s>>,
    pub too_high: Option<Words<'s>>,
    plausible: Option<Range<'s>>,
    cryogenic: Option<f64>,
}

impl<'s> Limits<'s> {
    /// Reads the value of a keyword; whether it is one of numbers.
    pub fn read<A: MapAccess<'s>>(&mut self, key: &str, map: &mut A) -> Result<bool, A::Error> {
        match key {
            "minimum" => self.low = Some((map.next_value()?, true)),
            "exclusiveMinimum" => self.low = Some((map.next_value()?, false)),
            "maximum" => self.high = Some((map.next_value()?, true)),
            "exclusiveMaximum" => self.high = Some((map.next_value()?, false)),
            keyword::UNIT => self.unit = map.next_value()?,
            keyword::NOUN => self.noun = map.next_value()?,
            keyword::TOO_LOW => self.too_low = map.next_value()?,
            keyword::TOO_HIGH => self.too_high = map.next_value()?,
            keyword::PLAUSIBLE => self.plausible = map.next_value()?,
            keyword::CRYOGENIC => self.cryogenic = map.next_value()?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The plausible range, if there is one, in a scene with or without liquids as light as hydrogen.
    pub fn plausible(&self, is_cryogenic: bool) -> Option<Range<'s>> {
        let range = self.plausible.clone()?;
        let lowest = self.cryogenic.filter(|_| is_cryogenic).unwrap_or(range.lowest);
        Some(Range { lowest, ..range })
    }

    /// Whether nobody doubts the value, whatever else the scene holds.
    pub fn is_usual(&self, value: f64) -> bool {
        self.plausible.as_ref().is_none_or(|range| range.holds(value))
    }
}

use serde::Deserialize;
use serde_json::{Map, Value};

use crate::limits::keyword;
use crate::limits::plausible::Range;

/// The schema of a number, read once for all elements of a list.
pub struct Number<'s> {
    keywords: &'s Map<String, Value>,
    /// Least and largest value, and whether these are allowed themselves.
    pub low: (f64, bool),
    pub high: (f64, bool),
    /// Magnitudes that are not doubted.
    usual: Option<[f64; 2]>,
}

/// Why a number is refused, and what is allowed.
pub type Words<'s> = (&'s str, &'s str);

impl<'s> Number<'s> {
    pub fn new(keywords: &'s Map<String, Value>) -> Self {
        let bound = |closed: &str, open: &str, otherwise: f64| {
            let value = |key: &str| keywords.get(key).and_then(Value::as_f64);
            match (value(open), value(closed)) {
                (Some(open), _) => (open, false),
                (None, Some(closed)) => (closed, true),
                (None, None) => (otherwise, true),
            }
        };
        let low = bound("minimum", "exclusiveMinimum", f64::NEG_INFINITY);
        let high = bound("maximum", "exclusiveMaximum", f64::INFINITY);
        let usual = keywords.get(keyword::PLAUSIBLE).and_then(|range| {
            Some([range.get("lowest")?.as_f64()?, range.get("highest")?.as_f64()?])
        });
        Self { keywords, low, high, usual }
    }

    /// What the number is, in words.
    pub fn noun(&self) -> Option<&'s str> {
        self.keywords.get(keyword::NOUN)?.as_str()
    }

    pub fn too_low(&self) -> Option<Words<'s>> {
        self.words(keyword::TOO_LOW)
    }

    pub fn too_high(&self) -> Option<Words<'s>> {
        self.words(keyword::TOO_HIGH)
    }

    fn words(&self, key: &str) -> Option<Words<'s>> {
        let words = self.keywords.get(key)?;
        Some((words.get(0)?.as_str()?, words.get(1)?.as_str()?))
    }

    /// Whether nobody doubts the value, whatever else the scene holds.
    pub fn is_usual(&self, value: f64) -> bool {
        let holds = |[low, high]: [f64; 2]| value == 0.0 || (low..=high).contains(&value.abs());
        self.usual.is_none_or(holds)
    }

    /// Its plausible range, if it has one, in a scene with or without liquids as light as hydrogen.
    pub fn plausible(&self, is_cryogenic: bool) -> Option<Range<'s>> {
        let mut range = Range::deserialize(self.keywords.get(keyword::PLAUSIBLE)?).ok()?;
        let cold = self.keywords.get(keyword::CRYOGENIC).and_then(Value::as_f64);
        if let (true, Some(lowest)) = (is_cryogenic, cold) {
            range.lowest = lowest;
        }
        Some(range)
    }
}

//! Allowed numbers of a scene: units, bounds, plausible ranges and the words of refusals.
//!
//! Fields of the scene's types name their [`Limits`] in `#[schemars(transform = …)]`. These become keywords of the JSON
//! schema of scenes (`minimum`, `exclusiveMinimum`, …) and of [`keyword`]; checks, messages and tables read them from
//! there.

mod bounds;
mod digits;
pub mod plausible;

use schemars::{Schema, transform::Transform};
use serde_json::{Map, Value, json};

pub use bounds::{Bounds, End, Side};
pub use digits::{number, two_digits, two_digits_below};
use plausible::Range;

/// Keywords in addition to those of JSON Schema.
pub mod keyword {
    /// Unit of a number; absent for texts, counts and ratios.
    pub const UNIT: &str = "unit";
    /// Noun for a number, as in "the density".
    pub const NOUN: &str = "noun";
    /// Reason why a number is too small, and what is allowed, where the noun does not suffice.
    pub const TOO_LOW: &str = "tooLow";
    /// The same for a number that is too large.
    pub const TOO_HIGH: &str = "tooHigh";
    /// Condition on the value besides its bounds, in words.
    pub const CONDITION: &str = "condition";
    /// Default of an absent key, in words.
    pub const OTHERWISE: &str = "otherwise";
    /// Range outside of which a value is probably a mistake.
    pub const PLAUSIBLE: &str = "plausible";
    /// Lower end of that range in intentionally cold scenes.
    pub const CRYOGENIC: &str = "cryogenic";
    /// Lower end of that range in scenes that also contain something warmer.
    pub const BESIDE_WARM: &str = "besideWarm";
}

/// A message and what is allowed instead.
type Words = (&'static str, &'static str);

/// Constraints on a number, or on each number of a list.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    unit: Option<&'static str>,
    noun: Option<&'static str>,
    bounds: Bounds,
    too_low: Option<Words>,
    too_high: Option<Words>,
    condition: Option<&'static str>,
    otherwise: Option<&'static str>,
    plausible: Option<&'static Range<'static>>,
    /// Lower end of that range in intentionally cold scenes, and in those that also contain something warmer.
    cryogenic: Option<f64>,
    beside_warm: Option<f64>,
}

/// Smallest and largest magnitude of constants. Products of a few of them, and their squares, stay well within the
/// range of numbers.
const SMALLEST: f64 = 1e-60;
pub const LARGEST: f64 = 1e60;

/// Largest extent of a body [m].
const LONGEST: f64 = 1e6;

/// Largest number of points, rings or tiles along an axis.
const MOST_CELLS: f64 = 1000.0;

/// Any number of a unit.
pub const fn any(unit: &'static str) -> Limits {
    Limits {
        unit: Some(unit),
        noun: None,
        bounds: Bounds { low: None, high: None },
        too_low: None,
        too_high: None,
        condition: None,
        otherwise: None,
        plausible: None,
        cryogenic: None,
        beside_warm: None,
    }
}

/// A number within a closed interval.
pub const fn within(low: f64, high: f64, unit: &'static str, noun: &'static str) -> Limits {
    Limits { bounds: Bounds::between(low, high), noun: Some(noun), ..any(unit) }
}

/// A number above zero; other checks report violations.
pub const fn above_zero(unit: &'static str) -> Limits {
    let limits = Limits { bounds: Bounds::from(0.0), ..any(unit) };
    limits.low_open()
}

/// An extent of a body [m].
pub const fn length(noun: &'static str) -> Limits {
    within(1e-12, LONGEST, "m", noun)
}

/// A time within a run [s].
pub const fn time(noun: &'static str) -> Limits {
    within(1e-30, 1e12, "s", noun).plausible(&plausible::TIME)
}

/// Noun of temperatures, as distinct from other constants in kelvin.
pub const TEMPERATURE: &str = "a temperature";

/// A temperature above absolute zero [K].
pub const fn temperature() -> Limits {
    let limits = within(0.0, 1e9, "K", TEMPERATURE).low_open();
    limits.low("a temperature is above absolute zero", "> 0 (kelvin)")
}

/// The temperature of an object in the scene [K].
pub const fn own_temperature() -> Limits {
    temperature().plausible(&plausible::TEMPERATURE).guarded()
}

/// The temperature of a body's surroundings [K].
pub const fn ambient() -> Limits {
    temperature().plausible(&plausible::AMBIENT).guarded()
}

/// A temperature in a table of constants [K].
pub const fn knot() -> Limits {
    temperature().plausible(&plausible::KNOT).cold()
}

/// A heat flux into a body [W/m²].
pub const fn heat_flux() -> Limits {
    signed("W/m²", "a heat flux").plausible(&plausible::HEAT_FLUX)
}

/// A heating power of a load [W]; its heat flux, not the power itself, may be implausible.
pub const fn power() -> Limits {
    signed("W", "a heating power")
}

/// A pressure or shear on a body [Pa].
pub const fn traction() -> Limits {
    signed("Pa", "a pressure or shear").plausible(&plausible::TRACTION)
}

/// A coordinate of a footprint's centre along an axis of its face [m].
pub const fn place() -> Limits {
    within(-LONGEST, LONGEST, "m", "the place of a footprint")
}

/// The radius of a footprint [m].
pub const fn footprint_radius() -> Limits {
    length("the radius of a footprint")
}

/// A communication step of a unit [s]. Its products with rates of bodies, up to `k/(ρ c l²)` at the ends of their
/// limits, and with the span of inputs stay finite, and so do its cube and its inverse. Longer steps would lose heat in
/// modes whose exponents overflow.
pub const fn step() -> Limits {
    within(SMALLEST, LARGEST, "s", "a communication step")
}

/// A positive constant of a material.
pub const fn positive(unit: &'static str, noun: &'static str) -> Limits {
    within(SMALLEST, LARGEST, unit, noun)
}

/// A constant that may be zero.
pub const fn not_negative(unit: &'static str, noun: &'static str) -> Limits {
    within(0.0, LARGEST, unit, noun)
}

/// A constant of either sign.
pub const fn signed(unit: &'static str, noun: &'static str) -> Limits {
    within(-LARGEST, LARGEST, unit, noun)
}

/// A number of points, rings or tiles.
pub const fn count() -> Limits {
    whole(1, MOST_CELLS as u32, "the count is out of bounds", "1 to 1000")
}

/// A whole number within a closed interval.
pub const fn whole(low: u32, high: u32, why: &'static str, allowed: &'static str) -> Limits {
    let limits = within(low as f64, high as f64, "", "").says(why, allowed);
    Limits { unit: None, noun: None, ..limits }
}

/// The same end of an interval, excluded.
const fn excluded(end: Option<End>) -> Option<End> {
    match end {
        Some(End { value, .. }) => Some(End { value, is_included: false }),
        None => None,
    }
}

impl Limits {
    /// The interval of allowed numbers.
    pub const fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Sets the message for values beyond either end, with what is allowed.
    pub const fn says(self, why: &'static str, allowed: &'static str) -> Self {
        self.low(why, allowed).high(why, allowed)
    }

    /// Sets the message for values that are too small.
    pub const fn low(self, why: &'static str, allowed: &'static str) -> Self {
        Self { too_low: Some((why, allowed)), ..self }
    }

    /// Sets the message for values that are too large.
    pub const fn high(self, why: &'static str, allowed: &'static str) -> Self {
        Self { too_high: Some((why, allowed)), ..self }
    }

    /// Excludes the lower end.
    pub const fn low_open(self) -> Self {
        Self { bounds: Bounds { low: excluded(self.bounds.low), ..self.bounds }, ..self }
    }

    /// Excludes both ends.
    pub const fn open(self) -> Self {
        let Bounds { low, high } = self.bounds;
        Self { bounds: Bounds { low: excluded(low), high: excluded(high) }, ..self }
    }

    /// Sets a further condition, in words.
    pub const fn condition(self, condition: &'static str) -> Self {
        Self { condition: Some(condition), ..self }
    }

    /// Sets the default of an absent key, in words.
    pub const fn otherwise(self, otherwise: &'static str) -> Self {
        Self { otherwise: Some(otherwise), ..self }
    }

    /// Sets the range outside of which a value is probably a mistake.
    pub const fn plausible(self, range: &'static Range<'static>) -> Self {
        Self { plausible: Some(range), ..self }
    }

    /// Extends the plausible range to [`plausible::CRYOGENIC`] in intentionally cold scenes.
    pub const fn cold(self) -> Self {
        Self { cryogenic: Some(plausible::CRYOGENIC), ..self }
    }

    /// As [`Self::cold`], and restricts it to [`plausible::BESIDE_WARM`] in scenes that also contain something warmer.
    pub const fn guarded(self) -> Self {
        self.guarded_from(plausible::BESIDE_WARM)
    }

    /// As [`Self::guarded`], with another lower end.
    pub const fn guarded_from(self, lowest: f64) -> Self {
        Self { beside_warm: Some(lowest), ..self.cold() }
    }

    /// Writes the limits of a number into its schema.
    fn put(&self, number: &mut Map<String, Value>) {
        for (end, closed, open) in [
            (self.bounds.low, "minimum", "exclusiveMinimum"),
            (self.bounds.high, "maximum", "exclusiveMaximum"),
        ] {
            if let Some(End { value, is_included }) = end {
                number.remove(closed);
                number.insert(if is_included { closed } else { open }.into(), plain(value));
            }
        }
        let words = |words: Option<Words>| words.map(|(why, allowed)| json!([why, allowed]));
        for (key, value) in [
            (keyword::UNIT, self.unit.map(Value::from)),
            (keyword::NOUN, self.noun.filter(|noun| !noun.is_empty()).map(Value::from)),
            (keyword::TOO_LOW, words(self.too_low)),
            (keyword::TOO_HIGH, words(self.too_high)),
            (keyword::PLAUSIBLE, self.plausible.map(|range| json!(range))),
            (keyword::CRYOGENIC, self.cryogenic.map(plain)),
            (keyword::BESIDE_WARM, self.beside_warm.map(plain)),
        ] {
            if let Some(value) = value {
                number.insert(key.into(), value);
            }
        }
    }

    /// Writes them into the schemas of all numbers of a value.
    fn put_into_numbers(&self, value: &mut Value) {
        let Value::Object(schema) = value else { return };
        if is_number(schema) {
            return self.put(schema);
        }
        for (key, part) in schema {
            match (key.as_str(), part) {
                ("items", items) => self.put_into_numbers(items),
                ("anyOf", Value::Array(list)) => {
                    list.iter_mut().for_each(|part| self.put_into_numbers(part));
                }
                // The values of a table over the temperature.
                ("properties", Value::Object(keys)) => {
                    keys.get_mut("value").into_iter().for_each(|part| self.put_into_numbers(part));
                }
                _ => {}
            }
        }
    }
}

/// The allowed keys of a table whose values all have the same type.
#[derive(Debug, Clone, Copy)]
pub struct Keys<const N: usize>(pub [&'static str; N]);

impl<const N: usize> Transform for Keys<N> {
    fn transform(&mut self, schema: &mut Schema) {
        schema.insert("propertyNames".into(), json!({ "enum": self.0.as_slice() }));
    }
}

/// Describes the key that chooses among the alternatives of a schema.
#[derive(Debug, Clone, Copy)]
pub struct Tag {
    key: &'static str,
    meaning: &'static str,
}

/// The key of a table that chooses its type, and its description.
pub const fn tag(key: &'static str, meaning: &'static str) -> Tag {
    Tag { key, meaning }
}

impl Transform for Tag {
    fn transform(&mut self, schema: &mut Schema) {
        let alternatives = schema.get_mut("oneOf").and_then(Value::as_array_mut);
        for alternative in alternatives.into_iter().flatten() {
            alternative["properties"][self.key]["description"] = self.meaning.into();
        }
    }
}

/// A number in readable notation: 1 instead of 1.0.
fn plain(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e6 { json!(value as i64) } else { json!(value) }
}

/// Returns true if a schema is that of a number.
pub fn is_number(schema: &Map<String, Value>) -> bool {
    let names_one = |name: &Value| matches!(name.as_str(), Some("number" | "integer"));
    match schema.get("type") {
        Some(Value::Array(list)) => list.iter().any(names_one),
        Some(name) => names_one(name),
        None => false,
    }
}

impl Transform for Limits {
    fn transform(&mut self, schema: &mut Schema) {
        let object = schema.ensure_object();
        for (key, text) in [
            (keyword::UNIT, self.unit),
            (keyword::CONDITION, self.condition),
            (keyword::OTHERWISE, self.otherwise),
        ] {
            if let Some(text) = text {
                object.insert(key.into(), text.into());
            }
        }
        let mut value = Value::Object(std::mem::take(object));
        self.put_into_numbers(&mut value);
        if let Value::Object(filled) = value {
            *object = filled;
        }
    }
}

//! Constants that may depend on the temperature.

use std::fmt;

use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::limits::knot;

/// A constant of a material that is a number or depends on the temperature.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Property {
    Constant(f64),
    Table(Table),
}

/// Values over temperatures: linear between them, held outside of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct Table {
    /// Ascending temperatures [K].
    #[schemars(length(min = 2), transform = knot())]
    pub temperature: Vec<f64>,
    /// One value for each.
    #[schemars(length(min = 2))]
    pub value: Vec<f64>,
}

/// Reasons why a property is invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PropertyError {
    #[error("a table has {0} temperatures (allowed: at least 2)")]
    TooShort(usize),
    #[error(
        "a table has {temperatures} temperatures but {values} values (allowed: one value for each)"
    )]
    Lengths { temperatures: usize, values: usize },
    #[error("{0} in a table is no finite number")]
    NotFinite(f64),
    #[error("temperature {1} K of a table follows {0} K (allowed: strictly ascending)")]
    NotAscending(f64, f64),
    #[error("value {0} (allowed: above 0)")]
    NotPositive(f64),
}

impl Property {
    /// Checks numbers that must all be above zero.
    pub fn check(&self) -> Result<(), PropertyError> {
        if let Self::Table(table) = self {
            table.check()?;
        }
        match self.values().iter().find(|&&value| !(value > 0.0 && value.is_finite())) {
            Some(&value) if value.is_finite() => Err(PropertyError::NotPositive(value)),
            Some(&value) => Err(PropertyError::NotFinite(value)),
            None => Ok(()),
        }
    }

    /// The value at a temperature [K].
    pub fn value(&self, temperature: f64) -> f64 {
        self.about(temperature).at(0.0).0
    }

    /// Returns true if the property is independent of the temperature.
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// Returns the constant property with the value of this one at a temperature [K].
    pub fn at(&self, temperature: f64) -> Self {
        Self::Constant(self.value(temperature))
    }

    /// The number, unless it is a table.
    pub fn number(&mut self) -> Option<&mut f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Table(_) => None,
        }
    }

    /// Derivative with respect to temperature [1/K]: at a knot that of the interval above, outside a table zero.
    pub fn derivative(&self, temperature: f64) -> f64 {
        let Self::Table(table) = self else { return 0.0 };
        let above = table.temperature.partition_point(|&knot| knot <= temperature);
        if above == 0 || above == table.temperature.len() {
            return 0.0;
        }
        let rise = |list: &[f64]| list[above] - list[above - 1];
        rise(&table.value) / rise(&table.temperature)
    }

    /// `∫ value dT` from one temperature to another [K], exact.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        self.about(from).at(to - from).1
    }

    /// Returns the property as a function of the temperature above a reference [K].
    pub fn about(&self, reference: f64) -> Curve {
        Curve::new(self, reference)
    }

    /// Temperatures at which the slope changes [K].
    pub fn knots(&self) -> &[f64] {
        match self {
            Self::Constant(_) => &[],
            Self::Table(table) => &table.temperature,
        }
    }

    /// The number, or all values of the table.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Constant(value) => std::slice::from_ref(value),
            Self::Table(table) => &table.value,
        }
    }
}

impl<'de> Deserialize<'de> for Property {
    /// Implemented by hand, so that errors within a table are reported at their place.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = Property;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a finite number or a table of `temperature` and `value`")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(Property::Constant(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(Property::Constant(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Self::Value, E> {
                Ok(Property::Constant(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                Table::deserialize(MapAccessDeserializer::new(map)).map(Property::Table)
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl From<f64> for Property {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl Table {
    /// Checks the lists.
    pub fn check(&self) -> Result<(), PropertyError> {
        let Self { temperature, value } = self;
        if temperature.len() != value.len() {
            let (temperatures, values) = (temperature.len(), value.len());
            return Err(PropertyError::Lengths { temperatures, values });
        }
        if temperature.len() < 2 {
            return Err(PropertyError::TooShort(temperature.len()));
        }
        if let Some(&odd) = temperature.iter().chain(value).find(|number| !number.is_finite()) {
            return Err(PropertyError::NotFinite(odd));
        }
        match temperature.windows(2).find(|pair| pair[0] >= pair[1]) {
            Some(pair) => Err(PropertyError::NotAscending(pair[0], pair[1])),
            None => Ok(()),
        }
    }

    /// NaN for a table that [`Self::check`] refuses because of its lengths.
    fn value(&self, temperature: f64) -> f64 {
        if self.value.is_empty() || self.value.len() != self.temperature.len() {
            return f64::NAN;
        }
        let above = self.temperature.partition_point(|&knot| knot <= temperature);
        if above == 0 {
            return self.value[0];
        }
        if above == self.temperature.len() {
            return self.value[above - 1];
        }
        let [low, high] = [above - 1, above].map(|i| self.temperature[i]);
        let part = (temperature - low) / (high - low);
        (1.0 - part) * self.value[above - 1] + part * self.value[above]
    }
}

/// A property and its integral as functions of the temperature above a reference.
///
/// The reference is a knot, so that small differences to it keep all digits.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    knots: Vec<Knot>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    /// Temperature above the reference [K].
    rise: f64,
    value: f64,
    /// Slope up to the next knot [1/K].
    slope: f64,
    /// `∫ value dT` from the reference.
    integral: f64,
}

impl Curve {
    fn new(property: &Property, reference: f64) -> Self {
        let table = match property {
            Property::Constant(value) => {
                let knot = Knot { rise: 0.0, value: *value, slope: 0.0, integral: 0.0 };
                return Self { knots: vec![knot] };
            }
            Property::Table(table) => table,
        };
        let mut rises: Vec<f64> = table.temperature.iter().map(|t| t - reference).collect();
        let own = rises.partition_point(|&rise| rise < 0.0);
        let mut values = table.value.clone();
        if rises.get(own) != Some(&0.0) {
            rises.insert(own, 0.0);
            values.insert(own, table.value(reference));
        }
        let mut knots: Vec<Knot> = Vec::with_capacity(rises.len());
        let mut integral = 0.0;
        for (i, (&rise, &value)) in rises.iter().zip(&values).enumerate() {
            let width = rises.get(i + 1).map_or(0.0, |next| next - rise);
            let step = values.get(i + 1).map_or(0.0, |next| next - value);
            let slope = if width > 0.0 { step / width } else { 0.0 };
            knots.push(Knot { rise, value, slope, integral });
            integral += width * (value + 0.5 * step);
        }
        let base = knots[own].integral;
        knots.iter_mut().for_each(|knot| knot.integral -= base);
        Self { knots }
    }

    /// Value and integral from the reference at a temperature above it [K].
    pub fn at(&self, rise: f64) -> (f64, f64) {
        if let [only] = self.knots.as_slice() {
            return (only.value, only.value * rise);
        }
        let above = self.knots.partition_point(|knot| knot.rise <= rise);
        let knot = self.knots[above.saturating_sub(1)];
        let slope = if above == 0 { 0.0 } else { knot.slope };
        let along = rise - knot.rise;
        let value = knot.value + slope * along;
        (value, knot.integral + 0.5 * along * (knot.value + value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(temperature: &[f64], value: &[f64]) -> Property {
        Property::Table(Table { temperature: temperature.to_vec(), value: value.to_vec() })
    }

    #[test]
    fn tables_interpolate_linearly_and_extrapolate_constantly() {
        let property = table(&[200.0, 300.0, 500.0], &[4.0, 2.0, 6.0]);
        for (t, value, derivative) in [
            (100.0, 4.0, 0.0),
            (200.0, 4.0, -0.02),
            (250.0, 3.0, -0.02),
            (300.0, 2.0, 0.02),
            (450.0, 5.0, 0.02),
            (500.0, 6.0, 0.0),
            (900.0, 6.0, 0.0),
        ] {
            assert!((property.value(t) - value).abs() < 1e-14, "{t}");
            assert!((property.derivative(t) - derivative).abs() < 1e-16, "{t}");
        }
        assert!((property.integral(100.0, 600.0) - (400.0 + 300.0 + 800.0 + 600.0)).abs() < 1e-10);
    }

    #[test]
    fn integrals_are_those_of_a_quadrature_and_add_up() {
        let property = table(&[200.0, 310.0, 500.0], &[4.0, 2.0, 60.0]);
        let parts = [50.0, 200.0, 250.0, 310.0, 320.0, 500.0, 700.0];
        for pair in parts.windows(2) {
            // Simpson's rule is exact where the value is linear.
            let [a, b] = [pair[0], pair[1]];
            let sum = property.value(a) + 4.0 * property.value(0.5 * (a + b)) + property.value(b);
            assert!((property.integral(a, b) / (sum * (b - a) / 6.0) - 1.0).abs() < 1e-14);
            assert_eq!(property.integral(b, a).signum(), -1.0);
        }
        let sum: f64 = parts.windows(2).map(|pair| property.integral(pair[0], pair[1])).sum();
        assert!((property.integral(50.0, 700.0) / sum - 1.0).abs() < 1e-14);
    }

    #[test]
    fn small_differences_to_the_reference_keep_their_digits() {
        let curve = table(&[200.0, 3000.0], &[4.0, 400.0]).about(1234.5);
        let (value, integral) = curve.at(1e-12);
        assert!((integral / (1e-12 * value) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn numbers_and_tables_are_read() {
        #[derive(Deserialize)]
        struct Holder {
            k: Property,
        }
        let read = |text: &str| toml::from_str::<Holder>(text).map(|holder| holder.k);
        assert_eq!(read("k = 3").unwrap(), Property::Constant(3.0));
        let wanted = table(&[273.0, 400.0], &[1.0, 2.5]);
        assert_eq!(read("k = { temperature = [273, 400.0], value = [1, 2.5] }").unwrap(), wanted);
        assert!(read("k = { temperature = [273, 400], values = [1, 2] }").is_err());
        assert!(read("k = \"3\"").is_err());
    }

    #[test]
    fn invalid_properties_are_refused() {
        let refused = |t: &[f64], v: &[f64]| table(t, v).check().unwrap_err();
        assert_eq!(refused(&[1.0], &[1.0]), PropertyError::TooShort(1));
        let lengths = PropertyError::Lengths { temperatures: 2, values: 3 };
        assert_eq!(refused(&[1.0, 2.0], &[1.0; 3]), lengths);
        assert_eq!(refused(&[2.0, 2.0], &[1.0; 2]), PropertyError::NotAscending(2.0, 2.0));
        assert!(matches!(refused(&[1.0, f64::NAN], &[1.0; 2]), PropertyError::NotFinite(_)));
        assert_eq!(refused(&[1.0, 2.0], &[1.0, 0.0]), PropertyError::NotPositive(0.0));
        assert!(Property::Constant(-1.0).check().is_err());
        assert!(Property::Constant(f64::INFINITY).check().is_err());
        assert!(table(&[1.0, 2.0], &[3.0, 1.0]).check().is_ok());
    }
}

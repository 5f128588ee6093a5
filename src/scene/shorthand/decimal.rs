//! Decimal numbers as people write them, whose sums and products are exact.

/// Largest number of digits, so that the product of two is within an `i128`.
const MOST_DIGITS: usize = 18;

/// `digits · 10^exponent`
#[derive(Debug, Clone, Copy)]
pub struct Decimal {
    digits: i128,
    exponent: i32,
}

impl Decimal {
    /// Reads a number such as `-1.5e-3`; `None` if it has too many digits.
    pub fn read(text: &str) -> Option<Self> {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = format!("{whole}{fraction}");
        if digits.len() > MOST_DIGITS || fraction.starts_with(['+', '-']) {
            return None;
        }
        let exponent: i32 = exponent.parse().ok()?;
        let exponent = exponent.checked_sub(fraction.len() as i32)?;
        Some(Self { digits: digits.parse().ok()?, exponent })
    }

    /// The number that is written most shortly for a float.
    pub fn of(value: f64) -> Option<Self> {
        Self::read(&format!("{value:e}"))
    }

    pub fn times(self, other: Self) -> Option<Self> {
        let digits = self.digits.checked_mul(other.digits)?;
        Some(Self { digits, exponent: self.exponent.checked_add(other.exponent)? })
    }

    pub fn plus(self, other: Self) -> Option<Self> {
        let exponent = self.exponent.min(other.exponent);
        let digits_of = |one: Self| {
            let shift = u32::try_from(one.exponent - exponent).ok()?;
            one.digits.checked_mul(10_i128.checked_pow(shift)?)
        };
        Some(Self { digits: digits_of(self)?.checked_add(digits_of(other)?)?, exponent })
    }

    /// The nearest float.
    pub fn value(self) -> Option<f64> {
        format!("{}e{}", self.digits, self.exponent).parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_are_the_nearest_floats() {
        let read = |text| Decimal::read(text).unwrap();
        assert_eq!(read("138.040").plus(read("273.15")).unwrap().value(), Some(411.19));
        assert_eq!(read("-1.5e-3").times(read("0.0254")).unwrap().value(), Some(-3.81e-5));
        assert_eq!(read("7").times(Decimal::of(4.184).unwrap()).unwrap().value(), Some(29.288));
        assert_eq!(read(".5").value(), Some(0.5));
        assert_eq!(read("+5.").value(), Some(5.0));
    }

    #[test]
    fn numbers_of_many_digits_are_left_alone() {
        assert!(Decimal::read("3.14159265358979323846").is_none());
        assert!(Decimal::read("1e99999999999").is_none());
        let far = Decimal::read("1e300").unwrap().plus(Decimal::read("1e-300").unwrap());
        assert!(far.is_none());
    }
}

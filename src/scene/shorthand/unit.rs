//! Units as people write them: `mm`, `kJ/(kg K)`, `W/m²`, `ft`, `cP`.

use std::f64::consts::PI;

/// A unit: `SI value = factor · (value + zero)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    pub factor: f64,
    /// Not zero only for temperatures that are counted from another zero.
    pub zero: f64,
    pub dimension: Dimension,
}

/// Twice the exponents of kg, m, s, K, rad, B and mol, as effusivities have the root of a second.
pub type Dimension = [i32; 7];

/// The dimension of pure numbers.
pub const NUMBER: Dimension = [0; 7];

const fn unit(factor: f64, exponents: Dimension) -> Unit {
    let [kg, m, s, kelvin, radian, byte, mole] = exponents;
    let dimension = [2 * kg, 2 * m, 2 * s, 2 * kelvin, 2 * radian, 2 * byte, 2 * mole];
    Unit { factor, zero: 0.0, dimension }
}

const MASS: Dimension = [1, 0, 0, 0, 0, 0, 0];
const KELVIN: Dimension = [0, 0, 0, 1, 0, 0, 0];
const PRESSURE: Dimension = [1, -1, -2, 0, 0, 0, 0];
const LENGTH: Dimension = [0, 1, 0, 0, 0, 0, 0];
const VOLUME: Dimension = [0, 3, 0, 0, 0, 0, 0];
const FORCE: Dimension = [1, 1, -2, 0, 0, 0, 0];
const ENERGY: Dimension = [1, 2, -2, 0, 0, 0, 0];
const POWER: Dimension = [1, 2, -3, 0, 0, 0, 0];
const TIME: Dimension = [0, 0, 1, 0, 0, 0, 0];
const FREQUENCY: Dimension = [0, 0, -1, 0, 0, 0, 0];
const VISCOSITY: Dimension = [1, -1, -1, 0, 0, 0, 0];
const ANGLE: Dimension = [0, 0, 0, 0, 1, 0, 0];
const MEMORY: Dimension = [0, 0, 0, 0, 0, 1, 0];
const AMOUNT: Dimension = [0, 0, 0, 0, 0, 0, 1];

/// Most brackets and roots within each other.
const DEEPEST: usize = 8;

/// Units that take prefixes.
const PREFIXED: [(&str, Unit); 16] = [
    ("m", unit(1.0, LENGTH)),
    ("g", unit(1e-3, MASS)),
    ("s", unit(1.0, TIME)),
    ("K", unit(1.0, KELVIN)),
    ("N", unit(1.0, FORCE)),
    ("Pa", unit(1.0, PRESSURE)),
    ("J", unit(1.0, ENERGY)),
    ("W", unit(1.0, POWER)),
    ("Hz", unit(1.0, FREQUENCY)),
    ("rad", unit(1.0, ANGLE)),
    ("bar", unit(1e5, PRESSURE)),
    ("l", unit(1e-3, VOLUME)),
    ("L", unit(1e-3, VOLUME)),
    ("P", unit(0.1, VISCOSITY)),
    ("B", unit(1.0, MEMORY)),
    ("mol", unit(1.0, AMOUNT)),
];

const DEGREE: Unit = unit(PI / 180.0, ANGLE);
const CELSIUS: Unit = Unit { zero: 273.15, ..unit(1.0, KELVIN) };
const FAHRENHEIT: Unit = Unit { zero: 459.67, ..unit(1.0 / 1.8, KELVIN) };

/// Powers that stand for a root.
const HALF: [&str; 6] = ["^0.5", "^.5", "^(0.5)", "^(1/2)", "(1/2)", "^½"];

/// Units without prefixes.
const PLAIN: [(&str, Unit); 22] = [
    ("min", unit(60.0, TIME)),
    ("h", unit(3600.0, TIME)),
    ("°", DEGREE),
    ("deg", DEGREE),
    ("°C", CELSIUS),
    ("℃", CELSIUS),
    ("degC", CELSIUS),
    ("°F", FAHRENHEIT),
    ("degF", FAHRENHEIT),
    ("%", unit(1e-2, NUMBER)),
    ("ppm", unit(1e-6, NUMBER)),
    ("in", unit(0.0254, LENGTH)),
    ("ft", unit(0.3048, LENGTH)),
    ("mil", unit(2.54e-5, LENGTH)),
    ("Å", unit(1e-10, LENGTH)),
    ("psi", unit(6_894.757_293_168_361, PRESSURE)),
    ("ksi", unit(6_894_757.293_168_361, PRESSURE)),
    ("atm", unit(101_325.0, PRESSURE)),
    ("cal", unit(4.184, ENERGY)),
    ("kcal", unit(4184.0, ENERGY)),
    ("micron", unit(1e-6, LENGTH)),
    ("microns", unit(1e-6, LENGTH)),
];

const PREFIXES: [(&str, f64); 16] = [
    ("f", 1e-15),
    ("p", 1e-12),
    ("n", 1e-9),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("u", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("da", 1e1),
    ("h", 1e2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
    ("", 1.0),
];

impl Unit {
    /// Reads products and quotients of units with integer powers; returns the part that is not understood on failure.
    ///
    /// A quotient divides by what follows up to the next product sign, blank or slash: `W/m² K` is W K/m².
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader { rest: text.trim(), depth: 0 };
        let unit = reader.product()?;
        if reader.rest.is_empty() { Ok(unit) } else { Err(reader.rest.to_owned()) }
    }

    fn times(self, other: Unit, power: i32) -> Self {
        let dimension: Dimension =
            std::array::from_fn(|i| self.dimension[i] + power * other.dimension[i]);
        Self { factor: self.factor * other.factor.powi(power), zero: 0.0, dimension }
    }
}

struct Reader<'t> {
    rest: &'t str,
    /// Number of brackets and roots around it.
    depth: usize,
}

impl<'t> Reader<'t> {
    fn product(&mut self) -> Result<Unit, String> {
        let mut product = unit(1.0, NUMBER);
        let mut sign = if self.takes('/') { -1 } else { 1 };
        let mut factors = 0;
        loop {
            let (factor, power) = self.factor()?;
            // Counted from another zero, a temperature stands alone.
            product = match factors {
                0 if sign * power == 1 => factor,
                _ => product.times(factor, sign * power),
            };
            factors += 1;
            self.rest = self.rest.trim_start();
            sign = if self.takes('/') {
                -1
            } else if self.takes('*') || self.takes('·') || self.takes('.') || self.is_factor() {
                1
            } else {
                return Ok(product);
            };
            product.zero = 0.0;
        }
    }

    fn is_factor(&self) -> bool {
        self.rest.starts_with(|c: char| c == '(' || c == '√' || is_letter(c))
    }

    /// A unit, a bracket or the number one, and its power.
    fn factor(&mut self) -> Result<(Unit, i32), String> {
        self.rest = self.rest.trim_start();
        let all = self.rest;
        if self.takes('√') {
            self.descend()?;
            let (inner, power) = self.factor()?;
            self.depth -= 1;
            let raised = unit(1.0, NUMBER).times(inner, power);
            return root(raised).map(|root| (root, 1)).ok_or_else(|| all.to_owned());
        }
        let unit = if self.takes('(') {
            self.descend()?;
            let inner = self.product()?;
            self.depth -= 1;
            if !self.takes(')') {
                return Err(format!("({}", self.rest));
            }
            inner
        } else if self.takes('1') {
            unit(1.0, NUMBER)
        } else {
            let end = self.rest.find(|c| !is_letter(c)).unwrap_or(self.rest.len());
            let (name, rest) = self.rest.split_at(end);
            self.rest = rest;
            named(name).ok_or_else(|| if name.is_empty() { rest } else { name }.to_owned())?
        };
        if !HALF.iter().any(|half| self.takes_text(half)) {
            return Ok((unit, self.power()));
        }
        root(unit).map(|root| (root, 1)).ok_or_else(|| all.to_owned())
    }

    /// Enters a bracket or a root; refuses more than anyone writes.
    fn descend(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST { Err("so many brackets".to_owned()) } else { Ok(()) }
    }

    /// `2`, `^2`, `²`, `-1`, `^-1` or `⁻¹`; 1 if there is none.
    fn power(&mut self) -> i32 {
        let raised = self.rest.strip_prefix('^').unwrap_or(self.rest);
        let (negative, digits) = match raised.strip_prefix(['-', '⁻', '−']) {
            Some(digits) => (true, digits),
            None => (false, raised),
        };
        let mut characters = digits.chars();
        let Some(digit) = characters.next().and_then(digit) else { return 1 };
        self.rest = characters.as_str();
        if negative { -digit } else { digit }
    }

    fn takes(&mut self, sign: char) -> bool {
        let rest = self.rest.trim_start().strip_prefix(sign);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn takes_text(&mut self, text: &str) -> bool {
        let rest = self.rest.strip_prefix(text);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }
}

/// The root of a unit; `None` if exponents would not be multiples of a half.
fn root(unit: Unit) -> Option<Unit> {
    let is_even = unit.dimension.iter().all(|twice| twice % 2 == 0);
    let dimension = unit.dimension.map(|twice| twice / 2);
    is_even.then_some(Unit { factor: unit.factor.sqrt(), zero: 0.0, dimension })
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '°' | '℃' | '%')
}

fn digit(c: char) -> Option<i32> {
    let raised = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|other| other == c);
    raised.map(|value| value as i32).or_else(|| c.to_digit(10).map(|value| value as i32))
}

fn named(name: &str) -> Option<Unit> {
    let known = |list: &[(&str, Unit)], name: &str| {
        list.iter().find(|(other, _)| *other == name).map(|(_, unit)| *unit)
    };
    known(&PLAIN, name).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, factor)| {
            let unit = known(&PREFIXED, name.strip_prefix(prefix)?)?;
            Some(Unit { factor: factor * unit.factor, ..unit })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expect(text: &str, factor: f64, si: &str) {
        let (found, wanted) = (Unit::read(text).unwrap(), Unit::read(si).unwrap());
        assert_eq!(found.dimension, wanted.dimension, "{text}");
        assert!((found.factor / factor - 1.0).abs() < 1e-14, "{text}: {}", found.factor);
    }

    #[test]
    fn units_of_data_sheets_are_read() {
        expect("mm", 1e-3, "m");
        expect("µs", 1e-6, "s");
        expect("μm", 1e-6, "m");
        expect("g/cm³", 1e3, "kg/m3");
        expect("kg m-3", 1.0, "kg/m³");
        expect("kJ/(kg K)", 1e3, "J/(kg.K)");
        expect("J/kg/K", 1.0, "J/(kg K)");
        expect("W m⁻² K⁻¹", 1.0, "W/(m² K)");
        expect("W/mm^2", 1e6, "W/m²");
        expect("mN/m", 1e-3, "N/m");
        expect("cP", 1e-3, "Pa s");
        expect("mm/min", 1e-3 / 60.0, "m/s");
        expect("ppm/K", 1e-6, "1/K");
        expect("/K", 1.0, "1/K");
        expect("W √s/(cm² K)", 1e4, "kg/(s² √s K)");
        expect("GPa", 1e9, "kg/(m s²)");
        for root in ["√m", "m^0.5", "m^.5", "m^(1/2)", "m(1/2)", "m^½"] {
            expect(&format!("MPa {root}"), 1e6, "Pa √m");
        }
    }

    #[test]
    fn what_is_not_a_unit_is_named() {
        assert_eq!(Unit::read("W/(m2 Q)").unwrap_err(), "Q");
        assert_eq!(Unit::read("").unwrap_err(), "");
        assert!(Unit::read("W/(m2").is_err());
        assert!(Unit::read("mm)").is_err());
        assert!(Unit::read("m²²").is_err());
        assert!(Unit::read(&"(".repeat(100_000)).is_err());
        assert!(Unit::read("W/√√m").is_err());
        assert!(Unit::read("√m^0.5").is_err());
        assert!(Unit::read("m^0.25").is_err());
    }
}

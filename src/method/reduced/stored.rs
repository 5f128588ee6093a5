//! Reduced systems as stored numbers, and the conditions that such numbers must satisfy.

use super::system::ReducedSystem;
use crate::runtime::sealed::{Content, Reader};

impl ReducedSystem {
    pub fn put(&self, content: &mut Content) {
        let Self { inputs, outputs, rates, turns, entering, leaving, direct, bounds, ranges } =
            self;
        [*inputs, *outputs, rates.len()].into_iter().for_each(|count| content.count(count));
        for numbers in [rates, turns, entering, leaving, direct, bounds, ranges] {
            content.numbers(numbers.iter().copied());
        }
    }

    pub fn read(reader: &mut Reader) -> Option<Self> {
        let [inputs, outputs, order] = [reader.count()?, reader.count()?, reader.count()?];
        let mut matrix = |rows: usize, columns: usize| reader.numbers(rows.checked_mul(columns)?);
        Some(Self {
            inputs,
            outputs,
            rates: matrix(order, 1)?,
            turns: matrix(order, 1)?,
            entering: matrix(order, inputs)?,
            leaving: matrix(outputs, order)?,
            direct: matrix(outputs, inputs)?,
            bounds: matrix(outputs, inputs)?,
            ranges: matrix(outputs, inputs)?,
        })
    }

    /// Refuses numbers that no reduction leads to.
    pub fn check(&self) -> Result<(), String> {
        let Self { rates, turns, entering, leaving, direct, bounds, ranges, .. } = self;
        let all = [rates, turns, entering, leaving, direct, bounds, ranges];
        if let Some(value) = all.into_iter().flatten().find(|value| !value.is_finite()) {
            return Err(format!("{value} is no finite number"));
        }
        // A negative bound would promise the impossible.
        for (words, values) in
            [("a rate of decay", rates), ("a bound", bounds), ("a range", ranges)]
        {
            if let Some(value) = values.iter().find(|value| **value < 0.0) {
                return Err(format!("{value} as {words}"));
            }
        }
        if rates.is_empty() {
            return Err("no unknown, where the slowest mode is one".to_owned());
        }
        let mut i = 0;
        while i < rates.len() {
            if turns[i] == 0.0 {
                i += 1;
                continue;
            }
            let is_pair =
                turns.get(i + 1) == Some(&turns[i]) && rates.get(i + 1) == Some(&rates[i]);
            if !is_pair || turns[i] < 0.0 {
                return Err(format!(
                    "{} as imaginary part of a pole that is none of a pair",
                    turns[i]
                ));
            }
            i += 2;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime::sealed::Format;

    const FORMAT: Format = Format { magic: b"IMPTST01", noun: "system", of: "tests" };

    fn system() -> ReducedSystem {
        let numbers = |count: i32| (0..count).map(|n| 0.5 * f64::from(n) + 0.1).collect::<Vec<_>>();
        ReducedSystem {
            inputs: 2,
            outputs: 3,
            rates: vec![0.0, 2.0, 2.0, 5.0],
            turns: vec![0.0, 0.7, 0.7, 0.0],
            entering: numbers(8),
            leaving: numbers(12),
            direct: numbers(6),
            bounds: numbers(6),
            ranges: numbers(6),
        }
    }

    #[test]
    fn round_trip() {
        let mut content = Content::default();
        system().put(&mut content);
        let bytes = FORMAT.seal("", &content);
        let (_, found) = FORMAT.open(&bytes, ReducedSystem::read).unwrap();
        assert_eq!(found, system());
        assert_eq!(found.check(), Ok(()));
    }

    #[test]
    fn inconsistent_numbers_are_refused() {
        type Edit = fn(&mut ReducedSystem);
        let edits: [(&str, Edit); 6] = [
            ("NaN is no finite number", |system| system.leaving[3] = f64::NAN),
            ("inf is no finite number", |system| system.bounds[0] = f64::INFINITY),
            ("-1 as a rate of decay", |system| system.rates[3] = -1.0),
            ("-0.5 as a bound", |system| system.bounds[5] = -0.5),
            ("0.7 as imaginary part", |system| system.turns[2] = 0.0),
            ("0.3 as imaginary part", |system| system.turns[3] = 0.3),
        ];
        for (words, edit) in edits {
            let mut forged = system();
            edit(&mut forged);
            let said = forged.check().unwrap_err();
            assert!(said.starts_with(words), "{said}");
        }
    }
}

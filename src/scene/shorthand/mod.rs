//! Texts that stand for numbers and tables: `"90 °C"`, `material = "copper"`, `fluid = "water"`.

mod decimal;
mod quantity;
mod substance;
mod unit;

use std::collections::BTreeMap;

use toml::de::DeValue;

use super::error::Problem;
use super::locate::{Path, Source};
use super::schema::Schema;
use quantity::Wanted;

pub use quantity::{is_convertible, is_meant_as_number};
pub use substance::NamedSubstance;

/// Returns the number in SI units that a text such as `90 °C` stands for, where one in `unit` is wanted.
///
/// # Errors
/// If the text is no number with a unit of that kind; the message says what is wrong and what is allowed.
pub fn quantity(text: &str, unit: &str, is_temperature: bool) -> Result<f64, String> {
    let number = quantity::read(text, Wanted { unit, is_temperature });
    number.map_err(|refusal| format!("{}; allowed: {}", refusal.message, refusal.allowed))
}

/// Replaces names of substances by their constants and texts with units by numbers; returns what is wrong with them.
pub fn expand(source: &mut Source, schema: &Schema) -> Vec<(Path, Problem)> {
    let mut problems = substance::expand(source);
    let mut texts = Vec::new();
    collect_texts(source.root(), &Path::default(), &mut texts);
    for (path, text) in texts {
        let is_known = source.number(&path).is_some();
        let Some((unit, is_temperature)) = schema.number_at(source, &path) else { continue };
        let is_refused = problems.iter().any(|(refused, _)| path.is_within(refused));
        if is_known || is_refused || !is_convertible(unit) || !is_meant_as_number(&text) {
            continue;
        }
        match quantity::read(&text, Wanted { unit, is_temperature }) {
            Ok(number) => source.set_number(path, number),
            Err(refusal) => {
                let problem = source.problem(&path, refusal.message, refusal.allowed);
                problems.push((path, problem));
            }
        }
    }
    problems
}

/// Temperatures [K] for which the text has degrees Celsius or Fahrenheit.
pub fn in_degrees(source: &Source) -> BTreeMap<Path, f64> {
    let has_degrees = |path: &Path| {
        let Some(DeValue::String(text)) = source.value(path) else { return false };
        ["°C", "°F"].iter().any(|unit| text.contains(unit))
    };
    let numbers = source.numbers().iter().filter(|(path, _)| has_degrees(path));
    numbers.map(|(path, number)| (path.clone(), *number)).collect()
}

fn collect_texts(value: &DeValue, path: &Path, texts: &mut Vec<(Path, String)>) {
    match value {
        DeValue::String(text) => texts.push((path.clone(), text.clone().into_owned())),
        DeValue::Array(list) => {
            for (i, element) in list.iter().enumerate() {
                collect_texts(element.get_ref(), &path.index(i), texts);
            }
        }
        DeValue::Table(table) => {
            for (key, element) in table {
                collect_texts(element.get_ref(), &path.key(key.get_ref()), texts);
            }
        }
        _ => {}
    }
}

//! Texts that stand for numbers and tables: `"90 °C"`, `material = "copper"`, `fluid = "water"`.

mod quantity;
mod substance;
mod unit;

use toml::de::DeValue;

use super::error::Problem;
use super::locate::{Path, Source};
use super::schema::Schema;
use quantity::Wanted;

pub use quantity::{is_convertible, is_meant_as_number};
pub use substance::NamedSubstance;

/// Replaces names of substances by their constants and texts with units by numbers; returns what is wrong with them.
pub fn expand(source: &mut Source, schema: &Schema) -> Vec<(Path, Problem)> {
    let mut problems = substance::expand(source);
    let mut texts = Vec::new();
    collect_texts(source.root(), &Path::default(), &mut texts);
    for (path, text) in texts {
        let is_known = source.number(&path).is_some();
        let Some((unit, is_temperature)) = schema.number_at(source, &path) else { continue };
        if is_known || !is_convertible(unit) || !is_meant_as_number(&text) {
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

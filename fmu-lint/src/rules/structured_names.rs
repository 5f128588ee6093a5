//! Names of the structured convention.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "structured-names",
    section: "2.2.9",
    says: "with variableNamingConvention=\"structured\" names are such as a.b[1,2].'c d' or \
           der(a.b,2); no name has a line break or a tab",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let structured =
        subject.description.root.attribute("variableNamingConvention") == Some("structured");
    for variable in &subject.description.variables {
        let name = variable.name;
        if structured && !is_structured(name) {
            let place = subject.document.place_of(variable.node, "name");
            report.error(place, format!("{name:?} is no structured name"), RULE.says);
        } else if name.contains(['\n', '\r', '\t']) {
            let place = subject.document.place_of(variable.node, "name");
            report.error(place, format!("{name:?} has a line break or tab"), RULE.says);
        }
    }
}

fn is_structured(name: &str) -> bool {
    let inner = name.strip_prefix("der(").and_then(|rest| rest.strip_suffix(')'));
    match inner {
        None => identifier(name) == Some(""),
        Some(inner) => match identifier(inner) {
            Some("") => true,
            Some(rest) => rest.strip_prefix(',').and_then(digits) == Some(""),
            None => false,
        },
    }
}

/// Parses names with indices, separated by dots; returns the rest of the text, or `None`.
fn identifier(text: &str) -> Option<&str> {
    let rest = indices(part(text)?)?;
    match rest.strip_prefix('.') {
        Some(more) => identifier(more),
        None => Some(rest),
    }
}

/// Parses a plain or a quoted name; returns the rest of the text.
fn part(text: &str) -> Option<&str> {
    let Some(quoted) = text.strip_prefix('\'') else {
        let starts = text.starts_with(|c: char| c == '_' || c.is_ascii_alphabetic());
        let is_end = |c: char| c != '_' && !c.is_ascii_alphanumeric();
        return starts.then(|| &text[text.find(is_end).unwrap_or(text.len())..]);
    };
    let mut escaped = false;
    for (at, character) in quoted.char_indices() {
        match character {
            '\'' if !escaped => return (at > 0).then(|| &quoted[at + 1..]),
            _ if escaped && !"'\"?\\abfnrtv".contains(character) => return None,
            _ if !escaped && !in_quotes(character) => return None,
            _ => escaped = !escaped && character == '\\',
        }
    }
    None
}

/// Characters that need no escape between quotes.
fn in_quotes(character: char) -> bool {
    character.is_ascii_alphanumeric() || "_!#$%&()*+,-./:;<>=?@[]^{}|~ \\".contains(character)
}

/// Parses indices such as `[1,2]`, if any; returns the rest of the text.
fn indices(text: &str) -> Option<&str> {
    let Some(mut rest) = text.strip_prefix('[') else { return Some(text) };
    loop {
        rest = digits(rest)?;
        match rest.strip_prefix(',') {
            Some(more) => rest = more,
            None => return rest.strip_prefix(']'),
        }
    }
}

/// Parses a number; returns the rest of the text.
fn digits(text: &str) -> Option<&str> {
    let rest = text.trim_start_matches(|c: char| c.is_ascii_digit());
    (rest.len() < text.len()).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structured_names_are_recognised() {
        for name in [
            "a",
            "_1",
            "plate.heat_in",
            "spot.flux[1]",
            "m[1,22].x",
            "der(x)",
            "der(a.b[1],2)",
            "'a b'.c",
            "'it\\'s'",
            "'#123'[3].'{}'",
            "der",
        ] {
            assert!(is_structured(name), "{name}");
        }
        for name in [
            "", "1a", "a b", "a.", ".a", "a[", "a[]", "a[1,]", "a[x]", "der(x", "der(x,)", "der()",
            "''", "'a", "'\\q'", "'ü'", "ü", "a-b", "a[1]b",
        ] {
            assert!(!is_structured(name), "{name}");
        }
    }
}

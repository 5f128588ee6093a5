//! Value references, and variables that share one.

use std::collections::BTreeMap;

use super::{Check, Rule};
use crate::Subject;
use crate::description::{Description, Variable};
use crate::finding::Report;
use crate::vocabulary::{Kind, Variability};

pub static RULE: Rule = Rule {
    name: "value-references",
    section: "2.2.7",
    says: "variables of one base type share a value reference only if they always have the same \
           value: at most one may be set or have a start, units are equal, constants go with \
           constants of the same start",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    let mut sets: BTreeMap<(&str, u32), Vec<&Variable>> = BTreeMap::new();
    for variable in &description.variables {
        if let (Some(kind), Some(reference)) = (variable.kind.map(Kind::base), variable.reference) {
            sets.entry((kind.word(), reference)).or_default().push(variable);
        }
    }
    let shared: Vec<_> = sets.values().filter(|set| set.len() > 1).collect();
    let mut permitted = Vec::new();
    for set in shared {
        let first = set[0];
        for other in &set[1..] {
            let place = || subject.document.place_of(other.node, "valueReference");
            let shares = format!("shares the value reference with {:?}", first.name);
            match conflict(description, set, first, other) {
                Some(reason) => {
                    report.error(place(), format!("{shares}, but {reason}"), RULE.says);
                }
                None => permitted.push((place(), shares)),
            }
        }
    }
    // Aliases are allowed, and large units have thousands, so one line covers all of them.
    let count = permitted.len();
    if let Some((place, shares)) = permitted.into_iter().next() {
        let more =
            if count > 1 { format!(" (and {} more such pairs)", count - 1) } else { String::new() };
        let wrong = format!("{shares}{more}: right only if both always have the same value");
        report.warning(place, wrong, RULE.says);
    }
}

/// Reason why two variables cannot share a value.
fn conflict(
    description: &Description,
    set: &[&Variable],
    first: &Variable,
    other: &Variable,
) -> Option<String> {
    let constant = |v: &Variable| v.variability == Some(Variability::Constant);
    let unit = |v: &Variable| description.attribute(v, "unit").map(str::to_owned);
    let settable = set.iter().filter(|v| v.is_settable()).count();
    let started = set.iter().filter(|v| !constant(v) && v.attribute("start").is_some()).count();
    if settable > 1 {
        return Some("both can be set".into());
    }
    if started > 1 {
        return Some("both have a start value".into());
    }
    if constant(first) != constant(other) {
        return Some("only one of them is constant".into());
    }
    if constant(first) && first.attribute("start") != other.attribute("start") {
        return Some("their constant values differ".into());
    }
    let (mine, theirs) = (unit(first), unit(other));
    (mine != theirs).then(|| {
        let name = |unit: Option<String>| unit.unwrap_or_else(|| "none".into());
        format!("their units differ: {} and {}", name(mine), name(theirs))
    })
}

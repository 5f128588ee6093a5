//! `dependencies` and `dependenciesKind` of ModelStructure.

use std::collections::HashSet;

use super::{Check, Rule};
use crate::Subject;
use crate::description::{Unknown, Variable};
use crate::finding::Report;
use crate::vocabulary::{Causality, Initial, Kind};

pub static RULE: Rule = Rule {
    name: "dependencies",
    section: "2.2.8",
    says: "dependencies are ascending indices of inputs, states or the independent variable, in \
           InitialUnknowns of inputs, variables with initial exact or the independent variable; \
           dependenciesKind has as many words, in InitialUnknowns only dependent or constant, and \
           only dependent for what is no Real",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    let states: HashSet<usize> = description.states().collect();
    let outside = |index: usize, variable: &Variable| {
        matches!(variable.causality, Some(Causality::Input | Causality::Independent))
            || states.contains(&index)
    };
    let initial = |_: usize, variable: &Variable| {
        matches!(variable.causality, Some(Causality::Input | Causality::Independent))
            || variable.initial == Some(Initial::Exact)
    };
    for unknown in description.outputs.iter().chain(&description.derivatives) {
        check_indices(subject, unknown, outside, report);
        check_kinds(subject, unknown, false, report);
    }
    for unknown in &description.initial_unknowns {
        check_indices(subject, unknown, initial, report);
        check_kinds(subject, unknown, true, report);
    }
}

fn check_indices(
    subject: &Subject,
    unknown: &Unknown,
    known: impl Fn(usize, &Variable) -> bool,
    report: &mut Report,
) {
    let Some(indices) = &unknown.dependencies else { return };
    let place = || subject.document.place_of(unknown.node, "dependencies");
    let count = subject.description.variables.len();
    if indices.len() > count {
        let wrong = format!("{} dependencies of {count} variables", indices.len());
        return report.error(place(), wrong, RULE.says);
    }
    for &index in indices {
        match subject.description.variable(index) {
            None => {
                let wrong = format!("dependency {index}: there is no such variable");
                report.error(place(), wrong, format!("1 to {count}"));
            }
            Some(variable) if known(index, variable) => {}
            // Widespread, even among the reference units of the standard's authors.
            Some(variable) if variable.causality == Some(Causality::Parameter) => {
                let wrong = format!("dependency {index}: {:?} is a parameter", variable.name);
                report.warning(place(), wrong, RULE.says);
            }
            Some(variable) => {
                let wrong = format!("dependency {index}: {:?} is no known", variable.name);
                report.error(place(), wrong, RULE.says);
            }
        }
    }
    if !indices.is_sorted_by(|a, b| a < b) {
        report.warning(place(), "the dependencies are not ascending", RULE.says);
    }
}

fn check_kinds(subject: &Subject, unknown: &Unknown, is_initial: bool, report: &mut Report) {
    let Some(kinds) = &unknown.kinds else { return };
    let place = || subject.document.place_of(unknown.node, "dependenciesKind");
    match &unknown.dependencies {
        None if unknown.node.attribute("dependencies").is_none() => {
            report.error(place(), "dependenciesKind without dependencies", RULE.says);
        }
        Some(indices) if indices.len() != kinds.len() => {
            let wrong = format!("{} kinds for {} dependencies", kinds.len(), indices.len());
            report.error(place(), wrong, RULE.says);
        }
        _ => {}
    }
    let variable = unknown.index.and_then(|index| subject.description.variable(index));
    let is_real = variable.is_none_or(|variable| variable.kind == Some(Kind::Real));
    let allowed: &[&str] = match (is_real, is_initial) {
        (false, _) => &["dependent"],
        (true, true) => &["dependent", "constant"],
        (true, false) => return,
    };
    if let Some(kind) = kinds.iter().find(|kind| !allowed.contains(kind)) {
        let wrong = format!("the kind {kind} is not for this unknown");
        report.warning(place(), wrong, allowed.join(", "));
    }
}

//! Outputs and Derivatives of ModelStructure.

use std::collections::HashSet;

use super::{Check, Rule};
use crate::lint::Subject;
use crate::lint::description::{Unknown, Variable};
use crate::lint::document::child;
use crate::lint::finding::Report;
use crate::lint::vocabulary::Causality;

pub static OUTPUTS: Rule = Rule {
    name: "outputs",
    section: "2.2.8",
    says: "ModelStructure/Outputs lists every variable with causality output once, and nothing else",
    check: Check::Unit(outputs),
};

pub static DERIVATIVES: Rule = Rule {
    name: "derivatives",
    section: "2.2.8",
    says: "ModelStructure/Derivatives lists variables with the attribute derivative, each once; for \
           model exchange all that are derivatives of states",
    check: Check::Unit(derivatives),
};

fn outputs(subject: &Subject, report: &mut Report) {
    let is_output = |variable: &Variable| variable.causality == Some(Causality::Output);
    let listed = members(subject, &subject.description.outputs, is_output, &OUTPUTS, report);
    missing(subject, &listed, is_output, ("Outputs", &OUTPUTS), report);
}

fn derivatives(subject: &Subject, report: &mut Report) {
    let is_derivative = |variable: &Variable| variable.derivative().is_some();
    let unknowns = &subject.description.derivatives;
    let listed = members(subject, unknowns, is_derivative, &DERIVATIVES, report);
    if subject.description.interfaces.iter().any(|interface| !interface.is_co_simulation) {
        let may_be_left_out = |v: &Variable| v.derivative().is_none() || is_second(subject, v);
        let expected = |v: &Variable| !may_be_left_out(v);
        missing(subject, &listed, expected, ("Derivatives", &DERIVATIVES), report);
    }
}

/// Whether a variable is the derivative of a variable that is no state itself, such as an input.
fn is_second(subject: &Subject, variable: &Variable) -> bool {
    let of = variable.derivative().and_then(|index| subject.description.variable(index));
    of.is_some_and(|state| {
        !matches!(state.causality, Some(Causality::Local | Causality::Output))
            || state.initial.is_none()
    })
}

/// The indices in a list, after reports on those that do not belong there.
fn members(
    subject: &Subject,
    unknowns: &[Unknown],
    belongs: impl Fn(&Variable) -> bool,
    rule: &Rule,
    report: &mut Report,
) -> HashSet<usize> {
    let mut listed = HashSet::new();
    for unknown in unknowns {
        let Some(index) = unknown.index else { continue };
        let place = || subject.document.place_of(unknown.node, "index");
        match subject.description.variable(index) {
            None => {
                let count = subject.description.variables.len();
                report.error(
                    place(),
                    format!("there is no variable {index}"),
                    format!("1 to {count}"),
                );
            }
            Some(variable) if !belongs(variable) => {
                report.error(
                    place(),
                    format!("{:?} does not belong here", variable.name),
                    rule.says,
                );
            }
            Some(variable) if !listed.insert(index) => {
                report.error(place(), format!("{:?} is listed twice", variable.name), rule.says);
            }
            Some(_) => {}
        }
    }
    listed
}

/// Reports variables that should be listed.
fn missing(
    subject: &Subject,
    listed: &HashSet<usize>,
    expected: impl Fn(&Variable) -> bool,
    (list, rule): (&str, &Rule),
    report: &mut Report,
) {
    let root = subject.description.root;
    let Some(structure) = child(root, "ModelStructure") else { return };
    let place = || subject.document.place(child(structure, list).unwrap_or(structure));
    for (at, variable) in subject.description.variables.iter().enumerate() {
        if expected(variable) && !listed.contains(&(at + 1)) {
            let wrong = format!("{:?}, variable {}, is not listed", variable.name, at + 1);
            report.error(place(), wrong, rule.says);
        }
    }
}

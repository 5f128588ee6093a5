//! Outputs and Derivatives of ModelStructure.

use std::collections::HashSet;

use super::{Check, Rule};
use crate::Subject;
use crate::description::{Unknown, Variable};
use crate::document::child;
use crate::finding::Report;
use crate::vocabulary::Causality;

pub static OUTPUTS: Rule = Rule {
    name: "outputs",
    section: "2.2.8",
    says: "ModelStructure/Outputs lists every variable with causality output once, and nothing else",
    check: Check::Unit(outputs),
};

pub static DERIVATIVES: Rule = Rule {
    name: "derivatives",
    section: "2.2.8",
    says: "ModelStructure/Derivatives lists variables with the attribute derivative, each once",
    check: Check::Unit(derivatives),
};

fn outputs(subject: &Subject, report: &mut Report) {
    let is_output = |variable: &Variable| variable.causality == Some(Causality::Output);
    let listed = members(subject, &subject.description.outputs, is_output, &OUTPUTS, report);
    let Some(structure) = child(subject.description.root, "ModelStructure") else { return };
    for (at, variable) in subject.description.variables.iter().enumerate() {
        if is_output(variable) && !listed.contains(&(at + 1)) {
            let place = subject.document.place(child(structure, "Outputs").unwrap_or(structure));
            let wrong = format!("{:?}, variable {}, is not listed", variable.name, at + 1);
            report.error(place, wrong, OUTPUTS.says);
        }
    }
}

/// Checks the list of derivatives. Only the unit knows which derivatives belong to states, so none can be reported as
/// missing.
fn derivatives(subject: &Subject, report: &mut Report) {
    let is_derivative = |variable: &Variable| variable.derivative().is_some();
    members(subject, &subject.description.derivatives, is_derivative, &DERIVATIVES, report);
}

/// The indices in a list; reports those that do not belong there.
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

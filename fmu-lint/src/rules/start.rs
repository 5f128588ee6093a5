//! Required and forbidden start values.

use super::{Check, Rule};
use crate::Subject;
use crate::description::Variable;
use crate::finding::Report;
use crate::vocabulary::{Causality, Initial};

pub static RULE: Rule = Rule {
    name: "start",
    section: "2.2.7",
    says: "inputs and variables with initial exact or approx have a start value; calculated and \
           independent ones have none",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    for variable in &subject.description.variables {
        let Some(details) = variable.details else { continue };
        let has_start = details.attribute("start").is_some();
        match needs_start(variable) {
            Some((true, why)) if !has_start => {
                let wrong = format!("the start value is missing: {why}");
                report.error(subject.document.place(details), wrong, RULE.says);
            }
            Some((false, why)) if has_start => {
                let place = subject.document.place_of(details, "start");
                report.error(place, format!("there is a start value: {why}"), RULE.says);
            }
            _ => {}
        }
    }
}

/// Returns whether a variable must or must not have a start value, and why; `None` if the attributes that decide this
/// are faulty themselves.
fn needs_start(variable: &Variable) -> Option<(bool, &'static str)> {
    match (variable.causality?, variable.initial) {
        (Causality::Input, _) => Some((true, "the variable is an input")),
        (Causality::Independent, _) => Some((false, "the variable is independent")),
        (_, Some(Initial::Exact)) => Some((true, "initial is exact")),
        (_, Some(Initial::Approx)) => Some((true, "initial is approx")),
        (_, Some(Initial::Calculated)) => Some((false, "initial is calculated")),
        (_, None) => None,
    }
}

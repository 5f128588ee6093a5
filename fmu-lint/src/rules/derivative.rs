//! The attribute `derivative`.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::Report;
use crate::vocabulary::{Kind, Variability};

pub static RULE: Rule = Rule {
    name: "derivative",
    section: "2.2.7",
    says: "derivative is the index, counted from 1, of another continuous Real; a derivative is \
           continuous itself",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    for (own, variable) in description.variables.iter().enumerate() {
        let (Some(state), Some(details)) = (variable.derivative(), variable.details) else {
            continue;
        };
        let wrong = match description.variable(state) {
            None => {
                format!("there is no variable {state}; the last is {}", description.variables.len())
            }
            Some(_) if state == own + 1 => "the variable is declared as its own derivative".into(),
            Some(other) if other.kind != Some(Kind::Real) => format!("{:?} is no Real", other.name),
            Some(other) if other.variability.is_some_and(|v| v != Variability::Continuous) => {
                format!("{:?} is not continuous", other.name)
            }
            Some(_) if variable.variability.is_some_and(|v| v != Variability::Continuous) => {
                "a derivative is not continuous".into()
            }
            Some(_) => continue,
        };
        let place = subject.document.place_of(details, "derivative");
        report.error(place, format!("derivative {state}: {wrong}"), RULE.says);
    }
}

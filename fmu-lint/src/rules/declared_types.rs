//! The attribute `declaredType`.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "declared-types",
    section: "2.2.3",
    says: "declaredType names a SimpleType of TypeDefinitions with an element of the same type",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    for variable in &description.variables {
        let (Some(name), Some(details)) = (variable.attribute("declaredType"), variable.details)
        else {
            continue;
        };
        let place = || subject.document.place_of(details, "declaredType");
        match description.declared_type(variable) {
            None => {
                let known: Vec<&str> = description.types.iter().map(|t| t.name).collect();
                report.error(place(), format!("type {name:?} is not declared"), known.join(", "));
            }
            Some(declared) if declared.kind.is_some() && declared.kind != variable.kind => {
                let kind = declared.kind.map_or("", |kind| kind.word());
                report.error(place(), format!("type {name:?} is a {kind}"), RULE.says);
            }
            Some(_) => {}
        }
    }
}

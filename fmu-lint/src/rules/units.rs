//! Units and display units.

use roxmltree::Node;

use super::{Check, Rule};
use crate::Subject;
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "units",
    section: "2.2.2",
    says: "a unit is defined in UnitDefinitions, and a display unit in the definition of its unit",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    for details in description.types.iter().filter_map(|declared| declared.details) {
        check_one(subject, details, details.attribute("unit"), report);
    }
    for variable in &description.variables {
        if let Some(details) = variable.details {
            check_one(subject, details, description.attribute(variable, "unit"), report);
        }
    }
}

/// Checks the attributes of one element; `unit` may come from a declared type.
fn check_one(subject: &Subject, node: Node, unit: Option<&str>, report: &mut Report) {
    let units = &subject.description.units;
    let definition = unit.and_then(|name| units.iter().find(|unit| unit.name == name));
    if let (Some(name), None) = (node.attribute("unit"), definition) {
        let known: Vec<&str> = units.iter().map(|unit| unit.name).collect();
        let wrong = format!("unit {name:?} is not defined");
        report.error(subject.document.place_of(node, "unit"), wrong, known.join(", "));
    }
    let Some(shown) = node.attribute("displayUnit") else { return };
    let place = || subject.document.place_of(node, "displayUnit");
    match (unit, definition) {
        (None, _) => {
            report.error(place(), format!("displayUnit {shown:?} without a unit"), RULE.says)
        }
        (Some(unit), Some(definition)) if !definition.display_units.contains(&shown) => {
            let wrong = format!("displayUnit {shown:?} is not defined for {unit:?}");
            report.error(place(), wrong, definition.display_units.join(", "));
        }
        _ => {}
    }
}

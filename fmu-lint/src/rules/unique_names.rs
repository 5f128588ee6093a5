//! Names that must be unique.

use std::collections::HashMap;

use roxmltree::Node;

use super::{Check, Rule};
use crate::Subject;
use crate::document::{elements, list, title};
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "unique-names",
    section: "2.2.7",
    says: "no two variables, types, units, display units of a unit, items or log categories have one \
           name, and no type has the name of a variable",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let description = subject.description;
    let variables = description.variables.iter().map(|variable| variable.node);
    let types = description.types.iter().map(|declared| declared.node);
    unique(subject, variables.chain(types), "name", report);
    unique(subject, description.units.iter().map(|unit| unit.node), "name", report);
    unique(subject, list(description.root, "LogCategories", "Category"), "name", report);
    for unit in &description.units {
        let shown = elements(unit.node).filter(|node| node.tag_name().name() == "DisplayUnit");
        unique(subject, shown, "name", report);
    }
    for details in description.types.iter().filter_map(|declared| declared.details) {
        unique(subject, elements(details), "name", report);
        unique(subject, elements(details), "value", report);
    }
}

fn unique<'a>(
    subject: &Subject<'a>,
    nodes: impl Iterator<Item = Node<'a, 'a>>,
    attribute: &str,
    report: &mut Report,
) {
    let mut seen: HashMap<&str, Node> = HashMap::new();
    for node in nodes {
        let Some(value) = node.attribute(attribute) else { continue };
        if let Some(first) = seen.insert(value, node) {
            let line = subject.document.place_of(first, attribute).line.unwrap_or_default();
            let wrong =
                format!("{attribute} {value:?} is also that of {} in line {line}", title(first));
            report.error(subject.document.place_of(node, attribute), wrong, RULE.says);
        }
    }
}

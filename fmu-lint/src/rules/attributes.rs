//! Attributes: allowed names and values.

use roxmltree::Node;

use super::{Check, Rule};
use crate::document::{self, Document};
use crate::finding::Report;
use crate::schema::{Content, Element, ROOT};

pub static RULE: Rule = Rule {
    name: "attributes",
    section: "2.2",
    says: "attributes are those of the schema, the required ones are there, and values have its types",
    check: Check::Unit(|subject, report| {
        check(subject.document, subject.document.root(), &ROOT, report)
    }),
};

fn check(document: &Document, node: Node, element: &Element, report: &mut Report) {
    for attribute in document::attributes(node) {
        let (name, value) = (attribute.name(), attribute.value());
        let place = || document.place_of(node, name);
        match element.attributes.iter().find(|known| known.name == name) {
            None => {
                let wrong = format!("{} has no attribute {name}", element.name);
                report.error(place(), wrong, known(element));
            }
            Some(known) if !known.values.hold(value) => {
                report.error(place(), format!("{name} is {value:?}"), known.values.words());
            }
            Some(_) => {}
        }
    }
    for required in element.attributes.iter().filter(|attribute| attribute.required) {
        if node.attribute(required.name).is_none() {
            let wrong = format!("{} lacks the attribute {}", element.name, required.name);
            report.error(document.place(node), wrong, required.values.words());
        }
    }
    let Content::Sequence(groups) = &element.content else { return };
    let known = |name: &str| {
        groups.iter().flat_map(|group| group.any_of).copied().find(|element| element.name == name)
    };
    for child in document::elements(node) {
        if let Some(element) = known(child.tag_name().name()) {
            check(document, child, element, report);
        }
    }
}

fn known(element: &Element) -> String {
    match element.attributes {
        [] => "no attribute".into(),
        some => some.iter().map(|attribute| attribute.name).collect::<Vec<_>>().join(", "),
    }
}

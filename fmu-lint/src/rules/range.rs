//! Bounds and start values.

use roxmltree::Node;

use super::{Check, Rule};
use crate::Subject;
use crate::description::{Description, Variable};
use crate::document::elements;
use crate::finding::Report;
use crate::schema::double;
use crate::vocabulary::Kind;

pub static RULE: Rule = Rule {
    name: "range",
    section: "2.2.7",
    says: "min ≤ start ≤ max, with the bounds of the variable or of its declared type; the start of an \
           enumeration is one of its items",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let (document, description) = (subject.document, subject.description);
    for declared in &description.types {
        let Some(details) = declared.details else { continue };
        let bound = |name| details.attribute(name).and_then(double);
        if let (Some(min), Some(max)) = (bound("min"), bound("max")) {
            order(subject, details, ("min", min), ("max", max), report);
        }
    }
    for variable in &description.variables {
        let Some(details) = variable.details else { continue };
        let number = |name| description.attribute(variable, name).and_then(double);
        let [min, start, max] = ["min", "start", "max"].map(|name| number(name).map(|v| (name, v)));
        for (low, high) in [(min, max), (min, start), (start, max)] {
            if let (Some(low), Some(high)) = (low, high) {
                order(subject, details, low, high, report);
            }
        }
        let Some((_, start)) = start else { continue };
        if let Some(items) = items(description, variable).filter(|items| !items.contains(&start)) {
            let wrong = format!("start {start} is no item of the enumeration");
            report.error(document.place_of(details, "start"), wrong, format!("{items:?}"));
        }
    }
}

/// Reports two values in the wrong order, at the start value if it is one of them.
fn order(subject: &Subject, node: Node, low: (&str, f64), high: (&str, f64), report: &mut Report) {
    if low.1 > high.1 {
        let at = if low.0 == "start" { low.0 } else { high.0 };
        let wrong = format!("{} {:?} is above {} {:?}", low.0, low.1, high.0, high.1);
        report.error(subject.document.place_of(node, at), wrong, RULE.says);
    }
}

/// The values of an enumeration.
fn items(description: &Description, variable: &Variable) -> Option<Vec<f64>> {
    let declared = description.declared_type(variable)?;
    (declared.kind == Some(Kind::Enumeration)).then_some(())?;
    let values = elements(declared.details?).filter_map(|item| item.attribute("value"));
    Some(values.filter_map(double).collect())
}

//! Capability flags that depend on each other.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "capabilities",
    section: "4.3.1",
    says: "canSerializeFMUstate requires canGetAndSetFMUstate",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    for interface in &subject.description.interfaces {
        let is_true = |name| matches!(interface.node.attribute(name), Some("true" | "1"));
        if is_true("canSerializeFMUstate") && !is_true("canGetAndSetFMUstate") {
            let place = subject.document.place_of(interface.node, "canSerializeFMUstate");
            report.error(place, "states can be serialised, but not read and set", RULE.says);
        }
    }
}

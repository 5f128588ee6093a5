//! DefaultExperiment.

use super::{Check, Rule};
use crate::Subject;
use crate::document::child;
use crate::finding::Report;
use crate::schema::double;

pub static RULE: Rule = Rule {
    name: "default-experiment",
    section: "2.2.5",
    says: "stopTime is after startTime (0 if omitted), tolerance and stepSize are positive",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let Some(node) = child(subject.description.root, "DefaultExperiment") else { return };
    let number = |name| node.attribute(name).and_then(double);
    let start = number("startTime").unwrap_or(0.0);
    if let Some(stop) = number("stopTime").filter(|stop| *stop <= start) {
        let wrong = format!("stopTime {stop:?} is not after startTime {start:?}");
        report.error(
            subject.document.place_of(node, "stopTime"),
            wrong,
            format!("above {start:?}"),
        );
    }
    for name in ["tolerance", "stepSize"] {
        if let Some(value) = number(name).filter(|value| *value <= 0.0) {
            let place = subject.document.place_of(node, name);
            report.error(place, format!("{name} {value:?} is not positive"), "above 0");
        }
    }
}

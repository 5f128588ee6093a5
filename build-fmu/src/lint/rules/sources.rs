//! Source files that the description names.

use super::{Check, Rule};
use crate::lint::Subject;
use crate::lint::document::list;
use crate::lint::finding::Report;

pub static RULE: Rule = Rule {
    name: "sources",
    section: "4.3.1",
    says: "every File of SourceFiles stands in the folder sources",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    for interface in &subject.description.interfaces {
        for file in list(interface.node, "SourceFiles", "File") {
            let Some(name) = file.attribute("name") else { continue };
            if !subject.package.has(&format!("sources/{name}")) {
                let place = subject.document.place_of(file, "name");
                report.error(place, format!("sources/{name} is not in the unit"), RULE.says);
            }
        }
    }
}

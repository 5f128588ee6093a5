//! Source files that the description names.

use super::{Check, Rule};
use crate::Subject;
use crate::document::list;
use crate::finding::Report;

pub static RULE: Rule = Rule {
    name: "sources",
    section: "4.3.1",
    says: "every File of SourceFiles is in the folder sources",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let has_folder = !subject.package.names_in("sources/").is_empty();
    for interface in &subject.description.interfaces {
        let files: Vec<_> = list(interface.node, "SourceFiles", "File").collect();
        if let (Some(first), false) = (files.first(), has_folder) {
            let wrong = format!("{} source files, but no folder sources", files.len());
            report.warning(subject.document.place(*first), wrong, RULE.says);
            continue;
        }
        for file in files {
            let Some(name) = file.attribute("name") else { continue };
            if !subject.package.has(&format!("sources/{}", plain(name))) {
                let place = subject.document.place_of(file, "name");
                report.error(place, format!("sources/{name} is not in the unit"), RULE.says);
            }
        }
    }
}

/// A path without redundant steps, such as `./util/list.c`.
fn plain(path: &str) -> String {
    path.split('/').filter(|part| *part != ".").collect::<Vec<_>>().join("/")
}

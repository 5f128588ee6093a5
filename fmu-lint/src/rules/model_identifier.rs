//! The attribute `modelIdentifier`, and libraries of another name.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::{Place, Report};
use crate::platform::PLATFORMS;

pub static RULE: Rule = Rule {
    name: "model-identifier",
    section: "4.3.1",
    says: "modelIdentifier is a name in C, and that of the library in each folder of binaries",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    for interface in &subject.description.interfaces {
        let identifier = interface.identifier;
        let place = subject.document.place_of(interface.node, "modelIdentifier");
        if !is_c_name(identifier) {
            report.error(place.clone(), format!("{identifier:?} is no name in C"), RULE.says);
        }
        for platform in PLATFORMS {
            let folder = format!("binaries/{}/", platform.folder);
            let names = subject.package.names_in(&folder);
            let wanted = format!("{identifier}{}", platform.ending);
            let others: Vec<&str> = names
                .iter()
                .filter(|name| name.ends_with(platform.ending))
                .map(String::as_str)
                .collect();
            if !others.is_empty() && !names.contains(&wanted) {
                let wrong = format!(
                    "modelIdentifier is {identifier:?}, but the folder holds {}",
                    others.join(", ")
                );
                let place = Place { file: folder, ..place.clone() };
                report.error(Place { line: None, ..place }, wrong, wanted);
            }
        }
    }
}

fn is_c_name(name: &str) -> bool {
    let starts = name.starts_with(|c: char| c == '_' || c.is_ascii_alphabetic());
    starts && name.bytes().all(|byte| byte == b'_' || byte.is_ascii_alphanumeric())
}

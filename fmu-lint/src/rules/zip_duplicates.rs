//! Paths that are equal on some file systems.

use std::collections::HashMap;

use super::{Check, Rule};
use crate::finding::{Place, Report};
use crate::package::Package;

pub static RULE: Rule = Rule {
    name: "zip-duplicates",
    section: "2.3",
    says: "a path occurs once in the zip file, even on file systems that ignore case",
    check: Check::Package(check),
};

fn check(package: &Package, report: &mut Report) {
    let mut seen: HashMap<String, &str> = HashMap::new();
    for path in package.paths() {
        match seen.insert(path.to_lowercase(), path) {
            Some(first) if first == path => {
                report.error(Place::file(path), "the path stands twice in the zip file", RULE.says);
            }
            Some(first) => {
                let wrong = format!("the path differs from {first} only by case");
                report.warning(Place::file(path), wrong, RULE.says);
            }
            None => {}
        }
    }
}

//! Entries that do not become regular files when they are unpacked.

use super::{Check, Rule};
use crate::finding::{Place, Report};
use crate::package::Package;

pub static RULE: Rule = Rule {
    name: "zip-links",
    section: "2.3",
    says: "entries of the zip file are files and folders, no links, pipes or devices",
    check: Check::Package(check),
};

/// Kinds of files in the modes of POSIX.
const KIND: u32 = 0o170_000;
const FILE: u32 = 0o100_000;
const FOLDER: u32 = 0o040_000;
const LINK: u32 = 0o120_000;

fn check(package: &Package, report: &mut Report) {
    for entry in &package.entries {
        let wrong = match entry.mode & KIND {
            0 | FILE | FOLDER => continue,
            LINK => "the entry is a link",
            _ => "the entry is neither a file nor a folder",
        };
        report.error(Place::file(&String::from_utf8_lossy(&entry.path)), wrong, RULE.says);
    }
}
